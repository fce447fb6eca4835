/* oracle.h: where a line meets a sphere, in 113 bits, from the numbers that the device gets.
 *
 * Knows: arithmetic.   Does not know: any device, nor how the product does it. */
#ifndef TESTS_HARD_ORACLE_H
#define TESTS_HARD_ORACLE_H

#include <math.h>
#include <stdbool.h>

#if defined(__SIZEOF_FLOAT128__) && !defined(__cppcheck__) /* which does not know the type's size */
__extension__ typedef __float128 Wide;
#else
typedef long double Wide; /* 113 bits where CMake lets this be built */
#endif

/* Two Newton steps double the 53 bits of the first root twice. */
static inline Wide wide_sqrt(Wide x) {
    if (!(x > 0)) return 0;
    Wide root = (Wide)sqrt((double)x);
    if (!(root > 0)) return 0;
    root = (root + x / root) / 2;
    return (root + x / root) / 2;
}
static inline Wide wide_abs(Wide x) {
    return x < 0 ? -x : x;
}
static inline Wide wide_dot(const Wide a[3], const Wide b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

typedef struct Exact {
    bool meets;     /* the line meets the sphere */
    Wide near, far; /* in lengths of the direction */
    Wide middle;    /* the centre's foot on the line */
    Wide half_chord;
    double impact; /* distance of the line from the centre, in radii */
    double power;  /* (|origin - centre|^2 - r^2) / r^2: negative inside */
} Exact;

/* The ray as probe.cl takes it: high, low, direction; the sphere as centre and radius. */
static inline Exact exact_roots(const double *ray, const double *sphere) {
    Wide oc[3], d[3], across[3];
    for (int a = 0; a < 3; ++a) {
        oc[a] = (Wide)sphere[a] - (Wide)ray[a] - (Wide)ray[3 + a];
        d[a] = (Wide)ray[6 + a];
    }
    const Wide r = (Wide)sphere[3], dd = wide_dot(d, d), p = wide_dot(oc, d) / dd;
    for (int a = 0; a < 3; ++a) across[a] = oc[a] - p * d[a];
    const Wide l2 = wide_dot(across, across), discriminant = r * r - l2;
    Exact exact = {.meets = discriminant >= 0, .middle = p};
    exact.impact = sqrt((double)(l2 / (r * r)));
    exact.power = (double)((wide_dot(oc, oc) - r * r) / (r * r));
    exact.half_chord = wide_sqrt(discriminant > 0 ? discriminant / dd : 0);
    exact.near = p - exact.half_chord;
    exact.far = p + exact.half_chord;
    return exact;
}

/* How far the point of the ray at distance t lies off the sphere, in radii. */
static inline double exact_off_sphere(const double *ray, const double *sphere, double t) {
    Wide p[3];
    for (int a = 0; a < 3; ++a)
        p[a] = (Wide)ray[a] + (Wide)ray[3 + a] + (Wide)t * (Wide)ray[6 + a] - (Wide)sphere[a];
    const Wide r = (Wide)sphere[3];
    return (double)(wide_sqrt(wide_dot(p, p)) / r - 1);
}

#endif
