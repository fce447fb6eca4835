/* render_loop.h: steps a render until it is good enough, or someone loses patience.
 *
 * In:    an opened render, a stop rule.   Out: its samples; why and when it stopped.
 * Knows: Ctrl-C, the progress bar.   Does not know: when it is good enough (ballpark.h), files. */
#ifndef BP_CLI_RENDER_LOOP_H
#define BP_CLI_RENDER_LOOP_H

#include "render/render.h"

typedef struct BpLoopEnd {
    BpStopReason reason; /* BP_STOP_NOT_YET: interrupted */
    double seconds;      /* spent here, by the wall clock */
} BpLoopEnd;

/* `render` has made no step yet. Catches Ctrl-C from here on. `quiet`: no progress bar. */
BpStatus bp_render_loop(BpRender *render, const BpStopRule *rule, bool quiet, BpLoopEnd *end, BpError *err);

#endif
