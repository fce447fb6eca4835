/* decimal.h: fast, correctly rounded parsing of decimal numbers.
 *
 * In:    text.   Out: doubles, whole numbers.
 * Knows: decimal notation.   Does not know: what stands around a number. */
#ifndef BP_BASE_DECIMAL_H
#define BP_BASE_DECIMAL_H

#include <stdbool.h>
#include <stdint.h>

/* Parses the number at the start of `text` to the nearest double. Returns the end of the number, or NULL if
 * there is none. "nan" and "inf" are numbers. In a locale whose decimal sign is not a point, the caller sets
 * the C locale (uselocale) before. */
const char *bp_decimal_parse(const char *text, double *value);

/* The same for numbers in tables, where the exponent may also begin with D or Q (Fortran's double and
 * quadruple precision) or *^ (Mathematica), and Fortran omits the letter before a three-digit exponent:
 * 1.5D+02, -4.7*^-1, 0.25-103. */
const char *bp_table_number_parse(const char *text, double *value);

/* The same for an integer in the range of int64_t; a sign is accepted. */
const char *bp_whole_parse(const char *text, int64_t *value);

#endif
