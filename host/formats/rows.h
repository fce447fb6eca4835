/* rows.h: the numbers and colours of a caller's array.
 *
 * In:    address, strides and type.   Out: a double, or the shares of light of a row.
 * Knows: how arrays lie in memory.   Does not know: what has the numbers. */
#ifndef BP_FORMATS_ROWS_H
#define BP_FORMATS_ROWS_H

#include "ballpark.h"

double bp_rows_number(const BpRows *rows, size_t row, ptrdiff_t column);

/* Whether there is an array, of a known type. */
bool bp_rows_are_numbers(const BpRows *rows);

/* Three shares of light. BP_ERR_SCENE names the row as "`noun` 3 (from 0) of `set`". */
BpStatus bp_rows_color(const BpRows *rows, size_t row, const char *noun, const char *set, float color[3],
                       BpError *err);

#endif
