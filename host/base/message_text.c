/* message_text.c: see message_text.h. */
#include "message_text.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_MAX_COMPARED = 40 };

static size_t least(size_t a, size_t b) {
    return a < b ? a : b;
}

static char small(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

/* Edit distance with swaps of neighbours ("optimal string alignment"; Damerau 1964, Levenshtein 1966). */
static size_t edit_distance(const char *a, size_t a_length, const char *b, size_t b_length) {
    size_t rows[3][NAME_MAX_COMPARED + 1];
    size_t *before = rows[0], *previous = rows[1], *current = rows[2];
    for (size_t j = 0; j <= b_length; j++) previous[j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        current[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            const size_t change = small(a[i - 1]) == small(b[j - 1]) ? 0 : 1;
            current[j] = least(least(previous[j] + 1, current[j - 1] + 1), previous[j - 1] + change);
            if (i > 1 && j > 1 && small(a[i - 1]) == small(b[j - 2]) && small(a[i - 2]) == small(b[j - 1]))
                current[j] = least(current[j], before[j - 2] + 1);
        }
        size_t *const freed = before;
        before = previous;
        previous = current;
        current = freed;
    }
    return previous[b_length];
}

/* One letter may be wrong, or a third of them in a word with the same beginning. */
static bool is_near(const char *a, size_t a_length, const char *b, size_t b_length, size_t distance) {
    return distance <= 1 ||
           (small(a[0]) == small(b[0]) && 3 * distance <= (a_length > b_length ? a_length : b_length));
}

const char *bp_nearest_name(const char *name, const char *const *names, size_t name_count) {
    const size_t length = strlen(name);
    if (length > NAME_MAX_COMPARED) return NULL;
    const char *nearest = NULL;
    size_t nearest_distance = NAME_MAX_COMPARED + 1;
    for (size_t i = 0; i < name_count; i++) {
        const size_t other_length = strlen(names[i]);
        if (other_length > NAME_MAX_COMPARED) continue;
        const size_t distance = edit_distance(name, length, names[i], other_length);
        if (distance < nearest_distance && is_near(name, length, names[i], other_length, distance)) {
            nearest = names[i];
            nearest_distance = distance;
        }
    }
    return nearest;
}

void bp_printable(const char *text, char *out, size_t size) {
    const size_t length = strlen(text);
    size_t count = length;
    if (length >= size) {
        count = size - 4;
        while (count > 0 && ((unsigned char)text[count] & 0xc0u) == 0x80u)
            count--; /* whole characters only */
    }
    for (size_t i = 0; i < count; i++) out[i] = (unsigned char)text[i] < 32 || text[i] == 127 ? '?' : text[i];
    if (count < length)
        memcpy(out + count, "...", sizeof "...");
    else
        out[count] = '\0';
}

const char *bp_number_text(double value, char text[BP_NUMBER_TEXT_SIZE]) {
    if (value == 0 && signbit(value)) { /* as "-0" it would read back as a whole number, without its sign */
        memcpy(text, "-0.0", sizeof "-0.0");
        return text;
    }
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, BP_NUMBER_TEXT_SIZE, "%.*g", digits, value);
        if (strtod(text, NULL) == value) break;
    }
    for (char *c = text; *c != '\0'; c++) {
        if (*c == ',') *c = '.';
    }
    return text;
}

void bp_notes_add(char *notes, size_t size, const char *format, va_list arguments) {
    char text[256];
    vsnprintf(text, sizeof text, format, arguments);
    if (strstr(notes, text) != NULL) return;
    const size_t used = strlen(notes);
    if (used + strlen(text) + 3 > size) return;
    snprintf(notes + used, size - used, "%s%s", used > 0 ? "; " : "", text);
}
