/* run_report.h: what is told of a render that has stopped: its statistics (--stats) and its summary.
 *
 * In:    the render's report, its film, what is claimed of its noise.   Out: JSON, sentences.
 * Knows: the members of --stats, what people should hear of.   Does not know: how the render went on. */
#ifndef BP_CLI_JOB_RUN_REPORT_H
#define BP_CLI_JOB_RUN_REPORT_H

#include "checkpoint.h"
#include "cli/line/options.h"
#include "cluster/comm.h"
#include "render/render.h"
#include "render_loop.h"

#include <jansson.h>

typedef struct BpRunTimes {
    double start;       /* bp_clock_seconds() when the command began */
    double load, write; /* seconds */
} BpRunTimes;

typedef struct BpRunResult {
    const char *scene_path, *output;
    const BpScene *scene;
    const BpRenderOptions *options;
    const BpFilm *film;
    BpRenderReport report;
    BpRunTimes times;
    size_t device_count;
    BpComm *comm; /* the ranks that share the picture; NULL: none */
    const BpCheckpoint *checkpoint;
    uint64_t samples_per_pixel; /* of every pixel */
    BpFilmClaim claim;
    BpUnseenLight unseen;
    BpStopReason stopped_by; /* BP_STOP_NOT_YET: interrupted */
} BpRunResult;

/* The document, or NULL when memory ran out. */
json_t *bp_run_stats(const BpRunResult *result);

void bp_run_print_summary(const BpCommandLine *line, const BpRunResult *result, const BpStopRule *rule,
                          const BpLoopEnd *end);

/* What to say of a render that was interrupted, and what can be done about it: BP_ERR_INTERRUPTED. */
BpStatus bp_run_interrupted(const BpCommandLine *line, const BpStopRule *rule, const BpLoopEnd *end,
                            const BpCheckpoint *checkpoint, const BpRunResult *result, BpError *err);

#endif
