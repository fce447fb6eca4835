/* distributions.h: what tests and studies need of statistics beyond what verdicts stand on.
 *
 * In and out: numbers.   Knows: probability.   Does not know: what is tested.
 *
 * "upper" means P(X > x). Results hold about 1e-12 relative unless it says otherwise
 * (tests/agree/test_statistics.c holds them against published tables). Formulas from the Digital Library of
 * Mathematical Functions, by their numbers. */
#ifndef TESTS_SUPPORT_DISTRIBUTIONS_H
#define TESTS_SUPPORT_DISTRIBUTIONS_H

#include "check/statistics.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

/* Regularised upper incomplete gamma Q(a, x): series 8.7.1 below a + 1, continued fraction 8.9.2 above. */
static inline double gamma_upper(double a, double x) {
    if (x <= 0) return 1;
    const double front = exp(a * log(x) - x - lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (double k = a + 1; term > sum * DBL_EPSILON; ++k) sum += term *= x / k;
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1 / DBL_MIN, d = 1 / b, fraction = d;
    for (int i = 1; i < 100000; ++i) { /* Lentz's method */
        const double an = -i * (i - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        fraction *= c * d;
        if (fabs(c * d - 1) < DBL_EPSILON) break;
    }
    return front * fraction;
}

/* Of chi-square with `degrees` > 0. */
static inline double chi_square_upper(double x, double degrees) {
    return gamma_upper(0.5 * degrees, 0.5 * x);
}

static inline double chi_square_upper_quantile(double p, double degrees) {
    return bp_invert_falling(chi_square_upper, degrees, p, 0, degrees + 100 * sqrt(degrees) + 3000);
}

/* Of Student's t. */
static inline double student_upper(double t, double degrees) {
    const double tail = 0.5 * bp_beta_lower(0.5 * degrees, 0.5, degrees / (degrees + t * t));
    return t >= 0 ? tail : 1 - tail;
}

static inline double student_upper_quantile(double p, double degrees) {
    if (p > 0.5) return -student_upper_quantile(1 - p, degrees);
    return bp_invert_falling(student_upper, degrees, p, 0, 1e12);
}

/* Pearson's chi-square: p-value of counts against expected[] (same total). Neighbouring bins are pooled until
 * at least 5 are expected. `degrees`: Optional, the degrees of freedom used. 1 when fewer than two bins are
 * left. */
static inline double chi_square_test(const double *observed, const double *expected, size_t bins,
                                     size_t *degrees) {
    double statistic = 0, seen = 0, due = 0;
    double last_seen = 0, last_due = 0; /* the latest full group, kept back in case the end is too thin */
    size_t groups = 0;
    for (size_t i = 0; i < bins; ++i) {
        seen += observed[i];
        due += expected[i];
        if (due < 5) continue;
        if (groups > 0) statistic += (last_seen - last_due) * (last_seen - last_due) / last_due;
        last_seen = seen;
        last_due = due;
        seen = due = 0;
        ++groups;
    }
    last_seen += seen;
    last_due += due;
    if (degrees != NULL) *degrees = groups > 0 ? groups - 1 : 0;
    if (groups < 2) return 1;
    statistic += (last_seen - last_due) * (last_seen - last_due) / last_due;
    return chi_square_upper(statistic, (double)(groups - 1));
}

/* P(K > x) of the limiting distribution. */
static inline double kolmogorov_upper(double x) {
    if (x <= 0) return 1;
    const double pi = 3.14159265358979323846;
    double sum = 0;
    if (x < 1) { /* the theta function's other series converges at once here */
        for (int k = 1; k <= 20; ++k) {
            const double odd = (2 * k - 1) * pi / x;
            sum += exp(-odd * odd / 8);
        }
        return 1 - sqrt(2 * pi) / x * sum;
    }
    for (int k = 1; k <= 20; ++k) sum += (k % 2 ? 2 : -2) * exp(-2.0 * k * k * x * x);
    return sum;
}

/* Kolmogorov and Smirnov: p-value of `count` values, sorted, each already mapped by the distribution function
 * it should follow, so uniform on [0, 1] (Stephens 1970; good to 1e-2 of p for count >= 20). */
static inline double kolmogorov_test(const double *sorted, size_t count) {
    const double n = (double)count;
    double distance = 0;
    for (size_t i = 0; i < count; ++i) {
        distance = fmax(distance, (double)(i + 1) / n - sorted[i]);
        distance = fmax(distance, sorted[i] - (double)i / n);
    }
    return kolmogorov_upper((sqrt(n) + 0.12 + 0.11 / sqrt(n)) * distance);
}

#endif
