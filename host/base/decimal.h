/* decimal.h: numbers of text files, read fast and rounded right.
 *
 * In:    text.   Out: doubles, whole numbers.
 * Knows: decimal notation.   Does not know: what stands around a number. */
#ifndef BP_BASE_DECIMAL_H
#define BP_BASE_DECIMAL_H

#include <stdbool.h>
#include <stdint.h>

/* Reads the number that begins at `text`: *value is the nearest double. Returns what follows it, or NULL when
 * none begins there. "nan" and "inf" are numbers. In a locale whose decimal sign is not a point, the caller
 * sets the C locale (uselocale) before. */
const char *bp_decimal_parse(const char *text, double *value);

/* The same for what programs write into tables, where an exponent may also begin with D or Q (Fortran's
 * double and quadruple precision) or with *^ (Mathematica), and where Fortran leaves its letter away before
 * three digits: 1.5D+02, -4.7*^-1, 0.25-103. */
const char *bp_table_number_parse(const char *text, double *value);

/* The same for a whole number that fits; a sign is accepted. */
const char *bp_whole_parse(const char *text, int64_t *value);

#endif
