/* document_locate.c: from a path of members and elements to a place in a JSON text.
 *
 * In:    a text that a JSON parser has accepted.   Out: offsets, lines, columns.
 * Knows: JSON's tokens.                            Does not know: what they mean.
 *
 * Works without recursion, so that no depth of nesting can exhaust the stack, and never reads past the end,
 * even of a text that is not JSON. */
#include "document.h"

static size_t skip_space(const char *text, size_t length, size_t at) {
    while (at < length && (text[at] == ' ' || text[at] == '\t' || text[at] == '\n' || text[at] == '\r')) at++;
    return at;
}

static size_t skip_string(const char *text, size_t length, size_t at) {
    for (at++; at < length && text[at] != '"'; at++) {
        if (text[at] == '\\') at++;
    }
    return at < length ? at + 1 : length;
}

static size_t skip_value(const char *text, size_t length, size_t at) {
    size_t depth = 0;
    while (at < length) {
        const char c = text[at];
        if (c == '"') {
            at = skip_string(text, length, at);
            if (depth == 0) return at;
        } else if (c == '{' || c == '[') {
            depth++;
            at++;
        } else if (c == '}' || c == ']') {
            if (depth == 0) return at; /* the end of a number or word before it */
            at++;
            if (--depth == 0) return at;
        } else if (c == ',' && depth == 0) {
            return at;
        } else {
            at++;
        }
    }
    return length;
}

/* From the opening quote of a member's name to its value. */
static size_t skip_name(const char *text, size_t length, size_t at) {
    at = skip_space(text, length, skip_string(text, length, at));
    if (at < length && text[at] == ':') at++;
    return skip_space(text, length, at);
}

size_t bp_json_locate(const char *text, size_t length, const size_t *steps, size_t step_count, BpPart part) {
    size_t at = skip_space(text, length, 0);
    size_t name_at = at;
    for (size_t s = 0; s < step_count && at < length; s++) {
        const bool object = text[at] == '{';
        at = skip_space(text, length, at + 1);
        for (size_t k = 0; k < steps[s] && at < length; k++) {
            if (object) at = skip_name(text, length, at);
            at = skip_space(text, length, skip_value(text, length, at));
            if (at < length && text[at] == ',') at++;
            at = skip_space(text, length, at);
        }
        name_at = at;
        if (object && at < length) at = skip_name(text, length, at);
    }
    return part == BP_PART_NAME ? name_at : at;
}

void bp_text_position(const char *text, size_t length, size_t offset, int *line, int *column) {
    *line = 1;
    *column = 1;
    for (size_t i = 0; i < offset && i < length; i++) {
        if (text[i] == '\n') {
            (*line)++;
            *column = 1;
        } else if (((unsigned char)text[i] & 0xc0u) != 0x80u) { /* not the continuation of a character */
            (*column)++;
        }
    }
}
