/* stop_rule.h: the decisions behind the stop rules of ballpark.h, on numbers alone.
 *
 * In:    what --spp, --error and --time ask for; how far the render is.
 * Out:   the sample count to reach before the next decision; or the reason to stop.
 * Knows: sample counts, that noise falls with their square root.   Does not know: clocks, how a picture is
 * rendered.
 *
 * Noise is estimated at fixed sample counts only (bp_stop_checkpoint), and which of them are used depends
 * on the samples alone: the same scene, seed and --error end at the same count on every run. --time
 * chooses a count by the clock, but always a whole one for every pixel. */
#ifndef BP_RENDER_STOP_RULE_H
#define BP_RENDER_STOP_RULE_H

#include "ballpark.h"

/* The progress of a render in which all pixels have the same number of samples. */
typedef struct BpStopState {
    uint64_t samples;        /* a pixel */
    uint64_t samples_before; /* of these, those that a resumed render began with: they took no time of it */
    double seconds;          /* of rendering so far */
    double nrmse;            /* NaN: unknown; looked at only for an error rule */
    bool black;              /* the mean of the picture is 0 */
} BpStopState;

/* Fills all but `adaptive`, which becomes false; samples_min for a picture of `pixels`: enough samples of
 * each pixel (16) and of the picture (65536). Below, samples_max is not 0. */
void bp_stop_rule_init(BpStopRule *rule, double error, double seconds, uint64_t samples_max, uint64_t pixels);

/* The least fixed count that is not below `samples` nor below the minimum: multiples of 4 in steps of 4 up to
 * 64, then of about an eighth. */
uint64_t bp_stop_checkpoint(const BpStopRule *rule, double samples);

/* The first count to go to; at least 1. */
uint64_t bp_stop_first(const BpStopRule *rule);

/* Whether to stop; if not (BP_STOP_NOT_YET), *next is the count to go to, above state->samples. */
BpStopReason bp_stop_decide(const BpStopRule *rule, const BpStopState *state, uint64_t *next);

/* Samples per pixel at which the render will probably end, for a progress bar; never above samples_max. */
double bp_stop_expected(const BpStopRule *rule, const BpStopState *state);

#endif
