/* effects_covering.h: which sets of effects a test tries, when it cannot try all.
 *
 * In:    cases that are tried anyway, or none.   Out: these, and as few more as a greedy search finds, such
 * that any three choices that can occur together (an effect present or absent, tree or list, form of the
 * kernel) do so in some case: a covering array of strength three. It is the same on every machine. Knows:
 * which sets can occur.   Does not know: scenes, kernels. */
#ifndef TESTS_RENDER_EFFECTS_COVERING_H
#define TESTS_RENDER_EFFECTS_COVERING_H

#include "effects_scenes.h"

/* A case is a word: its effects, and above them two bits. */
#define EFFECTS_CASE_TREE (1u << BP_EFFECT_COUNT)
#define EFFECTS_CASE_PACKET (2u << BP_EFFECT_COUNT)
enum { EFFECTS_CHOICES = BP_EFFECT_COUNT + 2, EFFECTS_CASES = 1 << EFFECTS_CHOICES };

static inline uint32_t effects_case_bits(uint32_t word) {
    return word & BP_EFFECTS_ALL;
}

static inline bool effects_case_can_occur(uint32_t word) {
    return effects_can_occur(effects_case_bits(word), (word & EFFECTS_CASE_TREE) != 0);
}

/* The number of choices i, j and k as `word` makes them, below EFFECTS_TRIPLES. */
enum { EFFECTS_TRIPLES = EFFECTS_CHOICES * EFFECTS_CHOICES * EFFECTS_CHOICES * 8 };
static inline size_t effects_triple(uint32_t word, int i, int j, int k) {
    const uint32_t values = (word >> i & 1u) | (word >> j & 1u) << 1 | (word >> k & 1u) << 2;
    return (size_t)((i * EFFECTS_CHOICES + j) * EFFECTS_CHOICES + k) * 8 + values;
}

/* How many triples of `word` are not in `covered` yet; they are added if `add`. */
static inline unsigned effects_cover(bool covered[EFFECTS_TRIPLES], uint32_t word, bool add) {
    unsigned fresh = 0;
    for (int i = 0; i < EFFECTS_CHOICES; ++i)
        for (int j = i + 1; j < EFFECTS_CHOICES; ++j)
            for (int k = j + 1; k < EFFECTS_CHOICES; ++k) {
                bool *one = &covered[effects_triple(word, i, j, k)];
                fresh += !*one;
                *one = *one || add;
            }
    return fresh;
}

/* Appends to the `count` cases there are; returns how many there are then. */
static inline size_t effects_covering(uint32_t cases[EFFECTS_CASES], size_t count) {
    static bool covered[EFFECTS_TRIPLES];
    memset(covered, 0, sizeof covered);
    for (size_t i = 0; i < count; ++i) effects_cover(covered, cases[i], true);
    while (count < EFFECTS_CASES) {
        uint32_t best = 0;
        unsigned most = 0;
        for (uint32_t word = 0; word < EFFECTS_CASES; ++word) {
            const unsigned fresh = effects_case_can_occur(word) ? effects_cover(covered, word, false) : 0;
            if (fresh > most) most = fresh, best = word;
        }
        if (most == 0) break;
        effects_cover(covered, best, true);
        cases[count++] = best;
    }
    return count;
}

#endif
