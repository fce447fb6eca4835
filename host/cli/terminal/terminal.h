/* terminal.h: a status line on the terminal.
 *
 * In:    texts.   Out: one line on standard error that replaces the one before and finally disappears.
 * Knows: standard error, whether it is a terminal, its width.   Does not know: what the texts mean.
 *
 * With --quiet, and where standard error is not a terminal, nothing is ever written. */
#ifndef BP_CLI_TERMINAL_TERMINAL_H
#define BP_CLI_TERMINAL_TERMINAL_H

#include "base/status.h"

/* Whether to show a status line: standard error is a terminal that can move its cursor, and not `quiet`. */
bool bp_terminal_is_live(bool quiet);

/* The current width of the terminal at `descriptor`; if that is unknown, COLUMNS of the environment, else 80;
 * at least 1. */
unsigned bp_terminal_width(int descriptor);
/* The columns of standard error. */
unsigned bp_terminal_columns(void);

/* Whether non-ASCII characters can be displayed (by LC_ALL, LC_CTYPE, LANG). */
bool bp_terminal_has_utf8(void);

/* Replaces the status line by `text`, which the caller has cut to width; "" removes it. */
void bp_terminal_show(const char *text);

/* A wait without measurable progress: after half a second, a thread shows a line with its purpose and the
 * seconds so far. */
typedef struct BpWaiting BpWaiting;

/* Begins; `format` as for printf. NULL if there is no status line or no thread can be started, which is not a
 * failure. */
BpWaiting *bp_waiting_begin(bool quiet, const char *format, ...) BP_PRINTF_LIKE(2, 3);
/* Ends the wait, removes the line, frees. Accepts NULL. */
void bp_waiting_end(BpWaiting *waiting);

#endif
