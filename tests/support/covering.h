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
#include <stdlib.h>
#include <string.h>

enum {
    COVERING_CHOICES_MAX = 27,
    COVERING_TRIPLES = COVERING_CHOICES_MAX * COVERING_CHOICES_MAX * COVERING_CHOICES_MAX * 8
};

/* A case is a word: bit i is choice i. */
typedef bool CoveringAllows(uint32_t word);

/* The choices i < j < k, and what the bits of `values` choose. */
typedef struct CoveringTriple {
    int i, j, k;
    uint32_t values;
} CoveringTriple;

/* `fresh[word]`: how many of a word's triples are not covered yet; 0 for a word that cannot occur. */
typedef struct Covering {
    int choices;
    bool covered[COVERING_TRIPLES];
    uint16_t *fresh;
} Covering;

/* One less for each word that has the triple. Words that have it are runs of 2^i neighbours. */
static inline void covering_count_off(Covering *c, const CoveringTriple *triple) {
    const uint32_t i = 1u << triple->i, j = 1u << triple->j, k = 1u << triple->k, words = 1u << c->choices;
    const uint32_t wanted =
        (triple->values & 1u) * i + (triple->values >> 1 & 1u) * j + (triple->values >> 2 & 1u) * k;
    for (uint32_t upper = wanted & k; upper < words; upper += 2 * k)
        for (uint32_t middle = wanted & j; middle < k; middle += 2 * j)
            for (uint32_t lower = wanted & i; lower < j; lower += 2 * i) {
                uint16_t *run = c->fresh + upper + middle + lower;
                for (uint32_t n = 0; n < i; ++n) run[n] = (uint16_t)(run[n] - (run[n] != 0));
            }
}

/* Covers the triples of `word`. */
static inline void covering_take(Covering *c, uint32_t word) {
    for (int i = 0; i < c->choices; ++i)
        for (int j = i + 1; j < c->choices; ++j)
            for (int k = j + 1; k < c->choices; ++k) {
                const uint32_t values = (word >> i & 1u) | (word >> j & 1u) << 1 | (word >> k & 1u) << 2;
                const int triple = (i * COVERING_CHOICES_MAX + j) * COVERING_CHOICES_MAX + k;
                bool *one = &c->covered[(size_t)triple * 8 + values];
                if (!*one) covering_count_off(c, &(CoveringTriple){i, j, k, values});
                *one = true;
            }
}

/* Appends to the `count` cases there are, of at most 2^choices; returns how many there are then. The time
 * grows with 2^choices, once for each triple: a second for twenty choices. */
static inline size_t covering(int choices, CoveringAllows *allows, uint32_t *cases, size_t count) {
    static Covering c;
    const uint32_t words = 1u << choices;
    memset(&c, 0, sizeof c);
    c.choices = choices;
    c.fresh = calloc(words, sizeof *c.fresh);
    if (c.fresh == NULL) abort();
    for (uint32_t word = 0; word < words; ++word)
        if (allows(word)) c.fresh[word] = (uint16_t)(choices * (choices - 1) * (choices - 2) / 6);
    for (size_t i = 0; i < count; ++i) covering_take(&c, cases[i]);
    while (count < words) {
        uint32_t best = 0;
        for (uint32_t word = 1; word < words; ++word)
            if (c.fresh[word] > c.fresh[best]) best = word;
        if (c.fresh[best] == 0) break;
        covering_take(&c, best);
        cases[count++] = best;
    }
    free(c.fresh);
    return count;
}

#endif
