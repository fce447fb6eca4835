/* json_advice.c: see json_advice.h. */
#include "json_advice.h"

#include "base/message_text.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { WORD_SIZE = 48, DEPTH_MAX = 64 };

typedef struct Place {
    const char *text;
    size_t length, at;
    char word[WORD_SIZE]; /* what stands there: letters, digits, signs and points */
    char before;          /* the last character before it that is no space; '\0' at the beginning */
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

/* ---- numbers and words --------------------------------------------------------------------------------- */

static const char *skip_digits(const char *c) {
    while (isdigit((unsigned char)*c)) c++;
    return c;
}

/* Writes `word` as JSON has numbers: no plus, digits on both sides of the point, no zeros in front. False: it
 * is none.
 */
static bool correct_number(const char *word, char out[WORD_SIZE + 4]) {
    const char *const sign = *word == '-' ? "-" : "";
    if (*word == '-' || *word == '+') word++;
    while (word[0] == '0' && isdigit((unsigned char)word[1])) word++;
    const char *const whole_end = skip_digits(word);
    const char *const fraction = *whole_end == '.' ? whole_end + 1 : whole_end;
    const char *const fraction_end = skip_digits(fraction);
    const bool has_fraction = fraction_end > fraction;
    if (whole_end == word && !has_fraction) return false;
    const char *exponent = fraction_end;
    if (*exponent == 'e' || *exponent == 'E') {
        exponent += exponent[1] == '+' || exponent[1] == '-' ? 2 : 1;
        if (!isdigit((unsigned char)*exponent)) return false;
        exponent = skip_digits(exponent);
    }
    if (*exponent != '\0') return false;
    snprintf(out, WORD_SIZE + 4, "%s%.*s%s%s%.*s%s", sign, (int)(whole_end - word), word,
             whole_end == word ? "0" : "", *whole_end == '.' ? "." : "", (int)(fraction_end - fraction),
             fraction, *whole_end == '.' && !has_fraction ? "0" : "");
    strncat(out, fraction_end, WORD_SIZE + 3 - strlen(out));
    return true;
}

static bool advise_number(const Place *place, char *advice) {
    const char *const word = place->word, *const digits = word + strspn(word, "+-");
    char corrected[WORD_SIZE + 4];
    if (!isdigit((unsigned char)digits[digits[0] == '.' ? 1 : 0])) return false;
    if (!correct_number(word, corrected))
        snprintf(advice, BP_JSON_ADVICE_SIZE,
                 "\"%s\" is no number: write one such as 20, 0.5 or 1e-3, without a unit", word);
    else if (strcmp(corrected, word) != 0)
        snprintf(advice, BP_JSON_ADVICE_SIZE, "write %s", corrected);
    else
        return false;
    return true;
}

static bool advise_word(const Place *place, char *advice) {
    static const struct {
        const char *word, *write;
    } known[] = {{"true", "true"}, {"yes", "true"},  {"on", "true"},   {"false", "false"}, {"no", "false"},
                 {"off", "false"}, {"null", "null"}, {"none", "null"}, {"nil", "null"}};
    const char *const word = place->word + strspn(place->word, "+-");
    if (!isalpha((unsigned char)word[0]) && word[0] != '_') return false;
    if (strncasecmp(word, "nan", 3) == 0)
        return strcpy(advice, "JSON has no NaN: expected a finite number") != NULL;
    if (strncasecmp(word, "inf", 3) == 0)
        return snprintf(advice, BP_JSON_ADVICE_SIZE, "JSON has no %sInfinity: expected a finite number",
                        place->word[0] == '-' ? "-" : "") > 0;
    for (size_t i = 0; i < sizeof known / sizeof *known && place->before == ':'; i++)
        if (strcasecmp(word, known[i].word) == 0)
            return snprintf(advice, BP_JSON_ADVICE_SIZE, "write %s", known[i].write) > 0;
    return snprintf(advice, BP_JSON_ADVICE_SIZE, "names and texts stand in double quotes: write \"%s\"",
                    word) > 0;
}

/* ---- brackets ------------------------------------------------------------------------------------------ */

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

static int line_of(const Place *place, size_t at) {
    int line = 1;
    for (size_t i = 0; i < at; i++) line += place->text[i] == '\n';
    return line;
}

static bool advise_end(const Place *place, char *advice) {
    const size_t open = find_open(place, place->length);
    if (open == (size_t)-1) return false;
    return snprintf(advice, BP_JSON_ADVICE_SIZE, "the %s of line %d is not closed, or the file is truncated",
                    place->text[open] == '"'   ? "quote"
                    : place->text[open] == '{' ? "{"
                                               : "[",
                    line_of(place, open)) > 0;
}

static bool advise_bracket(const Place *place, char found, char *advice) {
    const size_t open = find_open(place, place->at);
    if (place->before == ',') return strcpy(advice, "is there a comma too many before it?") != NULL;
    if (place->before == ':') return strcpy(advice, "a value is missing after the colon") != NULL;
    if (open == (size_t)-1) return strcpy(advice, "it closes nothing: remove it") != NULL;
    if ((place->text[open] == '{') == (found == '}'))
        return strcpy(advice, "a colon and a value are missing after the name") != NULL;
    return snprintf(advice, BP_JSON_ADVICE_SIZE, "the %c of line %d is not closed before it",
                    place->text[open], line_of(place, open)) > 0;
}

/* ---- signs --------------------------------------------------------------------------------------------- */

static bool ends_value(char c) {
    return isalnum((unsigned char)c) || (c != '\0' && strchr("\"}].", c) != NULL);
}

/* A text that the parser refuses for what is in it. */
static bool advise_text(const Place *place, char *advice) {
    if (char_at(place, place->at) != '"') return false;
    for (size_t i = place->at + 1; i < place->length && place->text[i] != '"'; i++) {
        if (place->text[i] == '\n')
            return strcpy(advice, "is its closing quote missing? A text ends on its line, and \\n stands for "
                                  "a new one") != NULL;
        if (place->text[i] == '\t') return strcpy(advice, "write \\t for a tab in a text") != NULL;
        if (place->text[i] != '\\') continue;
        if (strchr("\"\\/bfnrtu", char_at(place, ++i)) == NULL)
            return strcpy(advice, "write \\\\ for a backslash in a text") != NULL;
    }
    return false;
}

/* A value or name that stands behind a value, or behind a name. */
static bool advise_gap(const Place *place, char *advice) {
    if (!ends_value(place->before)) return false;
    const size_t open = find_open(place, place->at);
    if (open == (size_t)-1) return false;
    if (place->text[open] == '[' || char_at(place, place->at) == '"')
        return strcpy(advice, "is there a comma missing before it?") != NULL;
    return strcpy(advice, "is there a colon or a comma missing before it?") != NULL;
}

static bool is_typographic(const Place *place) {
    static const char *const quotes[] = {"\xe2\x80\x98", "\xe2\x80\x99", "\xe2\x80\x9c", "\xe2\x80\x9d",
                                         "\xe2\x80\x9e", "\xc2\xab",     "\xc2\xbb"};
    for (size_t i = 0; i < sizeof quotes / sizeof *quotes; i++) {
        const size_t size = strlen(quotes[i]);
        if (place->length - place->at >= size && memcmp(place->text + place->at, quotes[i], size) == 0)
            return true;
    }
    return false;
}

static bool advise_sign(const Place *place, char *advice) {
    const char c = char_at(place, place->at), next = char_at(place, place->at + 1);
    const char *say = NULL;
    if (c == '#' || (c == '/' && (next == '/' || next == '*')))
        say = "JSON has no comments: use \"title\" and \"source\", or remove it";
    else if (c == '\'' || c == '`' || is_typographic(place))
        say = "names and texts stand in double quotes, \" and \"";
    else if (c == '(' || c == ')')
        say = "lists stand in square brackets: [1, 2, 3]";
    else if (c == '=')
        say = "a colon stands between a name and its value";
    else if (c == ';')
        say = "a comma stands between members";
    else if (c == '/' || c == '*')
        say = "JSON does not calculate: write the number";
    else if (c == ',' && (place->before == ',' || place->before == '[' || place->before == '{'))
        say = "there is a comma too many: remove it";
    else if (c == ',' && place->before == ':')
        say = "a value is missing after the colon";
    if (say != NULL) strcpy(advice, say);
    return say != NULL;
}

/* A comma for the decimal point: digits on both sides of it, where a name should stand. */
static bool advise_decimal_comma(const Place *place, char *advice) {
    const size_t at = place->at;
    if (at < 2 || place->text[at - 1] != ',' || !isdigit((unsigned char)place->text[at - 2]) ||
        !isdigit((unsigned char)char_at(place, at)))
        return false;
    return strcpy(advice,
                  "a name in double quotes stands after a comma; numbers have a decimal point, as in 0.5") !=
           NULL;
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

const char *bp_json_advice(const char *text, size_t length, size_t at, char advice[BP_JSON_ADVICE_SIZE]) {
    Place place = {.text = text, .length = length, .at = at < length ? at : length};
    const char c = char_at(&place, place.at);
    advice[0] = '\0';
    find_word(&place);
    if (c == '\0')
        advise_end(&place, advice);
    else if (c == '}' || c == ']')
        advise_bracket(&place, c, advice);
    else if (!advise_sign(&place, advice) && !advise_text(&place, advice) &&
             !advise_decimal_comma(&place, advice) && !advise_number(&place, advice) &&
             !advise_gap(&place, advice))
        advise_word(&place, advice);
    return advice;
}
