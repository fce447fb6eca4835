/* vector.h: products of three doubles.
 *
 * In and out: vectors as arrays.   Knows: nothing.   Does not know: what they stand for. */
#ifndef BP_SCENE_VECTOR_H
#define BP_SCENE_VECTOR_H

#include <string.h>

static inline double bp_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* `out` may be `a` or `b`. */
static inline void bp_cross(const double a[3], const double b[3], double out[3]) {
    const double result[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                              a[0] * b[1] - a[1] * b[0]};
    memcpy(out, result, sizeof result);
}

#endif
