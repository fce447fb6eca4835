/* key_values.c: see key_values.h. */
#include "key_values.h"

#include "input.h"

#include <string.h>
#include <strings.h>

enum { NUMBER_SIZE = 64 };

static const char blanks[] = " \t\r";

/* The bracket or quote that closes the one at hand; 0: it is none. */
static char closing(char opening) {
    static const char pairs[] = "\"\"''{}[]()";
    for (const char *p = pairs; *p != '\0'; p += 2)
        if (*p == opening) return p[1];
    return '\0';
}

/* Reads one value or key, which ends at a blank or a character of `ends` unless it stands in quotes or
 * brackets. Returns what follows it; NULL: it is not closed. What has no room is left away. A backslash
 * stands before what would mean something otherwise. */
static const char *take_text(const char *c, const char *ends, char *out, size_t size) {
    const char opening = *c, close = closing(opening);
    size_t length = 0;
    int depth = 0;
    c += close != '\0';
    for (; *c != '\0'; c++) {
        const bool escaped = *c == '\\' && c[1] != '\0';
        if (!escaped && close == '\0' && (strchr(blanks, *c) != NULL || strchr(ends, *c) != NULL)) break;
        if (!escaped && close != '\0' && *c == close && depth-- == 0) break;
        depth += !escaped && close != opening && *c == opening;
        c += escaped;
        if (length < size - 1) out[length++] = escaped && *c == 'n' ? '\n' : *c;
    }
    out[length] = '\0';
    if (close == '\0') return c;
    return *c == close ? c + 1 : NULL;
}

KeyFound key_find(const char *line, const char *key, char value[KEY_VALUE_SIZE]) {
    char name[KEY_VALUE_SIZE];
    for (const char *c = line + strspn(line, blanks); *c != '\0'; c += strspn(c, blanks)) {
        /* Where no key can be read, as in free text, a word is passed over. */
        const char *after = take_text(c, "=", name, sizeof name);
        if (after == NULL) after = c + strcspn(c, blanks);
        const char *const sign = after + strspn(after, blanks);
        if (after == c) after++;
        if (*sign != '=') {
            c = after;
            continue;
        }
        const bool wanted = strcasecmp(name, key) == 0;
        const char *const begin = sign + 1 + strspn(sign + 1, blanks);
        const char *const end = take_text(begin, "", value, KEY_VALUE_SIZE);
        if (wanted) return end != NULL && strlen(value) < KEY_VALUE_SIZE - 1 ? KEY_FOUND : KEY_BROKEN;
        c = end != NULL ? end : begin + strcspn(begin, blanks);
    }
    return KEY_ABSENT;
}

int key_numbers(const char *value, double *numbers, int max) {
    static const char between[] = " \t\r\n,;[](){}";
    char word[NUMBER_SIZE];
    int count = 0;
    for (const char *c = value + strspn(value, between); *c != '\0'; c += strspn(c, between)) {
        const size_t length = strcspn(c, between);
        double number = 0;
        if (length >= sizeof word) return -1;
        memcpy(word, c, length);
        word[length] = '\0';
        if (!word_number(word, &number)) return -1;
        if (count < max) numbers[count] = number;
        count++;
        c += length;
    }
    return count;
}
