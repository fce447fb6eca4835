/* format.c: see format.h. */
#include "format.h"

#include <math.h>
#include <stdio.h>

/* Decimals that show `digits` digits of x. */
static int decimals(double x, int digits, int most) {
    if (!(fabs(x) > 0)) return 0;
    const int after = digits - 1 - (int)floor(log10(fabs(x)));
    return after < 0 ? 0 : after > most ? most : after;
}

const char *bp_study_percent(double fraction, char *text, size_t size) {
    const double p = 100 * fraction;
    if (isnan(p))
        snprintf(text, size, "-");
    else
        snprintf(text, size, "%.*f %%", decimals(p, fabs(p) < 0.0995 ? 2 : 3, 7), p);
    return text;
}

const char *bp_study_interval(const BpStudyEstimate *estimate, const char *plus_minus, const char *minus,
                              char *text, size_t size) {
    const char *sign = estimate->value < 0 ? minus : "+";
    const double value = 100 * fabs(estimate->value), half = 50 * (estimate->high - estimate->low);
    if (isnan(value)) {
        snprintf(text, size, "-");
    } else if (!(half > 0) && !(value > 0)) {
        snprintf(text, size, "none");
    } else if (value < 5e-7 && half < 5e-7) {
        snprintf(text, size, "under 0.000001 %%");
    } else if (!(half > 0)) {
        snprintf(text, size, "%s%.*f %%", sign, decimals(value, 2, 7), value);
    } else {
        const int after = decimals(half, 1, 7);
        snprintf(text, size, "%s%.*f %s %.*f %%", sign, after, value, plus_minus, after, half);
    }
    return text;
}

const char *bp_study_seconds(double seconds, char *text, size_t size) {
    if (!isfinite(seconds))
        snprintf(text, size, "-");
    else if (seconds < 0.9995)
        snprintf(text, size, "%.*f ms", decimals(1000 * seconds, 2, 3), 1000 * seconds);
    else if (seconds < 99.5)
        snprintf(text, size, "%.*f s", decimals(seconds, 2, 1), seconds);
    else if (seconds < 5999.5)
        snprintf(text, size, "%ld min %02ld s", lround(seconds) / 60, lround(seconds) % 60);
    else
        snprintf(text, size, "%.*f h", decimals(seconds / 3600, 2, 1), seconds / 3600);
    return text;
}

const char *bp_study_ratio(double ratio, char *text, size_t size) {
    if (!isfinite(ratio))
        snprintf(text, size, "-");
    else
        snprintf(text, size, "%.*f", decimals(ratio, 3, 4), ratio);
    return text;
}
