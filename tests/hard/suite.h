/* suite.h: the forty tests of numerical stability, by group. Each group runs its tests on one variant of the
 * program and returns the number that failed. Tests print the figures they judged. */
#ifndef TESTS_HARD_SUITE_H
#define TESTS_HARD_SUITE_H

#include "cases.h"
#include "lab.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

int run_sphere(Lab *lab);
int run_departure(Lab *lab);
int run_shells(Lab *lab);
int run_dielectric(Lab *lab);
int run_sampling(Lab *lab);
int run_sums(Lab *lab);
int run_boxes(Lab *lab);

/* The lab of a test is its state from the start. */
#define HARD_TEST(function) cmocka_unit_test_prestate(function, lab)

/* Zeroed memory; freed with free(). (cmocka's own ends the process when a test fails before freeing it.) */
static inline void *suite_calloc(size_t count, size_t size) {
    void *memory = calloc(count, size);
    if (memory == NULL) abort();
    return memory;
}

/* A scene from a document's text; the caller destroys it. Ends the test if it is refused. */
BpScene *suite_scene(const char *format, ...) BP_PRINTF_LIKE(1, 2);

#endif
