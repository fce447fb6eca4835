/* json_text.h: arbitrary bytes as a JSON string.
 *
 * In:    the name of a file, a driver's message.   Out: a jansson string.
 * Knows: that JSON is UTF-8 and names of files need not be.   Does not know: what the text means. */
#ifndef BP_BASE_JSON_TEXT_H
#define BP_BASE_JSON_TEXT_H

#include <jansson.h>

/* `text`, with the replacement character (U+FFFD) for every byte that is not UTF-8. NULL: out of memory. */
json_t *bp_json_text(const char *text);

#endif
