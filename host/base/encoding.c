/* encoding.c: see encoding.h. */
#include "encoding.h"

#include <stdbool.h>
#include <string.h>

size_t bp_text_mark(const void *text, size_t length) {
    return length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

/* Whether units of `size` bytes hold letters of ASCII: the byte at `place` is one, the others are 0. */
static bool is_ascii_in_units(const unsigned char *bytes, size_t length, size_t size, size_t place) {
    if (length < 2 * size) return false;
    for (size_t i = 0; i < 2 * size; i++) {
        const bool letter = bytes[i] >= '\t' && bytes[i] < 0x7f;
        if (i % size == place ? !letter : bytes[i] != 0) return false;
    }
    return true;
}

const char *bp_text_wide(const void *text, size_t length) {
    const unsigned char *const bytes = text;
    if (length >= 4 && (memcmp(bytes, "\xff\xfe\0\0", 4) == 0 || memcmp(bytes, "\0\0\xfe\xff", 4) == 0))
        return "UTF-32";
    if (length >= 2 && (memcmp(bytes, "\xff\xfe", 2) == 0 || memcmp(bytes, "\xfe\xff", 2) == 0))
        return "UTF-16";
    if (is_ascii_in_units(bytes, length, 4, 0) || is_ascii_in_units(bytes, length, 4, 3)) return "UTF-32";
    if (is_ascii_in_units(bytes, length, 2, 0) || is_ascii_in_units(bytes, length, 2, 1)) return "UTF-16";
    return NULL;
}
