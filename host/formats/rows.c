/* rows.c: see rows.h. */
#include "rows.h"

#include <string.h>

double bp_rows_number(const BpRows *rows, size_t row, ptrdiff_t column) {
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
