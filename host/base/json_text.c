/* json_text.c: see json_text.h. */
#include "json_text.h"

#include "escape.h"

#include <stdlib.h>
#include <string.h>

json_t *bp_json_text(const char *text) {
    static const char replacement[] = "\xef\xbf\xbd";
    char *clean = malloc(3 * strlen(text) + 1), *end = clean;
    if (clean == NULL) return NULL;
    while (*text != '\0') {
        const size_t length = bp_utf8_length(text), put = length > 0 ? length : sizeof replacement - 1;
        memcpy(end, length > 0 ? text : replacement, put);
        end += put;
        text += length > 0 ? length : 1;
    }
    *end = '\0';
    json_t *value = json_string(clean);
    free(clean);
    return value;
}
