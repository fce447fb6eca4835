/* decimal.c: see decimal.h. */
#include "decimal.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/* Digits and exponents that a double holds exactly take the short way: one rounding, hence the nearest number
 * (W. D. Clinger, "How to read floating point numbers accurately", 1990). All others go to strtod. */
static const char *parse_short(const char *c, double *value) {
    static const double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const bool negative = *c == '-';
    if (*c == '-' || *c == '+') c++;
    uint64_t digits = 0;
    int count = 0, exponent = 0;
    for (; is_digit(*c); c++, count++) {
        if (count >= 18) return NULL;
        digits = 10 * digits + (uint64_t)(*c - '0');
    }
    if (*c == '.') {
        for (c++; is_digit(*c); c++, count++) {
            if (count >= 18) return NULL;
            digits = 10 * digits + (uint64_t)(*c - '0');
            exponent--;
        }
    }
    if (count == 0) return NULL;
    if (*c == 'e' || *c == 'E') {
        c++;
        const bool down = *c == '-';
        if (*c == '-' || *c == '+') c++;
        int written = 0, written_count = 0;
        for (; is_digit(*c); c++, written_count++) {
            if (written_count >= 4) return NULL;
            written = 10 * written + (*c - '0');
        }
        if (written_count == 0) return NULL;
        exponent += down ? -written : written;
    }
    if (digits > UINT64_C(1) << 53 || exponent < -22 || exponent > 22) return NULL;
    const double magnitude =
        exponent < 0 ? (double)digits / powers[-exponent] : (double)digits * powers[exponent];
    *value = negative ? -magnitude : magnitude;
    return c;
}

const char *bp_decimal_parse(const char *text, double *value) {
    const char *const after = parse_short(text, value);
    if (after != NULL) return after;
    if (*text == ' ' || (*text >= '\t' && *text <= '\r')) return NULL; /* strtod would pass over it */
    char *end = NULL;
    *value = strtod(text, &end);
    return end != text ? end : NULL;
}

/* The text after the letters of an exponent at `text`, which may be omitted; NULL: there is no exponent.
 * *digits: the number of digits that it must have; 0: any. */
static const char *exponent_at(const char *text, bool has_point, size_t *digits) {
    *digits = 0;
    if (*text != '\0' && strchr("dDqQ", *text) != NULL) return text + 1;
    if (text[0] == '*' && text[1] == '^') return text + 2;
    *digits = 3;
    return has_point && (*text == '-' || *text == '+') && text[1] != '0' ? text : NULL;
}

const char *bp_table_number_parse(const char *text, double *value) {
    enum { TEXT_SIZE = 128, DIGITS_MAX = 100 };
    const char *const end = bp_decimal_parse(text, value);
    if (end == NULL || *end == '\0' || *end == ' ' || !(is_digit(end[-1]) || end[-1] == '.')) return end;
    const size_t length = (size_t)(end - text);
    size_t wanted = 0;
    const char *const exponent = exponent_at(end, memchr(text, '.', length) != NULL, &wanted);
    const bool has_exponent = memchr(text, 'e', length) != NULL || memchr(text, 'E', length) != NULL;
    if (exponent == NULL || has_exponent || length > DIGITS_MAX) return end;
    const char *const first = *exponent == '-' || *exponent == '+' ? exponent + 1 : exponent;
    const size_t count = strspn(first, "0123456789");
    if (count == 0 || count > 5 || (wanted > 0 && count != wanted)) return end;
    /* Rewritten with an e, so that the value is rounded like any other. */
    char copy[TEXT_SIZE];
    const size_t rest = (size_t)(first - exponent) + count;
    memcpy(copy, text, length);
    copy[length] = 'e';
    memcpy(copy + length + 1, exponent, rest);
    copy[length + 1 + rest] = '\0';
    return bp_decimal_parse(copy, value) != NULL ? first + count : end;
}

const char *bp_whole_parse(const char *text, int64_t *value) {
    const bool negative = *text == '-';
    const char *c = *text == '-' || *text == '+' ? text + 1 : text;
    int64_t digits = 0;
    if (!is_digit(*c)) return NULL;
    for (; is_digit(*c); c++) {
        if (digits > (INT64_MAX - 9) / 10) return NULL;
        digits = 10 * digits + (*c - '0');
    }
    *value = negative ? -digits : digits;
    return c;
}
