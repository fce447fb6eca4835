/* stop_rule.h: when a render has enough samples.
 *
 * In:    what --spp, --error and --time ask for; how far the render is.
 * Out:   the sample count up to which to go on before asking again; or why to stop.
 * Knows: sample counts, the error's fall with their square root.   Does not know: the render, the clock.
 *
 * The error is looked at on fixed sample counts only (bp_stop_checkpoint), and which of them are looked at
 * follows from the samples alone: the same scene, seed and --error end at the same count on every run. --time
 * chooses a count by the clock, but always a whole one for every pixel. */
#ifndef BP_CLI_STOP_RULE_H
#define BP_CLI_STOP_RULE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct BpStopRule {
    double error;         /* NRMSE to reach, a fraction; 0: no such rule */
    double seconds;       /* 0: no such rule */
    uint64_t samples_max; /* a pixel */
    uint64_t samples_min; /* a pixel, before the error is believed; unless samples_max is less */
    bool adaptive;        /* samples are means; the error falls faster at first than their square root */
} BpStopRule;

typedef enum BpStopReason {
    BP_STOP_NOT_YET,
    BP_STOP_SAMPLES,
    BP_STOP_ERROR,
    BP_STOP_TIME,
    BP_STOP_CONSTANT, /* no two samples of a pixel differ */
    BP_STOP_BLACK,    /* no sample brought light: there is no relative error */
    BP_STOP_INVALID   /* a pixel has no sample that is light, or next to none: its error stays unknown */
} BpStopReason;

/* How far a render is, all pixels having the same number of samples. */
typedef struct BpStopState {
    uint64_t samples; /* a pixel */
    double seconds;   /* of rendering so far */
    double nrmse;     /* NaN: unknown; looked at only for an error rule */
    bool black;       /* the mean of the picture is 0 */
} BpStopState;

/* Fills all but `adaptive`, which becomes false; samples_min for a picture of `pixels`: enough samples of
 * each pixel (16) and of the picture (65536).
 */
void bp_stop_rule_init(BpStopRule *rule, double error, double seconds, uint64_t samples_max, uint64_t pixels);

/* The least fixed count that is not below `samples` nor below the minimum: multiples of 4 in steps of 4 up to
 * 64, then of about an eighth. */
uint64_t bp_stop_checkpoint(const BpStopRule *rule, double samples);

/* The first count to go to; at least 1. */
uint64_t bp_stop_first(const BpStopRule *rule);

/* Whether to stop; if not (BP_STOP_NOT_YET), *next is the count to go to, above state->samples. */
BpStopReason bp_stop_decide(const BpStopRule *rule, const BpStopState *state, uint64_t *next);

/* Samples a pixel at which the render will probably end, for the progress bar; never above samples_max. */
double bp_stop_expected(const BpStopRule *rule, const BpStopState *state);

const char *bp_stop_reason_name(BpStopReason reason); /* "samples", "error", ...; "interrupt" for not yet */

#endif
