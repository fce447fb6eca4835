/* embree_lanes.h: what the loops over lanes share: local pointers, random numbers, sine and cube root.
 *
 * Knows: how compilers are brought to make vector code of plain loops.   Does not know: scenes. */
#ifndef BENCH_EMBREE_LANES_H
#define BENCH_EMBREE_LANES_H

#include <math.h>
#include <stdint.h>

/* The arrays of a batch as local pointers that nothing else points at: without them compilers give up on
 * vectors. */
#define FLOATS(name, array) float *restrict const name = __builtin_assume_aligned(array, 64)
#define WORDS(name, array) uint32_t *restrict const name = __builtin_assume_aligned(array, 64)
#define FLOATS3(x, y, z, arrays)                                                                             \
    FLOATS(x, (arrays)[0]);                                                                                  \
    FLOATS(y, (arrays)[1]);                                                                                  \
    FLOATS(z, (arrays)[2])
#define EACH_LANE _Pragma("GCC ivdep") for (uint32_t i = 0; i < count; i++)

/* pcg3d (Jarzynski and Olano 2020): three words of three. */
static inline void hash3(uint32_t *x, uint32_t *y, uint32_t *z) {
    uint32_t a = *x * 1664525u + 1013904223u, b = *y * 1664525u + 1013904223u,
             c = *z * 1664525u + 1013904223u;
    a += b * c;
    b += c * a;
    c += a * b;
    a ^= a >> 16;
    b ^= b >> 16;
    c ^= c >> 16;
    a += b * c;
    b += c * a;
    c += a * b;
    *x = a;
    *y = b;
    *z = c;
}

static inline float to_uniform(uint32_t word) {
    return (float)(int32_t)(word >> 8) * 0x1p-24f;
}

/* sin and cos of 2 pi u, u in [0, 1): a quarter turn at a time, Taylor polynomials on +-pi/4. */
static inline void circle(float u, float *sine, float *cosine) {
    const float quarter = (float)(int32_t)(4 * u + 0.5f); /* 0 .. 4 */
    const float x = (u - 0.25f * quarter) * 6.28318530718f, q = x * x;
    const float s = x * (1 + q * (-1.6666667e-1f + q * (8.3333310e-3f + q * -1.9840874e-4f)));
    const float c = 1 + q * (-0.5f + q * (4.1666638e-2f + q * (-1.3888378e-3f + q * 2.4760495e-5f)));
    const int32_t turn = (int32_t)quarter;
    const float a = turn & 1 ? c : s, b = turn & 1 ? s : c;
    *sine = turn & 2 ? -a : a;
    *cosine = (turn + 1) & 2 ? -b : b;
}

/* Cube root of u in [0, 1): a guess from the bits, three Newton steps. */
static inline float cube_root(float u) {
    union {
        float f;
        uint32_t i;
    } bits = {u};
    bits.i = bits.i / 3 + 0x2a517d47u;
    float x = bits.f;
    for (int step = 0; step < 3; step++) x = (2 * x + u / (x * x)) * (1 / 3.0f);
    return x;
}

#endif
