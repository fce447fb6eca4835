/* json_advice.c: see json_advice.h. */
#include "json_advice.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { WORD_SIZE = 48, DEPTH_MAX = 64 };

typedef struct Place {
    const char *text;
    size_t length, at;
    char word[WORD_SIZE]; /* what stands there: letters, digits, signs and points */
    char before;          /* the last character before it that is not a space; '\0' at the beginning */
} Place;

static char char_at(const Place *place, size_t at) {
    return at < place->length ? place->text[at] : '\0';
}

static bool is_word(char c) {
    return isalnum((unsigned char)c) || (c != '\0' && strchr("+-._", c) != NULL);
}

/* Finds the word around the place: parsers report the middle of a number that they have read in part. */
static void find_word(Place *place) {
    size_t begin = place->at, end = place->at;
    while (is_word(char_at(place, end))) end++;
    while (end > place->at && begin > 0 && is_word(place->text[begin - 1])) begin--;
    const size_t count = end - begin < WORD_SIZE - 1 ? end - begin : 0;
    memcpy(place->word, place->text + begin, count);
    place->word[count] = '\0';
    while (begin > 0 && strchr(" \t\r\n", place->text[begin - 1]) != NULL && place->text[begin - 1] != '\0')
        begin--;
    place->before = begin > 0 ? place->text[begin - 1] : '\0';
}

/* The innermost bracket or quote that is open at `end`, or SIZE_MAX. */
static size_t find_open(const Place *place, size_t end) {
    size_t stack[DEPTH_MAX], depth = 0;
    for (size_t i = 0; i < end && i < place->length; i++) {
        const char c = place->text[i];
        if (c == '"') {
            const size_t quote = i++;
            while (i < end && place->text[i] != '"') i += place->text[i] == '\\' ? 2 : 1;
            if (i >= end) return quote;
        } else if (c == '{' || c == '[') {
            if (depth < DEPTH_MAX) stack[depth] = i;
            depth++;
        } else if ((c == '}' || c == ']') && depth > 0) {
            depth--;
        }
    }
    return depth > 0 && depth <= DEPTH_MAX ? stack[depth - 1] : (size_t)-1;
}

static const char *advise_open(const Place *place, size_t open, const char *end, char *advice) {
    int line = 1;
    for (size_t i = 0; i < open; i++) line += place->text[i] == '\n';
    const char *const what = place->text[open] == '"' ? "quote" : place->text[open] == '{' ? "{" : "[";
    snprintf(advice, BP_JSON_ADVICE_SIZE, "the %s of line %d is not closed%s", what, line, end);
    return advice;
}

static const char *advise_end(const Place *place, char *advice) {
    const size_t open = find_open(place, place->length);
    return open == (size_t)-1 ? "" : advise_open(place, open, ", or the file is truncated", advice);
}

static const char *advise_bracket(const Place *place, char found, char *advice) {
    const size_t open = find_open(place, place->at);
    if (place->before == ',') return "is there a comma too many before it?";
    if (place->before == ':') return "a value is missing after the colon";
    if (open == (size_t)-1) return "it closes nothing: remove it";
    if ((place->text[open] == '{') == (found == '}')) return "a colon and a value are missing after the name";
    return advise_open(place, open, " before it", advice);
}

/* Whether the text that begins at the place goes on to the next line. */
static bool runs_on(const Place *place) {
    size_t end = place->at + 1;
    while (end < place->length && place->text[end] != '"' && place->text[end] != '\n') end++;
    return char_at(place, end) == '\n';
}

/* NULL: nothing is known of it. */
static const char *advise_sign(const Place *place) {
    const char c = char_at(place, place->at), next = char_at(place, place->at + 1);
    if (c == '#' || (c == '/' && (next == '/' || next == '*')))
        return "JSON has no comments: use \"title\" and \"source\", or remove it";
    if (c == '\'') return "names and texts stand in double quotes";
    if (c == '(') return "lists stand in square brackets: [1, 2, 3]";
    if (c == '=') return "a colon stands between a name and its value";
    if (c == ',' && place->before == ':') return "a value is missing after the colon";
    if (c == ',') return "there is a comma too many: remove it";
    if (c == '"' && runs_on(place))
        return "is its closing quote missing? A text ends on its line, and \\n stands for a new one";
    return NULL;
}

static const char *advise_word(const Place *place) {
    const char *const word = place->word + strspn(place->word, "+-.");
    if (strncasecmp(word, "nan", 3) == 0 || strncasecmp(word, "inf", 3) == 0)
        return "JSON has no NaN and no Infinity: expected a finite number";
    if (place->before != '\0' &&
        (isalnum((unsigned char)place->before) || strchr("\"}]", place->before) != NULL))
        return "is there a comma or a colon missing before it?";
    if (isdigit((unsigned char)word[0]))
        return "numbers are written like 20, 0.5 or 1e-3, with digits on both sides of the point and without "
               "a unit";
    return word[0] != '\0'
               ? "names and texts stand in double quotes; true, false and null are written like that"
               : "";
}

size_t bp_json_error_place(const char *text, size_t length, const json_error_t *error) {
    size_t end = error->position < 0 ? 0 : (size_t)error->position; /* where the token ends */
    if (end > length || json_error_code(error) == json_error_premature_end_of_input) end = length;
    const char *near = strstr(error->text, " near '");
    if (near == NULL) return end;
    const char *const token = near + strlen(" near '");
    const size_t token_length = strlen(token) > 0 ? strlen(token) - 1 : 0;
    if (token_length <= end && memcmp(text + end - token_length, token, token_length) == 0)
        return end - token_length;
    return end;
}

const char *bp_json_advice(const char *text, size_t length, size_t at, char room[BP_JSON_ADVICE_SIZE]) {
    Place place = {.text = text, .length = length, .at = at < length ? at : length};
    const char c = char_at(&place, place.at);
    find_word(&place);
    if (c == '\0') return advise_end(&place, room);
    if (c == '}' || c == ']') return advise_bracket(&place, c, room);
    const char *const said = advise_sign(&place);
    return said != NULL ? said : advise_word(&place);
}
