/* test_statistics.c: the distributions against published tables. */
#include "support/distributions.h"
#include "support/unit_test.h"

#include <math.h>

static void assert_close(double value, double expected, double relative) {
    if (!(fabs(value - expected) <= relative * fabs(expected)))
        fail_msg("got %.15g, expected %.15g", value, expected);
}

/* Abramowitz and Stegun (1964), tables 26.1, 26.2, 26.6. */
static void normal(void **state) {
    (void)state;
    assert_close(bp_normal_upper(0), 0.5, 1e-15);
    assert_close(bp_normal_upper(1), 0.15865525393145705, 1e-14);
    assert_close(bp_normal_upper(5), 2.866515718791939e-7, 1e-12);
    assert_close(bp_normal_upper(-2), 0.9772498680518208, 1e-14);
    assert_close(bp_normal_upper_quantile(0.025), 1.959963984540054, 1e-14);
    assert_close(bp_normal_upper_quantile(0.1), 1.2815515655446004, 1e-14);
    assert_close(bp_normal_upper_quantile(0.9), -1.2815515655446004, 1e-13);
    assert_close(bp_normal_upper_quantile(1e-9), 5.997807015007686, 1e-12);
    assert_true(fabs(bp_normal_upper_quantile(0.5)) < 1e-12);
}

static void chi_square(void **state) {
    (void)state;
    assert_close(chi_square_upper_quantile(0.05, 1), 3.841458820694124, 1e-12);
    assert_close(chi_square_upper_quantile(0.05, 10), 18.307038053275146, 1e-12);
    assert_close(chi_square_upper_quantile(0.99, 10), 2.558212160185869, 1e-11);
    assert_close(chi_square_upper_quantile(0.001, 100), 149.449, 1e-5);
    assert_close(chi_square_upper(2, 2), exp(-1), 1e-14); /* two degrees: exp(-x/2) */
    assert_close(chi_square_upper(60, 2), exp(-30), 1e-12);
}

static void student(void **state) {
    (void)state;
    assert_close(student_upper_quantile(0.025, 1), 12.706204736432095, 1e-10);
    assert_close(student_upper_quantile(0.025, 3), 3.182446305284263, 1e-11);
    assert_close(student_upper_quantile(0.005, 10), 3.169272672616874, 1e-11);
    assert_close(student_upper_quantile(0.025, 1e5), 1.959987708, 1e-8);
    assert_close(student_upper(1, 1), 0.25, 1e-13);
    assert_close(student_upper(-1, 1), 0.75, 1e-13);
}

static void binomial(void **state) {
    (void)state;
    assert_close(bp_binomial_at_most(5, 10, 0.5), 638.0 / 1024, 1e-13);
    assert_close(bp_binomial_at_least(9, 10, 0.5), 11.0 / 1024, 1e-13);
    assert_close(bp_binomial_at_least(10, 10, 0.3), pow(0.3, 10), 1e-12);
    assert_close(bp_binomial_at_most(0, 20, 0.1), pow(0.9, 20), 1e-12);
    assert_close(bp_binomial_at_most(20, 20, 0.1), 1, 0);
    assert_close(bp_binomial_at_least(0, 20, 0.1), 1, 0);
    assert_close(bp_binomial_two_sided(5, 10, 0.5), 1, 0);
    /* The control's acceptance: 200 runs at 0.05, rejected 2 to 21 times. */
    const double outside = bp_binomial_at_most(1, 200, 0.05) + bp_binomial_at_least(22, 200, 0.05);
    assert_true(outside < 2e-3 && outside > 1e-4);
    /* A sum term by term, as a check of the incomplete beta function in the middle range. */
    double sum = 0, term = pow(0.63, 50);
    for (int k = 0; k <= 17; ++k) {
        sum += term;
        term *= (50.0 - k) / (k + 1.0) * 0.37 / 0.63;
    }
    assert_close(bp_binomial_at_most(17, 50, 0.37), sum, 1e-11);
}

static void levels(void **state) {
    (void)state;
    assert_close(bp_level_bonferroni(0.05, 10), 0.005, 1e-15);
    /* The image test's limits: 2.5e-5 over 3 means, and over 3 x 64 blocks. */
    assert_close(bp_normal_upper_quantile(bp_level_bonferroni(2.5e-5, 3) / 2), 4.457, 1e-3);
    assert_close(bp_normal_upper_quantile(bp_level_bonferroni(2.5e-5, 192) / 2), 5.278, 1e-3);
}

static void power(void **state) {
    (void)state;
    assert_close(bp_z_power(0, 1.959963984540054), 0.05, 1e-12);
    assert_close(bp_z_power(1.959963984540054, 1.959963984540054), 0.5, 1e-4);
    /* Cohen (1988): two-sided 5 % with power 0.8 needs 2.80, with 0.9 3.24 standard errors. */
    assert_close(bp_z_detectable(1.959963984540054, 0.8), 2.8016, 1e-4);
    assert_close(bp_z_detectable(1.959963984540054, 0.9), 3.2415, 1e-4);
}

static void ratio(void **state) {
    (void)state;
    double low, high;
    assert_true(bp_ratio_interval(2, 0.0001, 4, 0, 2, &low, &high)); /* b known: (a -+ 2 sigma) / b */
    assert_close(low, (2 - 0.02) / 4, 1e-12);
    assert_close(high, (2 + 0.02) / 4, 1e-12);
    assert_true(bp_ratio_interval(1, 1e-4, 1, 1e-4, 1.96, &low, &high));
    assert_close(low * high, 1, 1e-9); /* symmetric in a and b, so its ends are each other's reciprocal */
    assert_true(low < 1 && high > 1);
    assert_false(bp_ratio_interval(1, 1e-4, 0.01, 1, 1.96, &low, &high));
    assert_false(bp_ratio_interval(1, 1e-4, 0, 0, 1.96, &low, &high));
}

static void goodness_of_fit(void **state) {
    (void)state;
    /* Mendel's peas (1866): 315, 101, 108, 32 against 9:3:3:1, chi-square 0.470, three degrees, p 0.925. */
    const double peas[] = {315, 101, 108, 32};
    const double law[] = {556 * 9 / 16.0, 556 * 3 / 16.0, 556 * 3 / 16.0, 556 / 16.0};
    size_t degrees;
    assert_close(chi_square_test(peas, law, 4, &degrees), 0.9254, 1e-3);
    assert_int_equal(degrees, 3);
    /* Thin bins are pooled, the rest at the end too. */
    const double thin[] = {1, 2, 2, 10, 1}, due[] = {2, 2, 2, 9, 1};
    const double p = chi_square_test(thin, due, 5, &degrees);
    assert_int_equal(degrees, 1);
    assert_close(p, chi_square_upper(1.0 / 6 + 1.0 / 10, 1), 1e-12);
    assert_close(chi_square_test(thin, due, 1, &degrees), 1, 0);
}

static void kolmogorov(void **state) {
    (void)state;
    /* Smirnov's table (1948): critical values 1.3581 at 5 %, 1.6276 at 1 %; the median 0.82757. */
    assert_close(kolmogorov_upper(1.3581), 0.05, 1e-3);
    assert_close(kolmogorov_upper(1.6276), 0.01, 1e-3);
    assert_close(kolmogorov_upper(0.82757), 0.5, 1e-4);
    /* The two series meet. */
    assert_close(kolmogorov_upper(1 - 1e-12), kolmogorov_upper(1 + 1e-12), 1e-9);
    /* Massey's table (1951): n = 20, 5 %: 0.294. Twenty even steps of 1/20, all shifted by 0.294 - 0.05. */
    double values[20];
    for (int i = 0; i < 20; ++i) values[i] = fmin(1, (i + 1) / 20.0 - 0.05 + 0.244 + 0.05);
    assert_close(kolmogorov_test(values, 20), 0.05, 0.06);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normal),   cmocka_unit_test(chi_square),      cmocka_unit_test(student),
        cmocka_unit_test(binomial), cmocka_unit_test(levels),          cmocka_unit_test(power),
        cmocka_unit_test(ratio),    cmocka_unit_test(goodness_of_fit), cmocka_unit_test(kolmogorov),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
