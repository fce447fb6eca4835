/* rows.c: see rows.h. */
#include "rows.h"

#include "base/status.h"

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

bool bp_rows_are_numbers(const BpRows *rows) {
    return rows->data != NULL && (rows->type == BP_NUMBER_FLOAT || rows->type == BP_NUMBER_DOUBLE);
}

BpStatus bp_rows_color(const BpRows *rows, size_t row, const char *noun, const char *set, float color[3],
                       BpError *err) {
    for (ptrdiff_t c = 0; c < 3; c++) {
        const double share = bp_rows_number(rows, row, c);
        if (!(share >= 0 && share <= 1))
            return bp_fail(err, BP_ERR_SCENE,
                           "%s %zu (from 0) of %s: color: found %g, expected shares of light from 0 to 1",
                           noun, row, set, share);
        color[c] = (float)share;
    }
    return BP_OK;
}
