/* accumulator_data.h: synthetic samples for the tests of accumulators; fixed seeds. */
#ifndef BP_TEST_ACCUMULATOR_DATA_H
#define BP_TEST_ACCUMULATOR_DATA_H

#include "engine/accumulator.h"

#include <math.h>

/* SplitMix64 (Steele, Lea and Flood 2014), as a function of its counter. */
static inline uint64_t data_bits(uint64_t counter) {
    uint64_t z = (counter + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* In (0, 1). */
static inline double data_uniform(uint64_t counter) {
    return ((double)(data_bits(counter) >> 11) + 0.5) * 0x1p-53;
}

/* A standard normal number (Box and Muller 1958). */
static inline double data_normal(uint64_t counter) {
    return sqrt(-2 * log(data_uniform(2 * counter))) * cos(6.283185307179586 * data_uniform(2 * counter + 1));
}

/* Adds one sample of one pixel, as the fold kernel would. */
static inline void data_add(BpAccumulator *accumulator, size_t pixel, uint64_t sample, const double rgb[3]) {
    const size_t cell = pixel * accumulator->replicates + sample % accumulator->replicates;
    for (size_t c = 0; c < 3; c++)
        accumulator->sums[3 * cell + c] += llrint(ldexp(rgb[c], accumulator->scale_log2));
    accumulator->counts[cell]++;
}

#endif
