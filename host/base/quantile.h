/* quantile.h: quantiles of measured values. */
#ifndef BP_BASE_QUANTILE_H
#define BP_BASE_QUANTILE_H

#include <stdlib.h>

static inline int bp_compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sorts in ascending order; no value may be NaN. */
static inline void bp_sort_doubles(double *values, size_t count) {
    qsort(values, count, sizeof *values, bp_compare_doubles);
}

/* The quantile `q`, 0 to 1, of sorted[count], count > 0: between neighbours linearly (R. Hyndman and Y. Fan,
 * "Sample Quantiles in Statistical Packages", 1996, type 7). */
static inline double bp_quantile(const double *sorted, size_t count, double q) {
    const double place = q * (double)(count - 1);
    const size_t below = (size_t)place;
    if (below + 1 >= count) return sorted[count - 1];
    return sorted[below] + (place - (double)below) * (sorted[below + 1] - sorted[below]);
}

#endif
