/* timing.h: robust times of configurations that take turns.
 *
 * In:    seconds of rounds.   Out: undisturbed seconds, ratios with their intervals.
 * Knows: order statistics.    Does not know: what was timed.
 *
 * A machine with other load is occasionally slower, by a quarter or more, for a few tenths of a second. So
 * configurations take turns in short rounds of equal work, and medians over rounds are compared: a
 * disturbance of one configuration in one round is an outlier, and one of a whole round cancels. */
#ifndef BP_STUDY_TIMING_H
#define BP_STUDY_TIMING_H

#include "study.h"

#define BP_STUDY_ROUNDS_MAX 16u

double bp_study_round_sum(const double *rounds, size_t count);
/* Seconds of all `count` <= BP_STUDY_ROUNDS_MAX rounds as if none had been disturbed: the median rate times
 * all samples. With few rounds, their sum. */
double bp_study_round_seconds(const double *rounds, const double *samples, size_t count);
/* One configuration's time over the base's: the median of the rounds' ratios, with its 95 % interval. NaN:
 * too few. */
BpStudyEstimate bp_study_round_ratio(const double *own, const double *base, size_t count);

#endif
