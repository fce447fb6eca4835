/* stop.c: follows a render until its rule says to stop; see ballpark.h.
 *
 * In:    a render between two steps, a rule.   Out: more samples for the render; why to stop; how far it is.
 * Knows: the render, the clock.   Does not know: how a rule decides (stop_rule.h does), the terminal. */
#include "stop_rule.h"

#include "base/clock.h"
#include "base/status.h"
#include "render.h"
#include "render_state.h"

#include <math.h>
#include <stdlib.h>

/* A look at the error between two decisions reads all sums. Such looks take at most this share of the time.
 */
#define ERROR_SHARE 0.02
#define ERROR_SECONDS_MIN 1.0
/* How long the first sample of every pixel is waited for after the time that a rule allows. */
#define FIRST_SAMPLE_SECONDS 1.0

struct BpStop {
    BpRender *render;
    BpStopRule rule;
    BpStopState state;
    BpStopReason reason;
    uint64_t pixels;
    double start;
    double error_next;           /* when an estimate may look at the error again */
    double nrmse, nrmse_samples; /* as an estimate last saw it, and with how many samples per pixel */
};

const char *bp_stop_reason_name(BpStopReason reason) {
    switch (reason) {
    case BP_STOP_NOT_YET:
        return "interrupt";
    case BP_STOP_SAMPLES:
        return "samples";
    case BP_STOP_ERROR:
        return "error";
    case BP_STOP_TIME:
        return "time";
    case BP_STOP_CONSTANT:
        return "constant";
    case BP_STOP_BLACK:
        return "black";
    case BP_STOP_INVALID:
        return "invalid";
    }
    return "";
}

void bp_stop_rule_defaults(const BpScene *scene, const BpRenderOptions *options, BpStopRule *rule) {
    bp_stop_rule_init(rule, 0.0, 0.0, options->samples_per_pixel,
                      (uint64_t)scene->camera.width * scene->camera.height);
    rule->adaptive = options->adaptive;
}

/* As many samples per pixel as sums and sample numbers allow. */
static uint64_t samples_limit(const BpRenderOptions *options) {
    const uint64_t exact = (uint64_t)BP_REPLICATE_SAMPLES_MAX * options->replicates;
    const uint64_t numbers = (uint64_t)UINT32_MAX + 1 - options->first_sample;
    return exact < numbers ? exact : numbers;
}

static BpStatus check_rule(const BpRender *render, const BpStopRule *rule, BpError *err) {
    if (bp_render_has_begun(render) && bp_render_pixel_samples(render) != render->base_samples)
        return bp_fail(err, BP_ERR_USAGE, "a stop rule must be given before the first step of a render");
    if (!isfinite(rule->error) || rule->error < 0.0 || !isfinite(rule->seconds) || rule->seconds < 0.0)
        return bp_fail(err, BP_ERR_USAGE,
                       "a stop rule with error %g and %g seconds: expected positive numbers, or 0 for none",
                       rule->error, rule->seconds);
    if (rule->error == 0.0 && rule->seconds == 0.0 && rule->samples_max == 0)
        return bp_fail(
            err, BP_ERR_USAGE,
            "a stop rule without error, time and samples would never stop: set at least one of them");
    if (rule->adaptive != render->options.adaptive)
        return bp_fail(err, BP_ERR_USAGE,
                       "the stop rule is%s adaptive, but the render is%s: use the same for both",
                       rule->adaptive ? "" : " not", render->options.adaptive ? "" : " not");
    return BP_OK;
}

/* A resumed render goes on to where it was going; other renders begin with what the rule says. */
static uint64_t first_samples(const BpRender *render, const BpStopRule *rule) {
    const uint64_t target = render->options.samples_per_pixel;
    if (!render->resumed) return bp_stop_first(rule);
    return target < rule->samples_max ? target : rule->samples_max;
}

BpStatus bp_stop_create(BpRender *render, const BpStopRule *rule, BpStop **stop, BpError *err) {
    BP_TRY(check_rule(render, rule, err));
    BpStopRule checked = *rule;
    if (checked.samples_max == 0) checked.samples_max = samples_limit(&render->options);
    BpStop *made = calloc(1, sizeof *made);
    if (made == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory to follow a render");
    made->render = render;
    made->rule = checked;
    made->pixels = (uint64_t)render->scene->camera.width * render->scene->camera.height;
    made->state = (BpStopState){.samples = first_samples(render, &checked),
                                .samples_before = bp_render_samples_done(render),
                                .nrmse = NAN};
    made->nrmse = NAN;
    /* The most that the rule may ask for is tried first, so that it cannot be refused on the way. */
    BpStatus status = bp_render_check_samples(render, checked.samples_max, err);
    if (status == BP_OK) status = bp_render_extend(render, made->state.samples, err);
    render->goal_samples = checked.samples_max;
    render->goal_error = checked.error;
    made->start = bp_clock_seconds();
    if (status == BP_OK)
        *stop = made;
    else
        free(made);
    return status;
}

void bp_stop_destroy(BpStop **stop) {
    if (stop == NULL) return;
    free(*stop);
    *stop = NULL;
}

/* ---- deciding ---- */

/* Whether the time is over before the stretch of samples under way is finished, because the rate fell. The
 * first sample of every pixel is waited for a little longer, since half a picture is of no use; the time in
 * which a driver compiles at the first launch does not count. */
static bool is_overtime(const BpStop *stop) {
    const double limit = stop->rule.seconds, seconds = stop->state.seconds;
    if (limit <= 0.0) return false;
    if (bp_render_samples_done(stop->render) > 0) return seconds > limit + fmax(0.25, 0.02 * limit);
    BpRenderReport report;
    bp_render_report(stop->render, &report);
    return seconds - report.first_launch_seconds > limit + FIRST_SAMPLE_SECONDS;
}

static BpStatus look(BpStop *stop, BpError *err) {
    if (stop->rule.error <= 0.0) return BP_OK;
    const BpFilm *film = NULL;
    BP_TRY(bp_render_read_film(stop->render, &film, err));
    if (!bp_comm_is_root(stop->render->comm)) return BP_OK;
    double mean[3];
    bp_film_mean(film, mean);
    stop->state.nrmse = bp_film_nrmse(film);
    stop->state.black = mean[0] <= 0.0 && mean[1] <= 0.0 && mean[2] <= 0.0;
    return BP_OK;
}

static BpStatus decide(BpStop *stop, const BpProgress *progress, uint64_t *next, BpError *err) {
    stop->state.seconds = bp_clock_seconds() - stop->start;
    if (progress->finished) {
        BP_TRY(look(stop, err));
        stop->reason = bp_stop_decide(&stop->rule, &stop->state, next);
    } else if (is_overtime(stop)) {
        stop->reason = BP_STOP_TIME;
    }
    /* Ranks may see other clocks, and rank 0 alone the whole film. */
    struct Decision {
        uint64_t next;
        int32_t reason;
    } decision = {*next, (int32_t)stop->reason};
    BP_TRY(bp_comm_broadcast(stop->render->comm, &decision, sizeof decision, err));
    *next = decision.next;
    stop->reason = (BpStopReason)decision.reason;
    return BP_OK;
}

BpStatus bp_stop_check(BpStop *stop, const BpProgress *progress, BpStopReason *reason, BpError *err) {
    *reason = stop->reason;
    if (stop->reason != BP_STOP_NOT_YET) return BP_OK;
    uint64_t next = stop->state.samples;
    BP_TRY(decide(stop, progress, &next, err));
    *reason = stop->reason;
    stop->render->ended = stop->reason != BP_STOP_NOT_YET && stop->reason != BP_STOP_TIME;
    if (next > stop->state.samples) BP_TRY(bp_render_extend(stop->render, next, err));
    stop->state.samples = next;
    return BP_OK;
}

/* ---- estimating ---- */

/* Looks at the error as it stands: exact between passes, and close enough for an estimate amid one. */
static BpStatus refresh_error(BpStop *stop, BpError *err) {
    const double start = bp_clock_seconds();
    if (start < stop->error_next || bp_render_samples_done(stop->render) < BP_REPLICATES_DEFAULT)
        return BP_OK;
    /* Of several ranks only this one looks, at what it has traced itself. */
    BpFilm *own = NULL;
    const BpFilm *film = NULL;
    uint64_t samples = 0;
    if (stop->render->comm != NULL)
        BP_TRY(bp_render_read_own_film(stop->render, &own, &samples, err));
    else
        BP_TRY(bp_render_read_film(stop->render, &film, err));
    stop->nrmse = bp_film_nrmse(own != NULL ? own : film);
    bp_film_destroy(&own);
    /* Reading has waited for chunks of which the step did not know. */
    if (stop->render->comm == NULL) samples = bp_render_pixel_samples(stop->render);
    stop->nrmse_samples = (double)samples / (double)stop->pixels;
    const double end = bp_clock_seconds();
    stop->error_next = end + fmax(ERROR_SECONDS_MIN, (end - start) / ERROR_SHARE);
    return BP_OK;
}

BpStatus bp_stop_estimate(BpStop *stop, const BpProgress *progress, BpStopEstimate *estimate, BpError *err) {
    const BpStopRule *rule = &stop->rule;
    const double seconds = bp_clock_seconds() - stop->start;
    const double samples = (double)progress->samples_done / (double)stop->pixels;
    const double before = (double)stop->render->base_samples / (double)stop->pixels; /* of no time of ours */
    const double own = samples - before;
    BpRenderReport report;
    bp_render_report(stop->render, &report);
    /* The first launch, in which a driver may compile, says nothing about the rate. */
    const double tracing = fmax(seconds - report.first_launch_seconds, 1.0e-3);
    BP_TRY(refresh_error(stop, err));
    /* Between two looks it falls with the square root of the samples. */
    const double nrmse = samples > 0.0 ? stop->nrmse * sqrt(stop->nrmse_samples / samples) : NAN;
    const BpStopState state = {.samples = (uint64_t)samples,
                               .samples_before = stop->state.samples_before,
                               .seconds = seconds,
                               .nrmse = nrmse};
    const double expected = fmax(bp_stop_expected(rule, &state), samples);
    double fraction = samples / expected;
    double left = own > 0.0 ? tracing * (expected - samples) / own : NAN;
    if (rule->seconds > 0.0) {
        /* Until the first whole pass the clock is all there is to go by. */
        fraction = fmax(state.samples > 0 ? fraction : 0.0, fmin(1.0, seconds / rule->seconds));
        left = fmin(left, fmax(0.0, rule->seconds - seconds));
    }
    *estimate = (BpStopEstimate){.seconds = seconds,
                                 .samples_per_second = own * (double)stop->pixels / tracing,
                                 .nrmse = nrmse,
                                 .fraction = fraction,
                                 .seconds_left = left};
    return BP_OK;
}
