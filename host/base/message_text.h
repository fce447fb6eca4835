/* message_text.h: names and numbers as messages quote them.
 *
 * In:    names, numbers.   Out: the nearest known name; printable text.
 * Knows: spelling, decimal numbers.   Does not know: what the names and numbers are of. */
#ifndef BP_BASE_MESSAGE_TEXT_H
#define BP_BASE_MESSAGE_TEXT_H

#include <stddef.h>

/* The name nearest to `name` by edit distance (swaps of neighbours count as one edit), or NULL if none is
 * near enough to be what was meant. */
const char *bp_nearest_name(const char *name, const char *const *names, size_t name_count);
/* `text` fit for a message: cut to size, control characters replaced. */
void bp_printable(const char *text, char *out, size_t size);

#define BP_NUMBER_TEXT_SIZE 32
/* The shortest decimal text that reads back as `value`, with a point in every locale. */
const char *bp_number_text(double value, char text[BP_NUMBER_TEXT_SIZE]);

#endif
