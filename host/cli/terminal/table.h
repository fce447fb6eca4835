/* table.h: prints a table in blocks that fit the page.
 *
 * In:    cells of text.   Out: lines.
 * Knows: columns, their widths.   Does not know: what the cells mean. */
#ifndef BP_CLI_TERMINAL_TABLE_H
#define BP_CLI_TERMINAL_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { BP_CELL_SIZE = 280 };

typedef struct BpTable {
    size_t columns, rows;        /* row 0 is the head */
    const bool *right;           /* of each column: its cells stand at the right */
    char (*cells)[BP_CELL_SIZE]; /* row after row */
} BpTable;

/* False: no memory. Free table->cells with free(). */
bool bp_table_make(BpTable *table, size_t columns, size_t rows, const bool *right);
char *bp_table_cell(const BpTable *table, size_t row, size_t column);

/* Prints as many columns side by side as fit into `width` characters, and the others in blocks below, each
 * preceded by the first column. 0: all side by side. */
void bp_table_print(const BpTable *table, size_t width, FILE *out);

#endif
