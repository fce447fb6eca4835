/* explain_path.h: one path of one pixel, as a person reads it, and as JSON.
 *
 * In:    a path that the kernel traced (engine/follow.h), its scene.   Out: text on standard output; JSON.
 * Knows: what the steps mean.   Does not know: OpenCL, how a path is traced. */
#ifndef BP_CLI_EXPLAIN_PATH_H
#define BP_CLI_EXPLAIN_PATH_H

#include "render/path_log.h"

#include <jansson.h>

void bp_path_print(const BpScene *scene, const BpPathLog *path, uint32_t x, uint32_t y, uint64_t sample,
                   uint64_t seed);

/* A new object, or NULL without memory. */
json_t *bp_path_json(const BpScene *scene, const BpPathLog *path, uint32_t x, uint32_t y, uint64_t sample);

#endif
