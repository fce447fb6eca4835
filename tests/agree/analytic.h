/* analytic.h: scenes whose radiance is known in closed form, required of every tracer.
 *
 * In:    a case and its number.   Out: a scene, and the mean radiance that a right tracer finds.
 * Knows: BpScene, optics.         Does not know: which tracer is being judged. */
#ifndef TESTS_AGREE_ANALYTIC_H
#define TESTS_AGREE_ANALYTIC_H

#include "support/build_scene.h"

typedef struct AnalyticCase {
    char name[64];
    BuiltScene built;   /* the picture's every pixel has the same expectation */
    double expected[3]; /* mean radiance */
} AnalyticCase;

/* Fills in case `index`; false when there is none. */
bool analytic_case(size_t index, AnalyticCase *analytic);

#endif
