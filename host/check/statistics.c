/* statistics.c: see statistics.h. Formulas from the Digital Library of Mathematical Functions, by their
 * numbers. */
#include "statistics.h"

#include <float.h>
#include <math.h>

static const double root_half = 0.70710678118654752440;

double bp_normal_upper(double z) {
    return 0.5 * erfc(z * root_half);
}

/* x in [low, high] where the falling function upper(x, degrees) crosses p; as close as doubles go. */
static double invert_falling(double (*upper)(double, double), double degrees, double p, double low,
                             double high) {
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
    return invert_falling(normal_upper_of, 0, p, 0, 40);
}

/* Regularised upper incomplete gamma Q(a, x): series 8.7.1 below a + 1, continued fraction 8.9.2 above. */
static double gamma_upper(double a, double x) {
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

double bp_chi_square_upper(double x, double degrees) {
    return gamma_upper(0.5 * degrees, 0.5 * x);
}

double bp_chi_square_upper_quantile(double p, double degrees) {
    return invert_falling(bp_chi_square_upper, degrees, p, 0, degrees + 100 * sqrt(degrees) + 3000);
}

/* Regularised incomplete beta I_x(a, b): continued fraction 8.17.22, on the side where it converges fast. */
static double beta_lower(double a, double b, double x) {
    if (x <= 0) return 0;
    if (x >= 1) return 1;
    if (x > (a + 1) / (a + b + 2)) return 1 - beta_lower(b, a, 1 - x);
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

double bp_student_upper(double t, double degrees) {
    const double tail = 0.5 * beta_lower(0.5 * degrees, 0.5, degrees / (degrees + t * t));
    return t >= 0 ? tail : 1 - tail;
}

double bp_student_upper_quantile(double p, double degrees) {
    if (p > 0.5) return -bp_student_upper_quantile(1 - p, degrees);
    return invert_falling(bp_student_upper, degrees, p, 0, 1e12);
}

double bp_binomial_at_least(uint64_t k, uint64_t n, double p) {
    if (k == 0) return 1;
    if (k > n) return 0;
    return beta_lower((double)k, (double)(n - k) + 1, p);
}

double bp_binomial_at_most(uint64_t k, uint64_t n, double p) {
    if (k >= n) return 1;
    return beta_lower((double)(n - k), (double)k + 1, 1 - p);
}

double bp_binomial_two_sided(uint64_t k, uint64_t n, double p) {
    return fmin(1, 2 * fmin(bp_binomial_at_most(k, n, p), bp_binomial_at_least(k, n, p)));
}

double bp_level_sidak(double alpha, uint64_t tests) {
    return -expm1(log1p(-alpha) / (double)tests);
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

bool bp_equivalent(double difference, double standard_error, double margin, double alpha) {
    const double reach = bp_normal_upper_quantile(alpha) * standard_error;
    return difference - reach > -margin && difference + reach < margin;
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

double bp_chi_square_test(const double *observed, const double *expected, size_t bins, size_t *degrees) {
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
    return bp_chi_square_upper(statistic, (double)(groups - 1));
}

double bp_kolmogorov_upper(double x) {
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

double bp_kolmogorov_test(const double *sorted, size_t count) {
    const double n = (double)count;
    double distance = 0;
    for (size_t i = 0; i < count; ++i) {
        distance = fmax(distance, (double)(i + 1) / n - sorted[i]);
        distance = fmax(distance, sorted[i] - (double)i / n);
    }
    return bp_kolmogorov_upper((sqrt(n) + 0.12 + 0.11 / sqrt(n)) * distance);
}
