/* table.c: see table.h. */
#include "table.h"

#include "base/wrap.h"

#include <stdlib.h>

enum { GAP = 2 };

bool bp_table_make(BpTable *table, size_t columns, size_t rows, const bool *right) {
    *table = (BpTable){columns, rows, right, calloc(columns * rows, BP_CELL_SIZE)};
    return table->cells != NULL;
}

char *bp_table_cell(const BpTable *table, size_t row, size_t column) {
    return table->cells[row * table->columns + column];
}

static size_t characters(const char *text) {
    size_t count = 0;
    for (; *text != '\0'; ++text)
        if (((unsigned char)*text & 0xc0u) != 0x80u) ++count;
    return count;
}

static size_t column_width(const BpTable *table, size_t column) {
    size_t width = 0;
    for (size_t r = 0; r < table->rows; ++r) {
        const size_t own = characters(bp_table_cell(table, r, column));
        if (own > width) width = own;
    }
    return width;
}

static void print_cell(const BpTable *table, size_t row, size_t column, bool last, FILE *out) {
    const char *text = bp_table_cell(table, row, column);
    const int blanks = (int)(column_width(table, column) - characters(text));
    /* A last cell that is wider than the page is continued below. */
    fprintf(out, "%*s%s%s", table->right[column] ? blanks : 0, "", last ? BP_HANG : "", text);
    if (!last) fprintf(out, "%*s", (table->right[column] ? 0 : blanks) + GAP, "");
}

void bp_table_print(const BpTable *table, size_t width, FILE *out) {
    const size_t first = column_width(table, 0);
    for (size_t from = 1, to; from < table->columns; from = to) {
        size_t used = first + GAP + column_width(table, from);
        for (to = from + 1; to < table->columns; ++to) {
            used += GAP + column_width(table, to);
            if (width > 0 && used > width) break;
        }
        if (from > 1) fputc('\n', out);
        for (size_t r = 0; r < table->rows; ++r) {
            print_cell(table, r, 0, false, out);
            for (size_t c = from; c < to; ++c) print_cell(table, r, c, c + 1 == to, out);
            fputc('\n', out);
        }
    }
}
