/* random.h: portable random numbers of the host, for generated scenes and for tests.
 *
 * SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", 2014): a
 * counter with a step of the golden ratio, mixed. Kernels have random numbers of their own, and so has the
 * reference tracer, which shares nothing. */
#ifndef BP_BASE_RANDOM_H
#define BP_BASE_RANDOM_H

#include <stdint.h>

#define BP_RANDOM_STEP UINT64_C(0x9e3779b97f4a7c15)

typedef struct BpRandom {
    uint64_t state; /* begins as the seed */
} BpRandom;

static inline uint64_t bp_random_bits(BpRandom *random) {
    uint64_t z = random->state += BP_RANDOM_STEP;
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

/* The upper 53 bits, as a number in [0, 1). */
static inline double bp_random_next(BpRandom *random) {
    return (double)(bp_random_bits(random) >> 11) * 0x1p-53;
}

#endif
