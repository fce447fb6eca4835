/* vec.h: vectors of the reference tracer, and its random numbers.
 *
 * Knows: arithmetic.   Does not know: scenes, packed data. It shares nothing with the kernels' vectors and
 * random numbers. */
#ifndef BP_REFERENCE_VEC_H
#define BP_REFERENCE_VEC_H

#include <math.h>
#include <stdint.h>

typedef struct Vec {
    double x, y, z;
} Vec;

static inline Vec vec(const double v[3]) {
    return (Vec){v[0], v[1], v[2]};
}
static inline Vec add(Vec a, Vec b) {
    return (Vec){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline Vec sub(Vec a, Vec b) {
    return (Vec){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline Vec mul(Vec a, Vec b) {
    return (Vec){a.x * b.x, a.y * b.y, a.z * b.z};
}
static inline Vec scale(double s, Vec a) {
    return (Vec){s * a.x, s * a.y, s * a.z};
}
static inline double dot(Vec a, Vec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline double length2(Vec a) {
    return dot(a, a);
}
static inline Vec unit(Vec a) {
    return scale(1 / sqrt(length2(a)), a);
}
static inline Vec cross(Vec a, Vec b) {
    return (Vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* xoshiro256** (Blackman and Vigna, "Scrambled linear pseudorandom number generators", 2021), its state
 * filled by SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014). Every
 * sample of every pixel has a stream of its own, so neither threads nor the order of rows matter. */
typedef struct Random {
    uint64_t s[4];
} Random;

static inline uint64_t splitmix64(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static inline Random random_stream(uint64_t seed, uint64_t pixel, uint64_t sample) {
    uint64_t state = seed;
    state = splitmix64(&state) ^ pixel;
    state = splitmix64(&state) ^ sample;
    Random random;
    for (int i = 0; i < 4; ++i) random.s[i] = splitmix64(&state);
    return random;
}

/* Uniform in [0, 1): 53 bits. */
static inline double random_real(Random *random) {
    uint64_t *s = random->s;
    const uint64_t five = s[1] * 5, result = (five << 7 | five >> 57) * 9, shifted = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= shifted;
    s[3] = s[3] << 45 | s[3] >> 19;
    return (double)(result >> 11) * 0x1p-53;
}

static inline double random_between(Random *random, double low, double high) {
    return low + (high - low) * random_real(random);
}

/* Uniform in the unit ball, by rejection as in the book. */
static inline Vec random_in_ball(Random *random) {
    for (;;) {
        const double x = random_between(random, -1, 1), y = random_between(random, -1, 1);
        const Vec p = {x, y, random_between(random, -1, 1)};
        if (length2(p) < 1) return p;
    }
}

/* Uniform on the unit sphere. The lower bound keeps the division exact (fourth edition: 1e-160). */
static inline Vec random_on_sphere(Random *random) {
    for (;;) {
        const Vec p = random_in_ball(random);
        if (length2(p) > 1e-160) return unit(p);
    }
}

/* Uniform in the unit disk of the plane z = 0. */
static inline Vec random_in_disk(Random *random) {
    for (;;) {
        const double x = random_between(random, -1, 1), y = random_between(random, -1, 1);
        if (x * x + y * y < 1) return (Vec){x, y, 0};
    }
}

#endif
