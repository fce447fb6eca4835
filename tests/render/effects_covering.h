/* effects_covering.h: which sets of effects a test tries, with a tree or a list, in which form of the kernel.
 *
 * In:    cases that are tried anyway, or none.   Out: these, and a few more, such that any three of these
 * choices that can occur together do so in some case.
 * Knows: which sets can occur.   Does not know: scenes, kernels. */
#ifndef TESTS_RENDER_EFFECTS_COVERING_H
#define TESTS_RENDER_EFFECTS_COVERING_H

#include "effects_scenes.h"
#include "support/covering.h"

/* A case is a word: its effects, and above them two bits. */
#define EFFECTS_CASE_TREE EFFECTS_TREE
#define EFFECTS_CASE_PACKET (2u << BP_EFFECT_COUNT)
enum { EFFECTS_CHOICES = BP_EFFECT_COUNT + 2 };

static inline uint32_t effects_case_bits(uint32_t word) {
    return word & BP_EFFECTS_ALL;
}

static inline bool effects_case_can_occur(uint32_t word) {
    return covering_allows(effects_all_rules, word);
}

/* Appends to the `count` cases there are; returns how many there are then. */
static inline size_t effects_covering(uint32_t cases[COVERING_CASES_MAX], size_t count) {
    return covering(EFFECTS_CHOICES, effects_all_rules, cases, count);
}

#endif
