/* statistics.c: see statistics.h. Formulas from the Digital Library of Mathematical Functions, by their
 * numbers. */
#include "statistics.h"

#include <float.h>
#include <math.h>

static const double root_half = 0.70710678118654752440;

double bp_normal_upper(double z) {
    return 0.5 * erfc(z * root_half);
}

double bp_invert_falling(double (*upper)(double, double), double degrees, double p, double low, double high) {
    for (int i = 0; i < 2000; ++i) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) break;
        if (upper(middle, degrees) > p)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

static double normal_upper_of(double z, double unused) {
    (void)unused;
    return bp_normal_upper(z);
}

double bp_normal_upper_quantile(double p) {
    /* Above 1/2 the tail's digits are in 1 - p. */
    if (p > 0.5) return -bp_normal_upper_quantile(1 - p);
    return bp_invert_falling(normal_upper_of, 0, p, 0, 40);
}

/* Continued fraction 8.17.22, on the side where it converges fast. */
double bp_beta_lower(double a, double b, double x) {
    if (x <= 0) return 0;
    if (x >= 1) return 1;
    if (x > (a + 1) / (a + b + 2)) return 1 - bp_beta_lower(b, a, 1 - x);
    const double front = exp(a * log(x) + b * log1p(-x) + lgamma(a + b) - lgamma(a) - lgamma(b)) / a;
    double c = 1, d = 1 / (1 - (a + b) * x / (a + 1)), fraction = d;
    for (int m = 1; m < 100000; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1 / (1 + even * d);
        c = 1 + even / c;
        fraction *= c * d;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / (1 + odd * d);
        c = 1 + odd / c;
        fraction *= c * d;
        if (fabs(c * d - 1) < DBL_EPSILON) break;
    }
    return front * fraction;
}

double bp_binomial_at_least(uint64_t k, uint64_t n, double p) {
    if (k == 0) return 1;
    if (k > n) return 0;
    return bp_beta_lower((double)k, (double)(n - k) + 1, p);
}

double bp_binomial_at_most(uint64_t k, uint64_t n, double p) {
    if (k >= n) return 1;
    return bp_beta_lower((double)(n - k), (double)k + 1, 1 - p);
}

double bp_binomial_two_sided(uint64_t k, uint64_t n, double p) {
    return fmin(1, 2 * fmin(bp_binomial_at_most(k, n, p), bp_binomial_at_least(k, n, p)));
}

double bp_level_bonferroni(double alpha, uint64_t tests) {
    return alpha / (double)tests;
}

double bp_z_power(double shift, double z_limit) {
    return bp_normal_upper(z_limit - shift) + bp_normal_upper(z_limit + shift);
}

double bp_z_detectable(double z_limit, double power) {
    double low = 0, high = z_limit + 40;
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        if (bp_z_power(middle, z_limit) < power)
            low = middle;
        else
            high = middle;
    }
    return high;
}

bool bp_ratio_interval(double a, double variance_a, double b, double variance_b, double z, double *low,
                       double *high) {
    /* The ratios q with (a - q b)^2 <= z^2 (variance_a + q^2 variance_b). */
    const double square = b * b - z * z * variance_b;
    if (!(b > 0) || !(square > 0)) return false;
    const double middle = a * b / square;
    const double rest = middle * middle - (a * a - z * z * variance_a) / square;
    const double half = sqrt(fmax(0, rest));
    *low = middle - half;
    *high = middle + half;
    return true;
}
