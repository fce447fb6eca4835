/* escape.c: see escape.h. */
#include "escape.h"

#include <string.h>

enum { ESCAPE_LENGTH = 4 }; /* \x1b */

/* The character at `text` (RFC 3629: the shortest form, no surrogates); its length in bytes, 0: no UTF-8. */
static size_t decode(const char *text, uint32_t *character) {
    const unsigned char first = (unsigned char)text[0];
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const size_t length = first < 0x80 ? 1 : first < 0xc0 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    if (length == 0 || first >= 0xf8) return 0;
    *character = length == 1 ? first : first & (0xffu >> (length + 1));
    for (size_t i = 1; i < length; i++) {
        const unsigned char next = (unsigned char)text[i]; /* neither is the end of the text */
        if ((next & 0xc0u) != 0x80) return 0;
        *character = *character << 6 | (next & 0x3fu);
    }
    if (*character < least[length] || *character > 0x10ffff) return 0;
    return *character >= 0xd800 && *character <= 0xdfff ? 0 : length;
}

/* Control characters of both sets (ISO 6429), and those that change the direction of writing (Unicode, UAX
 * 9). */
static bool is_control(uint32_t c) {
    return c < 0x20 || (c >= 0x7f && c <= 0x9f) || (c >= 0x202a && c <= 0x202e) ||
           (c >= 0x2066 && c <= 0x2069);
}

size_t bp_utf8_length(const char *text) {
    uint32_t character = 0;
    return decode(text, &character);
}

size_t bp_control_length(const char *text, uint32_t *character) {
    const size_t length = decode(text, character);
    return length > 0 && is_control(*character) ? length : 0;
}

/* The number of bytes at `text` that need no escape; 0: the first needs one. */
static size_t printable_length(const char *text) {
    uint32_t character = 0;
    const size_t length = decode(text, &character);
    return length > 0 && is_control(character) ? 0 : length;
}

static void escape(char byte, char to[ESCAPE_LENGTH + 1]) {
    snprintf(to, ESCAPE_LENGTH + 1, "\\x%02x", (unsigned char)byte);
}

const char *bp_escape(const char *text, char *buffer, size_t size) {
    size_t used = 0;
    for (const char *at = text; *at != '\0';) {
        char escaped[ESCAPE_LENGTH + 1];
        const size_t length = printable_length(at), taken = length > 0 ? length : 1;
        const size_t put = length > 0 ? length : ESCAPE_LENGTH;
        if (used + put >= size) break;
        if (length == 0) escape(*at, escaped);
        memcpy(buffer + used, length > 0 ? at : escaped, put);
        used += put;
        at += taken;
    }
    buffer[used] = '\0';
    return buffer;
}

void bp_print_escaped(const char *text, bool lines, FILE *out) {
    for (const char *at = text; *at != '\0';) {
        char escaped[ESCAPE_LENGTH + 1];
        const size_t length = lines && (*at == '\n' || *at == '\t') ? 1 : printable_length(at);
        if (length > 0) {
            fwrite(at, 1, length, out);
            at += length;
        } else {
            escape(*at++, escaped);
            fputs(escaped, out);
        }
    }
}

void bp_print_json_escaped(const char *json, FILE *out) {
    for (const char *at = json; *at != '\0';) {
        uint32_t character = 0;
        size_t length = bp_control_length(at, &character);
        if (length > 0 && character >= 0x7f) { /* those below stand between values */
            fprintf(out, "\\u%04x", (unsigned)character);
        } else {
            length = length > 0 ? length : 1;
            fwrite(at, 1, length, out);
        }
        at += length;
    }
}
