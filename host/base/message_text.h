/* message_text.h: names and numbers for messages.
 *
 * In:    names, numbers, notes.   Out: the nearest known name; printable text; a list of notes.
 * Knows: spelling, decimal numbers.   Does not know: what the names and numbers are of. */
#ifndef BP_BASE_MESSAGE_TEXT_H
#define BP_BASE_MESSAGE_TEXT_H

#include <stdarg.h>
#include <stddef.h>

/* The name nearest to `name` by edit distance (swaps of neighbours count as one edit), or NULL if none is
 * similar enough. */
const char *bp_nearest_name(const char *name, const char *const *names, size_t name_count);
/* Makes `text` safe for a message: truncated to `size`, control characters replaced. */
void bp_printable(const char *text, char *out, size_t size);

/* Adds a note to a list of them, "one; other", unless it is there already or does not fit. */
void bp_notes_add(char *notes, size_t size, const char *format, va_list arguments);

#define BP_NUMBER_TEXT_SIZE 32
/* The shortest decimal text that reads back as `value`, with a point in every locale. */
const char *bp_number_text(double value, char text[BP_NUMBER_TEXT_SIZE]);

#endif
