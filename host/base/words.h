/* words.h: tables indexed by an enumeration, whose completeness the compiler checks.
 *
 * In:    a list X(value, what) of all values of an enumeration.   Out: an array by value.
 * Knows: that compilers warn of a switch that lacks a value (-Wswitch, a part of -Wall).
 * Does not know: which enumerations there are. */
#ifndef BP_BASE_WORDS_H
#define BP_BASE_WORDS_H

#define BP_WORD_AT(value, what) [value] = what,
#define BP_WORD_CASE(value, what) case value:

/* For `what` that is a struct. */
#define BP_BRACED(...)                                                                                       \
    { __VA_ARGS__ }

/* Clang warns about uncalled functions in a .c file, even if they are inline. */
#if defined(__GNUC__)
#define BP_NOBODY_CALLS __attribute__((unused))
#else
#define BP_NOBODY_CALLS
#endif

/* `declaration[] = { ... }`, for the outermost level of a file, and an uncalled function whose switch makes
 * the compiler warn of values that LIST lacks. */
#define BP_WORDS(type, declaration, LIST)                                                                    \
    BP_WORDS_COMPLETE(type, LIST)                                                                            \
    declaration[] = {LIST(BP_WORD_AT)}
/* The same, with NULL at the end. */
#define BP_WORDS_ENDED(type, declaration, LIST)                                                              \
    BP_WORDS_COMPLETE(type, LIST)                                                                            \
    declaration[] = {LIST(BP_WORD_AT) NULL}
#define BP_WORDS_COMPLETE(type, LIST)                                                                        \
    BP_NOBODY_CALLS static inline void LIST##_are_complete(type value) {                                     \
        switch (value) { LIST(BP_WORD_CASE) break; }                                                         \
    }

#endif
