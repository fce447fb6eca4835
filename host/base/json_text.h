/* json_text.h: text from outside in a JSON document.
 *
 * Knows: UTF-8 as jansson demands it.   Does not know: documents. */
#ifndef BP_BASE_JSON_TEXT_H
#define BP_BASE_JSON_TEXT_H

#include <jansson.h>

/* A new string; text that is not UTF-8, as a path may be, has "?" for each byte beyond ASCII. NULL: no
 * memory. */
json_t *bp_json_text(const char *text);

#endif
