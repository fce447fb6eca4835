/* stats.h: what --stats writes.
 *
 * In:    the finished (or interrupted) render, times of the program's own steps.   Out: a JSON document.
 * Knows: the names of its members (fixed).   Does not know: when it is written, how anything was measured. */
#ifndef BP_CLI_STATS_H
#define BP_CLI_STATS_H

#include "render/render.h"

#include <jansson.h>

typedef struct BpRunTimes {
    double start;                      /* bp_clock_seconds() when the command began */
    double load, create, trace, write; /* seconds; create: tree, packing, kernel, upload */
} BpRunTimes;

typedef struct BpRunResult {
    const char *scene_path, *output;
    const BpScene *scene;
    const BpRenderOptions *options;
    const BpFilm *film;
    BpRenderReport report;
    BpRunTimes times;
    size_t device_count;
    uint64_t samples_per_pixel; /* of every pixel */
    double nrmse;               /* NaN: unknown */
    BpStopReason stopped_by;    /* BP_STOP_NOT_YET: interrupted */
} BpRunResult;

/* The document, or NULL when memory ran out. */
json_t *bp_stats_json(const BpRunResult *result);

#endif
