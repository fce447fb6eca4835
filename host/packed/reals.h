/* reals.h: doubles stored in packed arrays, in the precision of the device.
 *
 * In:    doubles.   Out: reals, rounded to nearest or to one side.
 * Knows: the two precisions of `real` (kernels/scene_types.h).   Does not know: what the numbers mean. */
#ifndef BP_PACKED_REALS_H
#define BP_PACKED_REALS_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* Stores `value` at `array[index]`, rounded to nearest when the array is single. */
static inline void bp_reals_store(void *array, bool single, size_t index, double value) {
    if (single)
        ((float *)array)[index] = (float)value;
    else
        ((double *)array)[index] = value;
}

/* The same, rounded so that the stored number is not above (down) or not below (up) the value. */
static inline void bp_reals_store_down(void *array, bool single, size_t index, double value) {
    if (single) {
        float f = (float)value;
        if ((double)f > value) f = nextafterf(f, -INFINITY);
        ((float *)array)[index] = f;
    } else {
        ((double *)array)[index] = value;
    }
}
static inline void bp_reals_store_up(void *array, bool single, size_t index, double value) {
    if (single) {
        float f = (float)value;
        if ((double)f < value) f = nextafterf(f, INFINITY);
        ((float *)array)[index] = f;
    } else {
        ((double *)array)[index] = value;
    }
}

static inline double bp_reals_load(const void *array, bool single, size_t index) {
    return single ? (double)((const float *)array)[index] : ((const double *)array)[index];
}

#endif
