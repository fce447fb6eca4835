/* statistics.h: the distributions and tests that a verdict stands on.
 *
 * In and out: numbers.   Knows: probability.   Does not know: pictures, scenes.
 *
 * Probabilities are in [0, 1]; "upper" means P(X > x). Every function is pure; results hold about 1e-12
 * relative unless a comment states otherwise (tests/agree/test_statistics.c holds them against published
 * tables). */
#ifndef BP_CHECK_STATISTICS_H
#define BP_CHECK_STATISTICS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* P(Z > z) of the standard normal distribution, and its inverse for p in (0, 1). */
double bp_normal_upper(double z);
double bp_normal_upper_quantile(double p);

/* P(X > x) for chi-square with `degrees` > 0. */
double bp_chi_square_upper(double x, double degrees);
/* x with P(X > x) = p. */
double bp_chi_square_upper_quantile(double p, double degrees);

/* P(T > t) for Student's t, and its inverse. */
double bp_student_upper(double t, double degrees);
double bp_student_upper_quantile(double p, double degrees);

/* P(X <= k) and P(X >= k) for n trials of probability p. Exact. */
double bp_binomial_at_most(uint64_t k, uint64_t n, double p);
double bp_binomial_at_least(uint64_t k, uint64_t n, double p);
/* Two-sided p-value: twice the smaller tail, at most 1. */
double bp_binomial_two_sided(uint64_t k, uint64_t n, double p);

/* The level of each of `tests` tests so that all together reject wrongly with probability `alpha`:
 * independent tests (Sidak 1967), and any tests whatever (Bonferroni). */
double bp_level_sidak(double alpha, uint64_t tests);
double bp_level_bonferroni(double alpha, uint64_t tests);

/* Probability that a two-sided z test with limit `z_limit` rejects when the truth lies `shift` standard
 * errors away. */
double bp_z_power(double shift, double z_limit);
/* The shift, in standard errors, that is found with probability `power`. */
double bp_z_detectable(double z_limit, double power);

/* Two one-sided tests (Schuirmann 1987): is |difference| < margin shown, each side at `alpha`? */
bool bp_equivalent(double difference, double standard_error, double margin, double alpha);

/* Interval of a / b for independent means with variances `variance_a`, `variance_b` (Fieller 1954), at `z`
 * standard errors each side. False when b is not clearly above 0 and no bounded interval exists. */
bool bp_ratio_interval(double a, double variance_a, double b, double variance_b, double z, double *low,
                       double *high);

/* Pearson's chi-square: p-value of counts against expected[] (same total). Neighbouring bins are pooled until
 * at least 5 are expected. `degrees`: Optional, the degrees of freedom used. 1 when fewer than two bins are
 * left. */
double bp_chi_square_test(const double *observed, const double *expected, size_t bins, size_t *degrees);

/* Kolmogorov and Smirnov: p-value of `count` values, sorted, each already mapped by the distribution function
 * it should follow, so uniform on [0, 1] (Stephens 1970; good to 1e-2 of p for count >= 20). */
double bp_kolmogorov_test(const double *sorted, size_t count);
/* P(K > x) of the limiting distribution. */
double bp_kolmogorov_upper(double x);

#endif
