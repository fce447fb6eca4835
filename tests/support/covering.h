/* covering.h: which combinations of choices a test tries, when it cannot try all.
 *
 * In:    the number of choices between two things, rules on which combinations cannot occur, and cases that
 * are tried anyway, or none.   Out: these, and a few more, such that any three choices that can occur
 * together do so in some case: a covering array of strength three. It is the same on every machine. Knows:
 * nothing.   Does not know: what the choices are. */
#ifndef TESTS_SUPPORT_COVERING_H
#define TESTS_SUPPORT_COVERING_H

#include <assert.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum {
    COVERING_CHOICES_MAX = 32,
    COVERING_CASES_MAX = 4096,
    COVERING_TRIES = 40, /* at each case, of which the one is taken that covers most */
    COVERING_TRIPLES = COVERING_CHOICES_MAX * COVERING_CHOICES_MAX * COVERING_CHOICES_MAX * 8
};

/* A case is a word: bit i is choice i. None can occur that has all of `on` and nothing of `off`. */
typedef struct CoveringRule {
    uint32_t on, off;
} CoveringRule;

typedef struct CoveringRules {
    const CoveringRule *rules;
    size_t count;
} CoveringRules;

/* The choices that are made, and how. */
typedef struct CoveringPart {
    uint32_t made, word;
} CoveringPart;

typedef struct Covering {
    int choices;
    CoveringRules rules;
    bool covered[COVERING_TRIPLES]; /* or cannot occur */
    uint32_t state;                 /* of the random numbers that order choices */
} Covering;

static inline bool covering_allows(CoveringRules rules, uint32_t word) {
    for (size_t r = 0; r < rules.count; ++r)
        if ((word & rules.rules[r].on) == rules.rules[r].on && (word & rules.rules[r].off) == 0) return false;
    return true;
}

static inline CoveringPart covering_with(CoveringPart part, int choice, uint32_t value) {
    const uint32_t bit = 1u << choice;
    return (CoveringPart){part.made | bit, value != 0 ? part.word | bit : part.word & ~bit};
}

/* The other choices can be made so that the rules hold: one rule that is not kept yet after the other, in
 * each of the ways to keep it. */
static inline bool covering_extends(CoveringRules rules, CoveringPart part) {
    for (size_t r = 0; r < rules.count; ++r) {
        const CoveringRule *rule = &rules.rules[r];
        const bool kept =
            (part.made & ~part.word & rule->on) != 0 || (part.made & part.word & rule->off) != 0;
        if (kept) continue;
        for (int i = 0; i < COVERING_CHOICES_MAX; ++i) {
            const bool on = (rule->on >> i & 1u) != 0, off = (rule->off >> i & 1u) != 0;
            if ((!on && !off) || (part.made >> i & 1u) != 0) continue;
            if (covering_extends(rules, covering_with(part, i, off))) return true;
        }
        return false;
    }
    return true;
}

static inline bool *covering_triple(Covering *c, int i, int j, int k, uint32_t word) {
    const uint32_t values = (word >> i & 1u) | (word >> j & 1u) << 1 | (word >> k & 1u) << 2;
    const int triple = (i * COVERING_CHOICES_MAX + j) * COVERING_CHOICES_MAX + k;
    return &c->covered[(size_t)triple * 8 + values];
}

/* How many triples of `word` are not covered yet; covers them if `take`. */
static inline unsigned covering_fresh(Covering *c, uint32_t word, bool take) {
    unsigned fresh = 0;
    for (int i = 0; i < c->choices; ++i)
        for (int j = i + 1; j < c->choices; ++j)
            for (int k = j + 1; k < c->choices; ++k) {
                bool *one = covering_triple(c, i, j, k, word);
                fresh += !*one;
                *one |= take;
            }
    return fresh;
}

/* How many triples that are not covered a choice makes with the choices that are made. */
static inline unsigned covering_gain(Covering *c, CoveringPart part, int choice, uint32_t value) {
    const CoveringPart with = covering_with(part, choice, value);
    unsigned gain = 0;
    for (int a = 0; a < c->choices; ++a)
        for (int b = a + 1; b < c->choices; ++b) {
            if (a == choice || b == choice || (part.made >> a & part.made >> b & 1u) == 0) continue;
            const int i = choice < a ? choice : a, k = choice > b ? choice : b;
            gain += !*covering_triple(c, i, choice < a ? a : choice > b ? b : choice, k, with.word);
        }
    return gain;
}

static inline uint32_t covering_random(Covering *c) {
    c->state = c->state * 1664525u + 1013904223u;
    return c->state >> 8;
}

/* Makes all other choices, in a random order, each as more new triples come together. */
static inline uint32_t covering_complete(Covering *c, CoveringPart part) {
    int order[COVERING_CHOICES_MAX];
    for (int i = 0; i < c->choices; ++i) {
        const int place = (int)(covering_random(c) % (uint32_t)(i + 1));
        order[i] = order[place];
        order[place] = i;
    }
    for (int n = 0; n < c->choices; ++n) {
        const int choice = order[n];
        if ((part.made >> choice & 1u) != 0) continue;
        const unsigned gains[2] = {covering_gain(c, part, choice, 0), covering_gain(c, part, choice, 1)};
        const uint32_t better = gains[0] != gains[1] ? gains[1] > gains[0] : covering_random(c) & 1u;
        const bool possible = covering_extends(c->rules, covering_with(part, choice, better));
        part = covering_with(part, choice, possible ? better : !better);
    }
    return part.word;
}

/* The first triple that is not covered; those that cannot occur count as covered from then on. */
static inline bool covering_next(Covering *c, CoveringPart *part) {
    for (int i = 0; i < c->choices; ++i)
        for (int j = i + 1; j < c->choices; ++j)
            for (int k = j + 1; k < c->choices; ++k)
                for (uint32_t values = 0; values < 8; ++values) {
                    *part = (CoveringPart){0};
                    *part = covering_with(*part, i, values & 1u);
                    *part = covering_with(*part, j, values >> 1 & 1u);
                    *part = covering_with(*part, k, values >> 2 & 1u);
                    bool *one = covering_triple(c, i, j, k, part->word);
                    if (*one) continue;
                    if (covering_extends(c->rules, *part)) return true;
                    *one = true;
                }
    return false;
}

/* Appends to the `count` cases there are, which the rules allow; returns how many there are then, at most
 * COVERING_CASES_MAX. */
static inline size_t covering(int choices, CoveringRules rules, uint32_t *cases, size_t count) {
    static Covering c;
    CoveringPart part;
    assert(choices >= 3 && choices < COVERING_CHOICES_MAX);
    memset(&c, 0, sizeof c);
    c.choices = choices;
    c.rules = rules;
    for (size_t i = 0; i < count; ++i) (void)covering_fresh(&c, cases[i], true);
    while (count < COVERING_CASES_MAX && covering_next(&c, &part)) {
        uint32_t best = covering_complete(&c, part);
        unsigned most = covering_fresh(&c, best, false);
        for (int n = 1; n < COVERING_TRIES; ++n) {
            const uint32_t word = covering_complete(&c, part);
            const unsigned fresh = covering_fresh(&c, word, false);
            if (fresh > most) best = word;
            if (fresh > most) most = fresh;
        }
        (void)covering_fresh(&c, best, true);
        cases[count++] = best;
    }
    return count;
}

#endif
