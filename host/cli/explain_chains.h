/* explain_chains.h: explains the light that the first matte point of a path receives through balls of glass
 * and off mirrors.
 *
 * In:    a scene and the log of a path.   Out: the ways of that light, for a person or as JSON.
 * Knows: which ways are sampled, how they are found (study/chains.h).   Does not know: OpenCL. */
#ifndef BP_CLI_EXPLAIN_CHAINS_H
#define BP_CLI_EXPLAIN_CHAINS_H

#include "render/path_log.h"

#include <jansson.h>
#include <stdio.h>

typedef struct BpChainEntry BpChainEntry; /* a chain and its ways */

typedef struct BpChainLight {
    bool known;  /* the path has a matte point, and the scene has ways that can be sampled */
    size_t step; /* which of the path's meets the matte point */
    BpChainEntry *entries;
    size_t count;
} BpChainLight;

/* `max_depth`: of the path; longer ways are left out. BP_ERR_MEMORY. Free with bp_chain_light_clear(). */
BpStatus bp_chain_light_find(const BpScene *scene, const BpPathLog *path, uint32_t max_depth,
                             BpChainLight *light, BpError *err);
void bp_chain_light_clear(BpChainLight *light);

/* `sampled`: rays are sent there. */
void bp_chain_light_print(const BpScene *scene, const BpChainLight *light, bool sampled, FILE *out);
/* {"step", "sampled", "ways"}, or null where nothing is known. NULL without memory. */
json_t *bp_chain_light_json(const BpChainLight *light, bool sampled);

#endif
