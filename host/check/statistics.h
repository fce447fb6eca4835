/* statistics.h: the distributions and tests behind a verdict.
 *
 * In and out: numbers.
 * Knows: probability.   Does not know: pictures, scenes.
 *
 * Probabilities are in [0, 1]; "upper" means P(X > x). Every function is pure; results are accurate to about
 * 1e-12 relative unless a comment states otherwise (tests/agree/test_statistics.c compares them with
 * published tables). */
#ifndef BP_CHECK_STATISTICS_H
#define BP_CHECK_STATISTICS_H

#include <stdbool.h>
#include <stdint.h>

/* P(Z > z) of the standard normal distribution, and its inverse for p in (0, 1). */
double bp_normal_upper(double z);
double bp_normal_upper_quantile(double p);

/* The regularised incomplete beta function I_x(a, b). */
double bp_beta_lower(double a, double b, double x);
/* x in [low, high] where the decreasing function upper(x, degrees) crosses p, to the accuracy of doubles. */
double bp_invert_falling(double (*upper)(double, double), double degrees, double p, double low, double high);

/* P(X <= k) and P(X >= k) for n trials of probability p. Exact. */
double bp_binomial_at_most(uint64_t k, uint64_t n, double p);
double bp_binomial_at_least(uint64_t k, uint64_t n, double p);
/* Two-sided p-value: twice the smaller tail, at most 1. */
double bp_binomial_two_sided(uint64_t k, uint64_t n, double p);

/* The level of each of `tests` tests, dependent or not, so that all together reject wrongly with probability
 * `alpha` at most (Bonferroni). */
double bp_level_bonferroni(double alpha, uint64_t tests);

/* Probability that a two-sided z test with limit `z_limit` rejects when the truth lies `shift` standard
 * errors away. */
double bp_z_power(double shift, double z_limit);
/* The shift, in standard errors, that is found with probability `power`. */
double bp_z_detectable(double z_limit, double power);

/* Interval of a / b for independent means with variances `variance_a`, `variance_b` (Fieller 1954), at `z`
 * standard errors each side. False if b is not significantly above 0, so that no bounded interval exists. */
bool bp_ratio_interval(double a, double variance_a, double b, double variance_b, double z, double *low,
                       double *high);

#endif
