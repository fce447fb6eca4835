/* terminal.h: a status line on the terminal.
 *
 * In:    texts.   Out: one line on standard error that replaces the one before and finally disappears.
 * Knows: standard error, whether it is a terminal, its width.   Does not know: what the texts say.
 *
 * With --quiet, and where standard error is not a terminal, nothing is ever written. */
#ifndef BP_CLI_TERMINAL_TERMINAL_H
#define BP_CLI_TERMINAL_TERMINAL_H

#include "base/status.h"

/* Whether a status line is wanted: standard error is a terminal that can move its cursor, and not `quiet`. */
bool bp_terminal_is_live(bool quiet);

/* Columns of the terminal at `descriptor` now; if there is no terminal or it does not report its width,
 * COLUMNS of the environment, else 80; at least 1. */
unsigned bp_terminal_width(int descriptor);
/* The columns of standard error. */
unsigned bp_terminal_columns(void);

/* Whether characters outside ASCII are shown (by LC_ALL, LC_CTYPE, LANG). */
bool bp_terminal_has_utf8(void);

/* Shows `text` as the status line, in place of the one before. "" takes it away. The caller cuts it to width.
 */
void bp_terminal_show(const char *text);

/* A wait during which nothing can be counted: after half a second a line of its own thread says what is
 * awaited and for how long already. */
typedef struct BpWaiting BpWaiting;

/* Begins; `format` as for printf. NULL if no line is wanted or no thread can be started, which is not a
 * failure. */
BpWaiting *bp_waiting_begin(bool quiet, const char *format, ...) BP_PRINTF_LIKE(2, 3);
/* Ends, takes the line away, frees. Accepts NULL. */
void bp_waiting_end(BpWaiting *waiting);

#endif
