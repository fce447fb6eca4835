/* render_loop.h: renders until a stop rule applies or Ctrl-C is pressed.
 *
 * In:    a render that has made no step yet, its rule, its checkpoint, its preview.   Out: why it has ended.
 * Knows: signals, the progress bar, the messages between ranks.   Does not know: what becomes of the picture.
 */
#ifndef BP_CLI_JOB_RENDER_LOOP_H
#define BP_CLI_JOB_RENDER_LOOP_H

#include "checkpoint.h"
#include "cli/line/options.h"
#include "cluster/comm.h"
#include "preview.h"
#include "render/stop_rule.h"

typedef struct BpLoopEnd {
    BpStopReason reason; /* BP_STOP_NOT_YET: interrupted */
    double seconds;      /* spent here, by the wall clock */
} BpLoopEnd;

/* Catches Ctrl-C from here on. `shared`: the ranks that share the picture; NULL: none. */
BpStatus bp_render_loop(const BpCommandLine *line, BpComm *shared, BpRender *render, const BpStopRule *rule,
                        BpCheckpoint *checkpoint, BpPreview *preview, BpLoopEnd *end, BpError *err);

#endif
