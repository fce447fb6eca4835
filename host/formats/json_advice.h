/* json_advice.h: what to write instead of what JSON does not allow.
 *
 * In:    a text that a JSON parser has refused, and where.   Out: a sentence for the person who wrote it.
 * Knows: what people write out of habit from other languages.   Does not know: what a scene is. */
#ifndef BP_FORMATS_JSON_ADVICE_H
#define BP_FORMATS_JSON_ADVICE_H

#include <jansson.h>

/* The offset of the token that jansson did not expect; `length` where the text ends too early. */
size_t bp_json_error_place(const char *text, size_t length, const json_error_t *error);

enum { BP_JSON_ADVICE_SIZE = 200 };

/* `at`: such an offset. Static, or in `room`; "" where nothing is known that would help. */
const char *bp_json_advice(const char *text, size_t length, size_t at, char room[BP_JSON_ADVICE_SIZE]);

#endif
