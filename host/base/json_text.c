/* json_text.c: see json_text.h. */
#include "json_text.h"

json_t *bp_json_text(const char *text) {
    json_t *value = json_string(text);
    if (value != NULL) return value;
    char plain[4096];
    size_t length = 0;
    for (; text[length] != '\0' && length + 1 < sizeof plain; ++length)
        plain[length] = (unsigned char)text[length] < 0x80 ? text[length] : '?';
    plain[length] = '\0';
    return json_string(plain);
}
