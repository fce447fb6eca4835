/* covering.h: which combinations of choices a test tries, when it cannot try all.
 *
 * In:    the number of choices between two things, which combinations can occur, and cases that are tried
 * anyway, or none.   Out: these, and as few more as a greedy search finds, such that any three choices that
 * can occur together do so in some case: a covering array of strength three. It is the same on every machine.
 * Knows: nothing.   Does not know: what the choices are. */
#ifndef TESTS_SUPPORT_COVERING_H
#define TESTS_SUPPORT_COVERING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum {
    COVERING_CHOICES_MAX = 24,
    COVERING_TRIPLES = COVERING_CHOICES_MAX * COVERING_CHOICES_MAX * COVERING_CHOICES_MAX * 8
};

/* A case is a word: bit i is choice i. */
typedef bool CoveringAllows(uint32_t word);

/* How many triples of `word` are not in `covered` yet; they are added if `add`. */
static inline unsigned covering_take(bool covered[COVERING_TRIPLES], int choices, uint32_t word, bool add) {
    unsigned fresh = 0;
    for (int i = 0; i < choices; ++i)
        for (int j = i + 1; j < choices; ++j)
            for (int k = j + 1; k < choices; ++k) {
                const uint32_t values = (word >> i & 1u) | (word >> j & 1u) << 1 | (word >> k & 1u) << 2;
                const int triple = (i * COVERING_CHOICES_MAX + j) * COVERING_CHOICES_MAX + k;
                bool *one = &covered[(size_t)triple * 8 + values];
                fresh += !*one;
                *one = *one || add;
            }
    return fresh;
}

/* Appends to the `count` cases there are, of at most 2^choices; returns how many there are then. */
static inline size_t covering(int choices, CoveringAllows *allows, uint32_t *cases, size_t count) {
    static bool covered[COVERING_TRIPLES];
    const uint32_t words = 1u << choices;
    memset(covered, 0, sizeof covered);
    for (size_t i = 0; i < count; ++i) covering_take(covered, choices, cases[i], true);
    while (count < words) {
        uint32_t best = 0;
        unsigned most = 0;
        for (uint32_t word = 0; word < words; ++word) {
            const unsigned fresh = allows(word) ? covering_take(covered, choices, word, false) : 0;
            if (fresh > most) most = fresh, best = word;
        }
        if (most == 0) break;
        covering_take(covered, choices, best, true);
        cases[count++] = best;
    }
    return count;
}

#endif
