/* render_loop.c: see render_loop.h. */
#include "render_loop.h"

#include "../base/clock.h"
#include "interrupt.h"
#include "progress.h"
#include "report.h"
#include "terminal.h"

#include <math.h>

#define REDRAW_SECONDS 0.1
/* The error on the bar costs a read of all sums: at most this share of the time is spent on it. */
#define ERROR_SHARE 0.02
#define ERROR_SECONDS_MIN 1.0

typedef struct Bar {
    bool live;
    double drawn;                /* when */
    double error_next;           /* when the error may be looked at again */
    double nrmse, nrmse_samples; /* as last seen, and with how many samples a pixel */
    char text[512];
} Bar;

/* Looks at the error as it stands: exact between passes, and close enough for a bar amid one. */
static BpStatus refresh_error(BpRender *render, uint64_t pixels, Bar *bar, BpError *err) {
    const double start = bp_clock_seconds();
    if (start < bar->error_next || bp_render_samples_done(render) < BP_REPLICATES_DEFAULT) return BP_OK;
    const BpAccumulator *accumulator = NULL;
    BP_TRY(bp_render_accumulator(render, &accumulator, err));
    bar->nrmse = bp_accumulator_nrmse(accumulator);
    BpRenderReport report; /* knows of the chunks that this read has waited for */
    bp_render_report(render, &report);
    bar->nrmse_samples = (double)report.samples / (double)pixels;
    const double end = bp_clock_seconds();
    bar->error_next = end + fmax(ERROR_SECONDS_MIN, (end - start) / ERROR_SHARE);
    return BP_OK;
}

static BpStatus draw(BpRender *render, const BpStopRule *rule, const BpProgress *progress, uint64_t pixels,
                     double seconds, Bar *bar, BpError *err) {
    const double now = bp_clock_seconds();
    if (!bar->live || now - bar->drawn < REDRAW_SECONDS) return BP_OK;
    const double samples = (double)progress->samples_done / (double)pixels;
    BpRenderReport report;
    bp_render_report(render, &report);
    /* The first launch, in which a driver may compile, says nothing about the rate. */
    const double tracing = fmax(seconds - report.first_launch_seconds, 1.0e-3);
    BP_TRY(refresh_error(render, pixels, bar, err));
    /* Between two looks it falls with the square root of the samples. */
    const double nrmse = samples > 0.0 ? bar->nrmse * sqrt(bar->nrmse_samples / samples) : NAN;
    const BpStopState state = {.samples = (uint64_t)samples, .seconds = seconds, .nrmse = nrmse};
    const double expected = fmax(bp_stop_expected(rule, &state), samples);
    double fraction = samples / expected;
    double left = samples > 0.0 ? tracing * (expected - samples) / samples : NAN;
    if (rule->seconds > 0.0) {
        /* Until the first whole pass the clock is all there is to go by. */
        fraction = fmax(state.samples > 0 ? fraction : 0.0, fmin(1.0, seconds / rule->seconds));
        left = fmin(left, fmax(0.0, rule->seconds - seconds));
    }
    const BpProgressView view = {.fraction = fraction,
                                 .samples_per_second = (double)progress->samples_done / tracing,
                                 .nrmse = nrmse,
                                 .seconds_left = left};
    bp_terminal_show(bp_progress_format(&view, bp_terminal_columns(), bp_terminal_has_utf8(), bar->text,
                                        sizeof bar->text));
    bar->drawn = now;
    return BP_OK;
}

/* Whether --time is over although the stretch of samples under way is not: the rate fell. The first sample of
 * every pixel is waited for: half a picture is none. */
static bool is_overtime(const BpRender *render, const BpStopRule *rule, double seconds) {
    return rule->seconds > 0.0 && seconds > rule->seconds + fmax(0.25, 0.02 * rule->seconds) &&
           bp_render_samples_done(render) > 0;
}

static BpStatus look(BpRender *render, const BpStopRule *rule, BpStopState *state, BpError *err) {
    if (rule->error <= 0.0) return BP_OK;
    const BpAccumulator *accumulator = NULL;
    BP_TRY(bp_render_accumulator(render, &accumulator, err));
    double mean[3];
    bp_accumulator_mean(accumulator, mean);
    state->nrmse = bp_accumulator_nrmse(accumulator);
    state->black = mean[0] <= 0.0 && mean[1] <= 0.0 && mean[2] <= 0.0;
    return BP_OK;
}

BpStatus bp_render_loop(BpRender *render, const BpStopRule *rule, uint64_t pixels, bool quiet, BpLoopEnd *end,
                        BpError *err) {
    const double start = bp_clock_seconds();
    BpStatus status = BP_OK;
    BpStopState state = {.samples = bp_stop_first(rule), .nrmse = NAN};
    Bar bar = {.live = bp_terminal_is_live(quiet), .nrmse = NAN, .drawn = start};
    end->reason = BP_STOP_NOT_YET;
    bp_interrupt_catch();
    while (end->reason == BP_STOP_NOT_YET) {
        BpProgress progress;
        BP_TRY_GOTO(status, bp_render_step(render, &progress, err), done);
        state.seconds = bp_clock_seconds() - start;
        if (!bp_interrupted())
            BP_TRY_GOTO(status, draw(render, rule, &progress, pixels, state.seconds, &bar, err), done);
        uint64_t next = state.samples;
        if (progress.finished) {
            BP_TRY_GOTO(status, look(render, rule, &state, err), done);
            end->reason = bp_stop_decide(rule, &state, &next);
        } else if (is_overtime(render, rule, state.seconds)) {
            end->reason = BP_STOP_TIME;
        }
        if (bp_interrupted()) break; /* with a reason to stop it is no interruption */
        if (next > state.samples) BP_TRY_GOTO(status, bp_render_extend(render, next, err), done);
        state.samples = next;
    }
done:
    end->seconds = bp_clock_seconds() - start;
    if (bar.drawn > start) bp_terminal_show("");
    return status;
}
