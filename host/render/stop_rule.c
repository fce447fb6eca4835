/* stop_rule.c: see stop_rule.h. */
#include "stop_rule.h"

#include <math.h>

enum { PIXEL_SAMPLES_MIN = 16, PICTURE_SAMPLES_MIN = 65536, COUNT_STEP = 4 };

/* An estimate from few samples is not trusted to jump further than this. */
#define JUMP_MAX 4.0
#define JUMP_MAX_ADAPTIVE 2.0
/* A jump lands short of the predicted end, so that the end is met in small steps. */
#define JUMP_SHARE 0.85
/* Share of the remaining time that one stretch of samples takes, the rate being an estimate. */
#define TIME_SHARE 0.8
#define TIME_SHARE_ADAPTIVE 0.5 /* its samples go to dearer pixels as it goes on */

static uint64_t round_up(uint64_t count) {
    return (count + COUNT_STEP - 1) / COUNT_STEP * COUNT_STEP;
}

void bp_stop_rule_init(BpStopRule *rule, double error, double seconds, uint64_t samples_max,
                       uint64_t pixels) {
    rule->error = error;
    rule->seconds = seconds;
    rule->samples_max = samples_max;
    rule->adaptive = false;
    rule->samples_min = round_up((PICTURE_SAMPLES_MIN + pixels - 1) / pixels);
    if (rule->samples_min < PIXEL_SAMPLES_MIN) rule->samples_min = PIXEL_SAMPLES_MIN;
}

uint64_t bp_stop_checkpoint(const BpStopRule *rule, double samples) {
    uint64_t count = PIXEL_SAMPLES_MIN;
    while ((double)count < samples || count < rule->samples_min) {
        const uint64_t step = count / 8 / COUNT_STEP * COUNT_STEP;
        count += step < COUNT_STEP ? COUNT_STEP : step;
    }
    return count;
}

static uint64_t smaller(uint64_t a, uint64_t b) {
    return a < b ? a : b;
}

uint64_t bp_stop_first(const BpStopRule *rule) {
    if (rule->seconds > 0.0) return 1; /* its time tells how many more there is time for */
    if (rule->error > 0.0) return smaller(bp_stop_checkpoint(rule, 0.0), rule->samples_max);
    return rule->samples_max;
}

/* More samples that the remaining time allows. */
static double samples_in_time(const BpStopRule *rule, const BpStopState *state) {
    const uint64_t own = state->samples > state->samples_before ? state->samples - state->samples_before : 0;
    /* A resumed render that has made no samples yet knows no rate, so it makes one more. */
    if (own == 0 && state->samples_before > 0) return state->seconds < rule->seconds ? 1.0 : 0.0;
    return (rule->seconds - state->seconds) * (double)own / fmax(state->seconds, 1.0e-6);
}

/* The count at which the error will probably have been reached, since it falls with the square root. */
static double samples_for_error(const BpStopRule *rule, const BpStopState *state) {
    if (!isfinite(state->nrmse)) return (double)state->samples;
    return (double)state->samples * (state->nrmse / rule->error) * (state->nrmse / rule->error);
}

static BpStopReason decide_error(const BpStopRule *rule, const BpStopState *state) {
    if (rule->error <= 0.0 || state->samples < rule->samples_min) return BP_STOP_NOT_YET;
    if (state->black) return BP_STOP_BLACK;
    if (state->nrmse == 0.0) return BP_STOP_CONSTANT;
    /* By now a pixel can lack an error only because samples were left out, and more samples would be left out
     * too. */
    if (isnan(state->nrmse)) return BP_STOP_INVALID;
    /* Between fixed counts, where --time may have stopped for a look, no decision is made. */
    if (state->samples != bp_stop_checkpoint(rule, (double)state->samples)) return BP_STOP_NOT_YET;
    return state->nrmse <= rule->error ? BP_STOP_ERROR : BP_STOP_NOT_YET;
}

BpStopReason bp_stop_decide(const BpStopRule *rule, const BpStopState *state, uint64_t *next) {
    const BpStopReason reason = decide_error(rule, state);
    if (reason != BP_STOP_NOT_YET) return reason;
    if (state->samples >= rule->samples_max) return BP_STOP_SAMPLES;
    *next = rule->samples_max;
    if (rule->error > 0.0) {
        const double jump_max = rule->adaptive ? JUMP_MAX_ADAPTIVE : JUMP_MAX;
        const double wanted =
            fmin(JUMP_SHARE * samples_for_error(rule, state), jump_max * (double)state->samples);
        *next = smaller(*next, bp_stop_checkpoint(rule, fmax(wanted, (double)(state->samples + 1))));
    }
    if (rule->seconds > 0.0) {
        const double more = samples_in_time(rule, state);
        if (more < 1.0) return BP_STOP_TIME;
        const double part = rule->adaptive ? TIME_SHARE_ADAPTIVE : TIME_SHARE;
        const double share = fmax(1.0, floor(part * more));
        if (share < 9.0e18) *next = smaller(*next, state->samples + (uint64_t)share);
    }
    return BP_STOP_NOT_YET;
}

double bp_stop_expected(const BpStopRule *rule, const BpStopState *state) {
    double end = (double)rule->samples_max;
    if (rule->error > 0.0 && isfinite(state->nrmse))
        end = fmin(end, fmax(samples_for_error(rule, state), (double)rule->samples_min));
    if (rule->seconds > 0.0)
        end = fmin(end, (double)state->samples + fmax(0.0, samples_in_time(rule, state)));
    return end;
}
