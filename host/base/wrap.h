/* wrap.h: text broken into lines of a page's width.
 *
 * In:    text, columns.   Out: the same words, in lines that fit.
 * Knows: where a line may be broken, how the rest of it is indented.   Does not know: what the text means,
 * what it is printed on. */
#ifndef BP_BASE_WRAP_H
#define BP_BASE_WRAP_H

#include <stddef.h>
#include <stdio.h>

/* Written into a line: if the line is broken, its other lines begin at the column of this mark. Without it
 * they begin below what stands behind the first two blanks or more, or two columns further in than the first
 * line. */
#define BP_HANG "\x01"
/* Written into a line that a shell is to read: where it is broken, a backslash continues it. */
#define BP_PASTE "\x02"

/* Writes `text` to `out` in lines of at most `columns` characters, broken at blanks; 0: as it is, without the
 * marks. A number and its "%" stay together, and so does text between backticks. A word that is longer
 * than a line is not broken. */
void bp_wrap(const char *text, size_t columns, FILE *out);

#endif
