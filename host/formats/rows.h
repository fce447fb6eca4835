/* rows.h: one number of a caller's array.
 *
 * In:    address, strides and type.   Out: a double.
 * Knows: how arrays lie in memory.   Does not know: what the numbers mean. */
#ifndef BP_FORMATS_ROWS_H
#define BP_FORMATS_ROWS_H

#include "ballpark.h"

#include <string.h>

static inline double bp_rows_number(const BpRows *rows, size_t row, ptrdiff_t column) {
    const char *const place =
        (const char *)rows->data + (ptrdiff_t)row * rows->row_stride + column * rows->column_stride;
    if (rows->type == BP_NUMBER_DOUBLE) {
        double value;
        memcpy(&value, place, sizeof value);
        return value;
    }
    float value;
    memcpy(&value, place, sizeof value);
    return (double)value;
}

#endif
