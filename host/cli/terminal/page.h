/* page.h: a command's text output, wrapped to the width of the terminal.
 *
 * In:    text.   Out: lines on standard output or standard error.
 * Knows: --quiet, --wide, the width of the terminal.   Does not know: what the text means.
 *
 * Results for people go to a page on standard output, notes to standard error. With --quiet neither is
 * printed. Documents and pictures on standard output do not go through a page. */
#ifndef BP_CLI_TERMINAL_PAGE_H
#define BP_CLI_TERMINAL_PAGE_H

#include "cli/line/options.h"

#include <stdio.h>

typedef struct BpPage {
    FILE *text; /* to be written to; may have the marks of base/wrap.h */
    char *bytes;
    size_t size;
} BpPage;

/* Begins a page that will go to `out`, standard output or standard error. */
void bp_page_begin(BpPage *page, FILE *out);
/* Prints the page, unless --quiet, wrapped to the width; with --wide, unwrapped. */
void bp_page_end(BpPage *page, const BpCommandLine *line, FILE *out);

/* Prints `text` wrapped to `columns` (0: unwrapped) by one write, since standard error is unbuffered. */
void bp_page_print(const char *text, size_t columns, FILE *out);

/* Prints one text as a page on standard error. A newline is appended. Terminal control sequences are escaped.
 */
void bp_say(const BpCommandLine *line, const char *format, ...) BP_PRINTF_LIKE(2, 3);

/* Columns of a page on `out`: those of the terminal, else COLUMNS, else 80; 0 with --wide. */
size_t bp_page_columns(const BpCommandLine *line, FILE *out);

#endif
