/* rows.h: one number of a caller's array.
 *
 * In:    address, strides and type.   Out: a double.
 * Knows: how arrays lie in memory.   Does not know: what the numbers mean. */
#ifndef BP_FORMATS_ROWS_H
#define BP_FORMATS_ROWS_H

#include "ballpark.h"

double bp_rows_number(const BpRows *rows, size_t row, ptrdiff_t column);

#endif
