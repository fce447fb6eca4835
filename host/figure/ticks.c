/* ticks.c: see ticks.h. */
#include "ticks.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define MINUS "\xe2\x88\x92" /* U+2212 */
#define TIMES "\xc3\x97"     /* U+00D7 */

/* How the numbers of a scale are written. */
typedef struct Style {
    int decimals, exponent;
    bool has_power;
} Style;

/* The decimal exponent of a positive number; `slack` takes 0.9999... for 1. */
static int exponent_of(double value, double slack) {
    return (int)floor(log10(value) + slack);
}

/* For multiples of `step`, none of them farther from 0 than `largest`. */
static Style choose_style(double step, double largest) {
    Style style = {.decimals = 0};
    const int least = exponent_of(fmax(step, 1e-300), 1e-9),
              most = largest > 0 ? exponent_of(largest, 1e-9) : 0;
    style.has_power = most >= 5 || most < -3;
    style.exponent = style.has_power ? most : 0;
    style.decimals = style.exponent > least ? style.exponent - least : 0;
    return style;
}

static char *put(char *at, const char *text) {
    const size_t length = strlen(text);
    memcpy(at, text, length + 1);
    return at + length;
}

static void write_label(double value, const Style *style, char label[BP_TICK_LABEL_SIZE]) {
    static const char *const raised[] = {"\xe2\x81\xb0", "\xc2\xb9",     "\xc2\xb2",     "\xc2\xb3",
                                         "\xe2\x81\xb4", "\xe2\x81\xb5", "\xe2\x81\xb6", "\xe2\x81\xb7",
                                         "\xe2\x81\xb8", "\xe2\x81\xb9"};
    char digits[32], power[16];
    /* In two steps, since 10^308 and more is not a number. */
    const double half = pow(10, style->exponent / 2);
    const double scaled = fabs(value) / half / pow(10, style->exponent - style->exponent / 2);
    snprintf(digits, sizeof digits, "%.*f", style->decimals, scaled);
    const bool is_zero = strspn(digits, "0.") == strlen(digits);
    label = put(label, value < 0 && !is_zero ? MINUS : "");
    if (is_zero && style->has_power) {
        put(label, "0");
        return;
    }
    label = put(label, digits);
    if (!style->has_power) return;
    label = put(label, TIMES "10");
    if (style->exponent < 0) label = put(label, "\xe2\x81\xbb"); /* a raised minus */
    snprintf(power, sizeof power, "%d", style->exponent < 0 ? -style->exponent : style->exponent);
    for (const char *digit = power; *digit != '\0'; digit++) label = put(label, raised[*digit - '0']);
}

/* Exact for as many decimals as a double holds: 3 * 0.1 would not be 0.3. */
static double multiple(double k, int mantissa, int exponent) {
    return exponent < 0 ? k * mantissa / pow(10, -exponent) : k * mantissa * pow(10, exponent);
}

/* The multiples within the range; NULL for `ticks`: only their number. */
static size_t put_multiples(const double range[2], int mantissa, int exponent, BpTick *ticks) {
    const double width = range[1] - range[0], step = multiple(1, mantissa, exponent);
    const double first = ceil(range[0] / step - 1e-9), last = floor(range[1] / step + 1e-9);
    if (ticks == NULL) return last < first ? 0 : (size_t)(last - first) + 1;
    const Style style = choose_style(step, fmax(fabs(first), fabs(last)) * step);
    size_t count = 0;
    for (double k = first; k <= last; k++, count++) {
        const double value = multiple(k, mantissa, exponent);
        ticks[count].share = fmin(1, fmax(0, (value - range[0]) / width));
        write_label(value, &style, ticks[count].label);
    }
    return count;
}

static size_t put_ends(const double range[2], double step, BpTick *ticks) {
    const Style style = choose_style(step, fmax(fabs(range[0]), fabs(range[1])));
    for (int end = 0; end < 2; end++) {
        ticks[end].share = end;
        write_label(range[end], &style, ticks[end].label);
    }
    return 2;
}

size_t bp_ticks_choose(const double range[2], double apart, BpTick ticks[BP_TICKS_MAX]) {
    static const int mantissas[] = {1, 2, 5};
    const double width = range[1] - range[0], largest = fmax(fabs(range[0]), fabs(range[1]));
    /* Below that width, multiples of the step are no longer told apart. */
    if (!(width > 1e-9 * largest)) {
        const double step = largest > 0 ? pow(10, exponent_of(largest, 1e-9) - 3) : 1;
        const Style style = choose_style(step, largest);
        ticks[0].share = 0.5;
        write_label(range[0], &style, ticks[0].label);
        return 1;
    }
    if (!isfinite(width) || width < 1e-290) return put_ends(range, 0.01 * largest, ticks);
    /* From a step that is too fine on, the first that is not. */
    int exponent = exponent_of(width, 0) - 2, mantissa = 0;
    while (put_multiples(range, mantissas[mantissa], exponent, NULL) > BP_TICKS_MAX ||
           multiple(1, mantissas[mantissa], exponent) < apart * width) {
        mantissa = (mantissa + 1) % 3;
        exponent += mantissa == 0;
    }
    if (put_multiples(range, mantissas[mantissa], exponent, NULL) >= 2)
        return put_multiples(range, mantissas[mantissa], exponent, ticks);
    return put_ends(range, pow(10, exponent_of(width, 0) - 1), ticks);
}
