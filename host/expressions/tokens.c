/* tokens.c: see tokens.h. */
#include "tokens.h"

#include "base/decimal.h"
#include "base/message_text.h"

#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { SHOWN_BEFORE = 48, SHOWN_IN_ALL = 96, INDENT = 4 };

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/* Letters, and all of UTF-8 beyond ASCII. */
static bool begins_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || ((unsigned char)c & 0x80u) != 0;
}

static bool is_in_name(char c) {
    return begins_name(c) || is_digit(c);
}

static bool is_continuation(char c) {
    return ((unsigned char)c & 0xc0u) == 0x80u;
}

static size_t characters(const char *text, size_t begin, size_t end) {
    size_t count = 0;
    for (size_t i = begin; i < end; i++) count += !is_continuation(text[i]);
    return count;
}

/* The part of the text around the place, in one line, and marks below it. */
static void draw(const char *text, size_t begin, size_t end, BpError *err) {
    char drawing[2 * (INDENT + SHOWN_IN_ALL * 4) + 64];
    const size_t length = strlen(text);
    size_t first = begin > SHOWN_BEFORE && length > SHOWN_IN_ALL ? begin - SHOWN_BEFORE : 0;
    while (first > 0 && is_continuation(text[first])) first--;
    size_t last = length > first + SHOWN_IN_ALL ? first + SHOWN_IN_ALL : length;
    while (last < length && is_continuation(text[last])) last++;
    const char *const before = first > 0 ? "... " : "", *const after = last < length ? " ..." : "";
    size_t used = (size_t)snprintf(drawing, sizeof drawing, "%*s%s", INDENT, "", before);
    const size_t left = used;
    for (size_t i = first; i < last; i++)
        drawing[used++] = (unsigned char)text[i] < ' ' || text[i] == 0x7f ? ' ' : text[i];
    used += (size_t)snprintf(drawing + used, sizeof drawing - used, "%s\n%*s", after,
                             (int)(left + characters(text, first, begin)), "");
    const size_t width = characters(text, begin, end < last ? end : last);
    for (size_t i = 0; i < width || i == 0; i++) drawing[used++] = '^';
    drawing[used] = '\0';
    bp_error_attach(err, drawing);
}

static BpStatus fail(const char *text, size_t begin, size_t end, BpError *err, const char *message) {
    const BpStatus status =
        bp_fail(err, BP_ERR_SCENE, "at character %zu: %s", characters(text, 0, begin) + 1, message);
    draw(text, begin, end, err);
    return status;
}

BpStatus token_fail(const char *text, size_t begin, size_t end, BpError *err, const char *format, ...) {
    char message[640];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return fail(text, begin, end, err, message);
}

static BpStatus read_text(const char *text, Token *token, BpError *err) {
    const char quote = text[token->begin];
    size_t at = token->begin + 1;
    while (text[at] != '\0' && text[at] != quote) at += text[at] == '\\' && text[at + 1] != '\0' ? 2 : 1;
    if (text[at] == '\0')
        return token_fail(text, token->begin, at, err, "found a text without its end, expected %c behind it",
                          quote);
    token->kind = TOKEN_TEXT;
    token->end = at + 1;
    return BP_OK;
}

static BpStatus read_number(const char *text, Token *token, BpError *err) {
    const locale_t point = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (point == (locale_t)0) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a locale");
    const locale_t before = uselocale(point);
    const char *const end = bp_decimal_parse(text + token->begin, &token->number);
    uselocale(before);
    freelocale(point);
    size_t at = end != NULL ? (size_t)(end - text) : token->begin + 1;
    token->kind = TOKEN_NUMBER;
    token->end = at;
    while (is_in_name(text[at]) || text[at] == '.') at++;
    if (end == NULL || at > token->end)
        return token_fail(text, token->begin, at, err,
                          "found a number with letters, expected a number, or a text in quotes: \"%.*s\"",
                          (int)(at - token->begin < 32 ? at - token->begin : 32), text + token->begin);
    if (!isfinite(token->number))
        return token_fail(text, token->begin, at, err, "found a number that is too large for a double");
    return BP_OK;
}

/* A name, with an index as LAMMPS writes it: c_stress[1]; points join parts: Position.X. */
static void read_name(const char *text, Token *token) {
    static const struct {
        const char *word;
        TokenKind kind;
    } words[] = {{"or", TOKEN_OR}, {"and", TOKEN_AND},       {"not", TOKEN_NOT},
                 {"in", TOKEN_IN}, {"within", TOKEN_WITHIN}, {"of", TOKEN_OF}};
    size_t at = token->begin;
    for (;;) {
        while (is_in_name(text[at])) at++;
        if (text[at] == '.' && begins_name(text[at + 1])) {
            at++;
            continue;
        }
        const size_t digits = text[at] == '[' ? strspn(text + at + 1, "0123456789") : 0;
        if (digits == 0 || text[at + 1 + digits] != ']') break;
        at += digits + 2;
    }
    token->kind = TOKEN_NAME;
    token->end = at;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strlen(words[i].word) == at - token->begin &&
            strncmp(words[i].word, text + token->begin, at - token->begin) == 0)
            token->kind = words[i].kind;
}

BpStatus token_read(const char *text, size_t at, Token *token, BpError *err) {
    static const struct {
        const char *sign;
        TokenKind kind;
    } signs[] = {/* the longer ones first */
                 {"**", TOKEN_POWER},   {"<=", TOKEN_AT_MOST}, {">=", TOKEN_AT_LEAST}, {"==", TOKEN_EQUAL},
                 {"!=", TOKEN_UNEQUAL}, {"&&", TOKEN_AND},     {"||", TOKEN_OR},       {"(", TOKEN_OPEN},
                 {")", TOKEN_CLOSE},    {",", TOKEN_COMMA},    {"+", TOKEN_PLUS},      {"-", TOKEN_MINUS},
                 {"*", TOKEN_TIMES},    {"/", TOKEN_DIVIDE},   {"%", TOKEN_MODULO},    {"^", TOKEN_POWER},
                 {"<", TOKEN_LESS},     {">", TOKEN_MORE},     {"!", TOKEN_NOT}};
    at += strspn(text + at, " \t\r\n");
    *token = (Token){TOKEN_END, at, at, 0};
    const char c = text[at];
    if (c == '\0') return BP_OK;
    if (is_digit(c) || (c == '.' && is_digit(text[at + 1]))) return read_number(text, token, err);
    if (c == '"' || c == '\'') return read_text(text, token, err);
    if (begins_name(c)) {
        read_name(text, token);
        return BP_OK;
    }
    for (size_t i = 0; i < sizeof signs / sizeof *signs; i++) {
        const size_t length = strlen(signs[i].sign);
        if (strncmp(text + at, signs[i].sign, length) != 0) continue;
        token->kind = signs[i].kind;
        token->end = at + length;
        return BP_OK;
    }
    if (c == '=') return token_fail(text, at, at + 1, err, "found \"=\", expected \"==\", which compares");
    char shown[8] = {c, '\0'};
    bp_printable(shown, shown, sizeof shown);
    return token_fail(text, at, at + 1, err,
                      "found \"%s\", expected a name, a number or a sign such as ==", shown);
}

void token_text(const char *text, const Token *token, char *out) {
    size_t used = 0;
    const bool quoted = token->kind == TOKEN_TEXT;
    const size_t end = token->end - quoted;
    for (size_t i = token->begin + quoted; i < end; i++) {
        if (quoted && text[i] == '\\' && i + 1 < end) i++;
        out[used++] = text[i];
    }
    out[used] = '\0';
}
