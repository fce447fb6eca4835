/* vector.h: products and lengths of three doubles.
 *
 * In and out: vectors and points as arrays.   Knows: nothing.   Does not know: what they stand for. */
#ifndef BP_SCENE_VECTOR_H
#define BP_SCENE_VECTOR_H

#include <math.h>
#include <string.h>

static inline double bp_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double bp_length(const double v[3]) {
    return sqrt(bp_dot(v, v));
}

static inline double bp_distance2(const double a[3], const double b[3]) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

static inline void bp_way(const double from[3], const double to[3], double v[3]) {
    for (int a = 0; a < 3; a++) v[a] = to[a] - from[a];
}

/* `out` may be `a` or `b`. */
static inline void bp_cross(const double a[3], const double b[3], double out[3]) {
    const double result[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                              a[0] * b[1] - a[1] * b[0]};
    memcpy(out, result, sizeof result);
}

/* Makes `v` a unit vector and returns the length that it had. Without a length it stays as it is. */
static inline double bp_normalize(double v[3]) {
    const double length = hypot(hypot(v[0], v[1]), v[2]);
    for (int i = 0; i < 3 && length > 0; ++i) v[i] /= length;
    return length;
}

/* Two unit vectors across a unit vector, and across each other. */
static inline void bp_across(const double axis[3], double u[3], double v[3]) {
    const int a = fabs(axis[0]) < 0.5 ? 0 : 1;
    double helper[3] = {0};
    helper[a] = 1;
    bp_cross(axis, helper, u);
    bp_normalize(u);
    bp_cross(axis, u, v);
}

#endif
