/* film_data.h: synthetic samples for the tests of films; fixed seeds. */
#ifndef BP_TEST_ACCUMULATOR_DATA_H
#define BP_TEST_ACCUMULATOR_DATA_H

#include "base/random.h"
#include "film/film.h"

#include <math.h>

/* The generator's number after `counter` others. */
static inline uint64_t data_bits(uint64_t counter) {
    BpRandom random = {counter * BP_RANDOM_STEP};
    return bp_random_bits(&random);
}

/* In (0, 1). */
static inline double data_uniform(uint64_t counter) {
    return ((double)(data_bits(counter) >> 11) + 0.5) * 0x1p-53;
}

/* A standard normal number (Box and Muller 1958). */
static inline double data_normal(uint64_t counter) {
    return sqrt(-2 * log(data_uniform(2 * counter))) * cos(6.283185307179586 * data_uniform(2 * counter + 1));
}

/* Adds one sample of one pixel, as the kernel `accumulate` would. */
static inline void data_add(BpFilm *film, size_t pixel, uint64_t sample, const double rgb[3]) {
    const size_t cell = pixel * film->replicates + sample % film->replicates;
    for (size_t c = 0; c < 3; c++) film->sums[3 * cell + c] += llrint(ldexp(rgb[c], film->scale_log2));
    film->counts[cell]++;
}

#endif
