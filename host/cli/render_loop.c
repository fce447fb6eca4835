/* render_loop.c: see render_loop.h. */
#include "render_loop.h"

#include "base/clock.h"
#include "base/format.h"
#include "interrupt.h"
#include "progress.h"
#include "terminal.h"

#define REDRAW_SECONDS 0.1

typedef struct Bar {
    bool live;
    double drawn; /* when */
    char text[512];
} Bar;

static BpStatus draw(BpStop *stop, const BpProgress *progress, Bar *bar, BpError *err) {
    const double now = bp_clock_seconds();
    if (!bar->live || now - bar->drawn < REDRAW_SECONDS) return BP_OK;
    BpStopEstimate estimate;
    BP_TRY(bp_stop_estimate(stop, progress, &estimate, err));
    const BpProgressView view = {.fraction = estimate.fraction,
                                 .samples_per_second = estimate.samples_per_second,
                                 .nrmse = estimate.nrmse,
                                 .seconds_left = estimate.seconds_left};
    bp_terminal_show(bp_progress_format(&view, bp_terminal_columns(), bp_terminal_has_utf8(), bar->text,
                                        sizeof bar->text));
    bar->drawn = now;
    return BP_OK;
}

BpStatus bp_render_loop(BpRender *render, const BpStopRule *rule, bool quiet, BpLoopEnd *end, BpError *err) {
    const double start = bp_clock_seconds();
    BpStatus status = BP_OK;
    BpStop *stop = NULL;
    Bar bar = {.live = bp_terminal_is_live(quiet), .drawn = start};
    end->reason = BP_STOP_NOT_YET;
    bp_interrupt_catch();
    BP_TRY_GOTO(status, bp_stop_create(render, rule, &stop, err), done);
    while (end->reason == BP_STOP_NOT_YET) {
        BpProgress progress;
        BP_TRY_GOTO(status, bp_render_step(render, &progress, err), done);
        if (!bp_interrupted()) BP_TRY_GOTO(status, draw(stop, &progress, &bar, err), done);
        BP_TRY_GOTO(status, bp_stop_check(stop, &progress, &end->reason, err), done);
        if (bp_interrupted()) break; /* with a reason to stop it is no interruption */
    }
done:
    bp_stop_destroy(&stop);
    end->seconds = bp_clock_seconds() - start;
    if (bar.drawn > start) bp_terminal_show("");
    return status;
}
