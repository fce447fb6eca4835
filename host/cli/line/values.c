/* values.c: see values.h. */
#include "values.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

BpStatus bp_value_whole(const char *option, const char *text, uint64_t min, uint64_t max, uint64_t *value,
                        BpError *err) {
    const bool hexadecimal = text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
    const char *digits = hexadecimal ? text + 2 : text;
    const char *allowed = hexadecimal ? "0123456789abcdefABCDEF" : "0123456789";
    const bool well_formed = digits[0] != '\0' && digits[strspn(digits, allowed)] == '\0';
    errno = 0;
    const unsigned long long number = well_formed ? strtoull(digits, NULL, hexadecimal ? 16 : 10) : 0;
    if (!well_formed || errno == ERANGE || number < min || number > max)
        return bp_fail(err, BP_ERR_USAGE,
                       "%s: expected a whole number from %" PRIu64 " to %" PRIu64 ", found \"%.80s\"", option,
                       min, max, text);
    *value = number;
    return BP_OK;
}

/* Parses the number at the start of `text`, in C's decimal notation, and sets its end; false: none. */
static bool read_number(const char *text, double *number, const char **end) {
    char digits[64];
    const size_t length = strspn(text, "+-.0123456789eE");
    if (length == 0 || length >= sizeof digits) return false;
    memcpy(digits, text, length);
    digits[length] = '\0';
    char *stop = NULL;
    *number = strtod(digits, &stop);
    *end = text + (stop - digits);
    return stop != digits;
}

BpStatus bp_value_real(const char *option, const char *text, double min, double max, double *value,
                       BpError *err) {
    const char *end = NULL;
    double number = 0;
    if (!read_number(text, &number, &end) || *end != '\0' || !(number > min) || !(number <= max))
        return bp_fail(err, BP_ERR_USAGE, "%s: expected a number above %g, up to %g, found \"%.80s\"", option,
                       min, max, text);
    *value = number;
    return BP_OK;
}

BpStatus bp_value_percent(const char *option, const char *text, double min, double max, double *value,
                          BpError *err) {
    const char *end = NULL;
    double number = 0;
    if (!read_number(text, &number, &end) ||
        (*end != '\0' && strcmp(end, "%") != 0 && strcmp(end, " %") != 0) || !(number > min) ||
        !(number <= max))
        return bp_fail(err, BP_ERR_USAGE,
                       "%s: expected a percentage above %g, up to %g, such as 1%%, found \"%.80s\"", option,
                       min, max, text);
    *value = number;
    return BP_OK;
}

BpStatus bp_value_time(const char *option, const char *text, double min, double max, double *value,
                       BpError *err) {
    static const struct {
        const char *name;
        double seconds;
    } units[] = {{"d", 86400}, {"h", 3600}, {"min", 60}, {"m", 60}, {"s", 1}};
    enum { UNITS = sizeof units / sizeof units[0] };
    double sum = 0, number = 0, last = 1e9;
    const char *end = NULL, *at = text;
    bool good = *at != '\0';
    while (good && *at != '\0') {
        size_t u = 0;
        good = read_number(at, &number, &end) && number >= 0;
        while (good && u < UNITS && strncmp(end, units[u].name, strlen(units[u].name)) != 0) ++u;
        /* A number without a unit must be the whole value: "1h30" could mean minutes or seconds. */
        const bool bare = good && u == UNITS;
        if (bare) good = at == text && *end == '\0';
        const double unit = u < UNITS ? units[u].seconds : 1;
        if (good && !bare) good = unit < last;
        last = unit;
        sum += number * unit;
        if (good) at = end + (u < UNITS ? strlen(units[u].name) : 0);
    }
    if (!good || !(sum > min) || !(sum <= max))
        return bp_fail(err, BP_ERR_USAGE,
                       "%s: expected a time above %g, up to %g seconds, such as 90, 90s, 2m or 1h30m, found "
                       "\"%.80s\"",
                       option, min, max, text);
    *value = sum;
    return BP_OK;
}

BpStatus bp_value_choice(const char *option, const char *text, const char *const *words, size_t count,
                         unsigned *index, BpError *err) {
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(text, words[i]) == 0) {
            *index = (unsigned)i;
            return BP_OK;
        }
    }
    char list[256] = "";
    for (size_t i = 0, used = 0; i < count && used < sizeof list; ++i)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s",
                                 i == 0 ? "" : (i + 1 == count ? " or " : ", "), words[i]);
    return bp_fail(err, BP_ERR_USAGE, "%s: expected %s, found \"%.80s\"", option, list, text);
}

/* Splits the text at `mark` into two numbers. */
static BpStatus cut(const char *option, const char *text, char mark, const char *expected, char first[32],
                    const char **second, BpError *err) {
    const char *at = strchr(text, mark);
    if (at == NULL || at - text >= 32)
        return bp_fail(err, BP_ERR_USAGE, "%s: expected %s, found \"%.80s\"", option, expected, text);
    memcpy(first, text, (size_t)(at - text));
    first[at - text] = '\0';
    *second = at + 1;
    return BP_OK;
}

BpStatus bp_value_pair(const char *option, const char *text, uint64_t max, uint32_t *x, uint32_t *y,
                       BpError *err) {
    char first[32];
    const char *second = NULL;
    uint64_t numbers[2];
    BP_TRY(cut(option, text, ',', "two whole numbers X,Y", first, &second, err));
    BP_TRY(bp_value_whole(option, first, 0, max, &numbers[0], err));
    BP_TRY(bp_value_whole(option, second, 0, max, &numbers[1], err));
    *x = (uint32_t)numbers[0];
    *y = (uint32_t)numbers[1];
    return BP_OK;
}

BpStatus bp_value_signed(const char *option, const char *text, int64_t *value, BpError *err) {
    const size_t sign = text[0] == '-';
    const size_t digits = strspn(text + sign, "0123456789");
    if (digits == 0 || digits > 15 || text[sign + digits] != '\0')
        return bp_fail(err, BP_ERR_USAGE,
                       "%s: expected a whole number (0: the first, -1: the last), found \"%.80s\"", option,
                       text);
    *value = strtoll(text, NULL, 10);
    return BP_OK;
}

BpStatus bp_value_slice(const char *option, const char *text, int64_t *first, int64_t *last, uint64_t *step,
                        BpError *err) {
    char part[3][24] = {"", "", ""};
    int count = 0;
    bool good = strchr(text, ':') != NULL;
    for (const char *c = text; good; count++) {
        const size_t length = strcspn(c, ":");
        good = count < 3 && length < sizeof part[0];
        if (good) memcpy(part[count], c, length);
        if (good && c[length] == '\0') break;
        c += length + 1;
    }
    *first = 0;
    *last = INT64_MAX;
    *step = 1;
    if (good && part[0][0] != '\0') good = bp_value_signed(option, part[0], first, NULL) == BP_OK;
    if (good && part[1][0] != '\0') good = bp_value_signed(option, part[1], last, NULL) == BP_OK;
    if (good && part[2][0] != '\0')
        good = bp_value_whole(option, part[2], 1, 1000000000, step, NULL) == BP_OK;
    if (good) return BP_OK;
    return bp_fail(err, BP_ERR_USAGE,
                   "%s: expected A:B:S, such as 0:100:10 (from frame 0 up to 99, every 10th) or :: (all), "
                   "found \"%.80s\"",
                   option, text);
}

BpStatus bp_value_share(const char *option, const char *text, uint32_t *number, uint32_t *count,
                        BpError *err) {
    char first[32];
    const char *second = NULL;
    uint64_t numbers[2];
    BP_TRY(cut(option, text, '/', "I/N, as in 1/8 to 8/8", first, &second, err));
    BP_TRY(bp_value_whole(option, second, 1, BP_SHARES_MAX, &numbers[1], err));
    BP_TRY(bp_value_whole(option, first, 0, BP_SHARES_MAX, &numbers[0], err));
    if (numbers[0] < 1 || numbers[0] > numbers[1])
        return bp_fail(err, BP_ERR_USAGE,
                       "%s %.80s: shares are numbered from 1/%" PRIu64 " to %" PRIu64 "/%" PRIu64, option,
                       text, numbers[1], numbers[1], numbers[1]);
    *number = (uint32_t)numbers[0];
    *count = (uint32_t)numbers[1];
    return BP_OK;
}
