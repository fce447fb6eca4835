/* timing.c: ratios of the times of configurations that take turns; see timing.h. */
#include "timing.h"

#include "base/quantile.h"

#include <math.h>

#define ROUNDS_MIN 6u /* the fewest rounds whose smallest and largest ratios enclose the median with 95 % */

/* How many values at either end of `count` sorted ones lie outside the 95 % interval of their median: the
 * median lies below the value of rank k, counted from 0, if at most k values do, with the probability of at
 * most k heads in `count` throws (the sign test's interval: W. Conover, Practical Nonparametric Statistics,
 * 3.2). */
static size_t left_out(size_t count) {
    double chance = pow(0.5, (double)count), below = chance;
    size_t k = 0;
    for (;;) {
        chance *= (double)(count - k) / (double)(k + 1);
        if (below + chance > 0.025) return k;
        below += chance;
        ++k;
    }
}

double bp_study_round_sum(const double *values, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; i++) sum += values[i];
    return sum;
}

double bp_study_round_seconds(const double *rounds, const double *samples, size_t count) {
    double rates[BP_STUDY_ROUNDS_MAX];
    if (count < ROUNDS_MIN) return bp_study_round_sum(rounds, count);
    for (size_t i = 0; i < count; i++) rates[i] = rounds[i] / samples[i];
    bp_sort_doubles(rates, count);
    const double rate = bp_quantile(rates, count, 0.5);
    return rate > 0 ? rate * bp_study_round_sum(samples, count)
                    : bp_study_round_sum(rounds, count); /* 0: a clock too coarse */
}

BpStudyEstimate bp_study_round_ratio(const double *own, const double *base, size_t count) {
    double ratios[BP_STUDY_ROUNDS_MAX];
    for (size_t i = 0; i < count; i++)
        if (!(base[i] > 0) || !(own[i] > 0)) count = 0; /* a clock too coarse for rounds */
    if (count < ROUNDS_MIN) return (BpStudyEstimate){(double)NAN, (double)NAN, (double)NAN};
    for (size_t i = 0; i < count; i++) ratios[i] = own[i] / base[i];
    bp_sort_doubles(ratios, count);
    const size_t k = left_out(count);
    return (BpStudyEstimate){bp_quantile(ratios, count, 0.5), ratios[k], ratios[count - 1 - k]};
}
