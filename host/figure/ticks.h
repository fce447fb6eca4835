/* ticks.h: round numbers for the marks of a scale.
 *
 * In:    a range of values, how close marks may stand.   Out: the values' places and labels.
 * Knows: how numbers are written.   Does not know: what they mean, where they are drawn. */
#ifndef BP_FIGURE_TICKS_H
#define BP_FIGURE_TICKS_H

#include <stddef.h>

enum { BP_TICKS_MAX = 8, BP_TICK_LABEL_SIZE = 64 };

typedef struct BpTick {
    double share;                   /* 0 at the least value, 1 at the most */
    char label[BP_TICK_LABEL_SIZE]; /* UTF-8 */
} BpTick;

/* The multiples of 1, 2 or 5 by a power of ten that lie within the range: of the least of these steps that
 * leaves `apart`, a share of the range up to 1, from one mark to the next, and has at most BP_TICKS_MAX
 * marks. Where fewer than two are round, both ends, rounded. A range without width has one mark, in the
 * middle. All labels of a range differ, and have the same number of decimals and the same power of ten, which
 * very large and very small values have. Returns their number. */
size_t bp_ticks_choose(const double range[2], double apart, BpTick ticks[BP_TICKS_MAX]);

#endif
