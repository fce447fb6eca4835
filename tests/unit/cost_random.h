/* cost_random.h: random numbers of the tests' own; a test sets `stream` first. */
#ifndef COST_RANDOM_H
#define COST_RANDOM_H

#include <math.h>
#include <stdint.h>

static uint64_t stream;

static double uniform(void) {
    stream = stream * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return ((double)(stream >> 11) + 0.5) * 0x1p-53;
}

static double normal(void) {
    return sqrt(-2 * log(uniform())) * cos(6.283185307179586 * uniform());
}

#endif
