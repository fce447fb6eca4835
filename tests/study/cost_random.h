/* cost_random.h: random numbers of the tests' own; a test sets `stream` first. */
#ifndef COST_RANDOM_H
#define COST_RANDOM_H

#include "base/random.h"

#include <math.h>

static BpRandom stream;

/* In (0, 1), as logarithms need it. */
static double uniform(void) {
    return bp_random_next(&stream) + 0x1p-54;
}

static double normal(void) {
    return sqrt(-2 * log(uniform())) * cos(6.283185307179586 * uniform());
}

#endif
