/* format.c: see format.h. */
#include "format.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Decimals that show `digits` digits of x. */
static int decimals(double x, int digits, int most) {
    if (!(fabs(x) > 0)) return 0;
    const int after = digits - 1 - (int)floor(log10(fabs(x)));
    return after < 0 ? 0 : after > most ? most : after;
}

const char *bp_format_percent(double fraction, char *text, size_t size) {
    const double percent = 100.0 * fraction;
    if (!isfinite(percent))
        snprintf(text, size, "unknown");
    else
        snprintf(text, size, percent >= 9.95 ? "%.0f %%" : percent >= 0.995 ? "%.1f %%" : "%.2g %%", percent);
    return text;
}

const char *bp_format_percent_cell(double fraction, char *text, size_t size) {
    const double p = 100 * fraction;
    if (isnan(p))
        snprintf(text, size, "-");
    else
        snprintf(text, size, "%.*f %%", decimals(p, fabs(p) < 0.0995 ? 2 : 3, 7), p);
    return text;
}

const char *bp_format_interval(double value, double low, double high, char *text, size_t size) {
    const char *sign = value < 0 ? "-" : "+";
    const double percent = 100 * fabs(value), half = 50 * (high - low);
    if (isnan(value)) {
        snprintf(text, size, "-");
    } else if (!(half > 0) && !(percent > 0)) {
        snprintf(text, size, "none");
    } else if (percent < 5e-7 && half < 5e-7) {
        snprintf(text, size, "under 0.000001 %%");
    } else if (!(half > 0)) {
        snprintf(text, size, "%s%.*f %%", sign, decimals(percent, 2, 7), percent);
    } else {
        const int after = decimals(half, 1, 7);
        snprintf(text, size, "%s%.*f +- %.*f %%", sign, after, percent, after, half);
    }
    return text;
}

const char *bp_format_ratio(double ratio, char *text, size_t size) {
    if (!isfinite(ratio))
        snprintf(text, size, "-");
    else
        snprintf(text, size, "%.*f", decimals(ratio, 3, 4), ratio);
    return text;
}

const char *bp_format_seconds(double seconds, char *text, size_t size) {
    if (isnan(seconds)) {
        snprintf(text, size, "an unknown time");
    } else if (!(seconds < 1.0e9)) {
        snprintf(text, size, "more than 30 years");
    } else if (seconds > 0.0 && seconds < 0.0995) {
        snprintf(text, size, seconds < 0.00995 ? "%.2g ms" : "%.0f ms", 1000.0 * seconds);
    } else if (seconds < 9.95) {
        snprintf(text, size,
                 seconds == floor(seconds) ? "%.0f s"
                 : seconds < 0.995         ? "%.2f s"
                                           : "%.1f s",
                 seconds);
    } else if (seconds < 99.5) {
        snprintf(text, size, "%.0f s", seconds);
    } else {
        const long whole = lround(seconds);
        if (whole < 6000)
            snprintf(text, size, "%ld min %02ld s", whole / 60, whole % 60);
        else if (whole < 100L * 3600)
            snprintf(text, size, "%ld h %02ld min", whole / 3600, whole / 60 % 60);
        else
            snprintf(text, size, "%ld days", (whole + 43200) / 86400);
    }
    return text;
}

const char *bp_format_count(double count, char *text, size_t size) {
    static const char *const words[] = {"", " thousand", " million", " billion", " trillion"};
    size_t word = 0;
    while (count >= 999.5 && word + 1 < sizeof words / sizeof words[0]) {
        count /= 1000.0;
        ++word;
    }
    const int decimals = word == 0 || count >= 99.95 ? 0 : count >= 9.995 ? 1 : 2;
    snprintf(text, size, "%.*f%s", decimals, count, words[word]);
    return text;
}

const char *bp_format_whole(uint64_t number, char *text, size_t size) {
    char digits[24];
    const size_t length = (size_t)snprintf(digits, sizeof digits, "%" PRIu64, number);
    size_t used = 0;
    for (size_t i = 0; i < length && used + 2 < size; ++i) {
        if (i > 0 && (length - i) % 3 == 0) text[used++] = ',';
        text[used++] = digits[i];
    }
    text[used] = '\0';
    return text;
}
