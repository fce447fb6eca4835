/* wrap.h: wraps text to the width of a page.
 *
 * In:    text, columns.   Out: the same words, in lines that fit.
 * Knows: where a line may be broken, how continuation lines are indented.   Does not know: what the text
 * means, what it is printed on. */
#ifndef BP_BASE_WRAP_H
#define BP_BASE_WRAP_H

#include <stddef.h>
#include <stdio.h>

/* Marks the column at which the continuation lines of a line begin. Without it, they align with the text
 * behind the first run of two or more blanks, or else are indented by two columns more than the line. */
#define BP_HANG "\x01"
/* Marks a line that is meant to be pasted into a shell: it is broken with backslashes. */
#define BP_PASTE "\x02"

/* Writes `text` to `out` in lines of at most `columns` characters, broken at blanks; 0: unbroken, without the
 * marks. A number and its "%" stay together, and so does text between backticks. A word that is longer than a
 * line is not broken. */
void bp_wrap(const char *text, size_t columns, FILE *out);

#endif
