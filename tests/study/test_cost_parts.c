/* test_cost_parts.c: the arithmetic of `ballpark cost` on data whose answers are known. */
#include "support/unit_test.h"

#include "cost_random.h"
#include "study/fit.h"
#include "study/measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the fit ---- */

static void test_fit_exact(void **state) {
    (void)state;
    const double n[] = {4, 16, 64, 256, 1024}, floors[] = {0, 1e-4, 0.25};
    for (size_t f = 0; f < 3; f++) {
        double y[5], floor, slope;
        for (size_t i = 0; i < 5; i++) y[i] = floors[f] + 2 / n[i];
        assert_true(bp_study_fit(n, y, 5, &floor, &slope));
        assert_true(fabs(floor - floors[f]) <= 1e-11);
        assert_true(fabs(slope - 2) <= 1e-8);
    }
}

/* Errors of 10 % in every value: unbiased, and as close as least squares can be. */
static void test_fit_noisy(void **state) {
    (void)state;
    const double n[] = {4, 16, 64, 256, 1024};
    double sum_floor = 0, sum_slope = 0, sum_floor2 = 0;
    enum { TRIALS = 4000 };
    stream.state = 1;
    for (int t = 0; t < TRIALS; t++) {
        double y[5], floor, slope;
        for (size_t i = 0; i < 5; i++) y[i] = (0.01 + 2 / n[i]) * (1 + 0.1 * normal());
        assert_true(bp_study_fit(n, y, 5, &floor, &slope));
        sum_floor += floor / TRIALS;
        sum_floor2 += floor * floor / TRIALS;
        sum_slope += slope / TRIALS;
    }
    const double spread = sqrt(sum_floor2 - sum_floor * sum_floor);
    print_message("floor %.5f +- %.5f of 0.01, slope %.3f of 2\n", sum_floor, spread, sum_slope);
    assert_true(fabs(sum_floor - 0.01) < 4e-4); /* relative weights pull a little below */
    assert_true(fabs(sum_slope - 2) < 0.08);
    assert_true(spread < 0.0015);
}

static void test_fit_limits(void **state) {
    (void)state;
    const double n[] = {4, 16, 64}, faster[] = {1, 0.1, 0.01}, rising[] = {1, 1.1, 1.2},
                 none[] = {0, -1, (double)NAN}, one[] = {1, 0, -1}, same[] = {4, 4, 4};
    double floor, slope;
    assert_true(bp_study_fit(n, faster, 3, &floor, &slope)); /* falls faster than 1 / n */
    assert_true(floor == 0 && slope > 0);
    assert_true(bp_study_fit(n, rising, 3, &floor, &slope));
    assert_true(slope == 0 && floor > 1 && floor < 1.2);
    assert_false(bp_study_fit(n, none, 3, &floor, &slope));
    assert_true(isnan(floor) && isnan(slope));
    assert_false(bp_study_fit(n, one, 3, &floor, &slope));
    assert_false(bp_study_fit(same, faster, 3, &floor, &slope));
}

/* ---- errors against two references ---- */

#define WIDTH 80u
#define HEIGHT 50u
#define PIXELS ((size_t)WIDTH * HEIGHT)

/* Grey, `truth` varying over the picture, off by `bias` and noise. */
static BpPicture make_grey(double bias, double noise) {
    BpPicture picture = {.width = WIDTH, .height = HEIGHT, .rgb = malloc(3 * PIXELS * sizeof(float))};
    assert_non_null(picture.rgb);
    for (size_t p = 0; p < PIXELS; p++) {
        const double value = 0.5 + (double)(p % WIDTH) / WIDTH + bias + noise * normal();
        for (size_t c = 0; c < 3; c++) picture.rgb[3 * p + c] = (float)value;
    }
    return picture;
}

/* References five times noisier than the picture: their noise must not be taken for its error. */
static void test_errors(void **state) {
    (void)state;
    enum { TRIALS = 40 };
    double sum = 0, sum_z2 = 0;
    stream.state = 2;
    for (int t = 0; t < TRIALS; t++) {
        BpPicture x = make_grey(0.02, 0.03), r1 = make_grey(0, 0.15), r2 = make_grey(0, 0.15);
        BpStudyPoint point = {0};
        const double expected = (0.02 * 0.02 + 0.03 * 0.03) / (2.0 * 2.0); /* of a brightness of 2 */
        bp_study_errors(&x, &r1, &r2, 2, &point);
        sum += point.mse / expected / TRIALS;
        sum_z2 += pow((point.mse - expected) / point.mse_error, 2) / TRIALS;
        bp_picture_clear(&x);
        bp_picture_clear(&r1);
        bp_picture_clear(&r2);
    }
    print_message("mse %.3f of the expected; mean squared z %.2f\n", sum, sum_z2);
    assert_true(fabs(sum - 1) < 0.15); /* 0.0225 / sqrt(4000) / 0.0013 / sqrt(40): 0.04 a standard error */
    assert_true(sum_z2 > 0.5 && sum_z2 < 1.7);
}

static void test_errors_by_hand(void **state) {
    (void)state;
    float x[] = {1, 1, 1, 0.5f, 0.5f, 0.5f}, a[] = {0.9f, 0.9f, 0.9f, 0.5f, 0.5f, 0.5f},
          b[] = {0.8f, 0.8f, 0.8f, 0.7f, 0.7f, 0.7f};
    const BpPicture px = {.width = 2, .height = 1, .rgb = x}, pa = {.width = 2, .height = 1, .rgb = a},
                    pb = {.width = 2, .height = 1, .rgb = b};
    BpStudyPoint point = {0};
    bp_study_errors(&px, &pa, &pb, 0.5, &point);
    assert_true(fabs(point.mse - 4 * (0.1 * 0.2 + 0) / 2) < 1e-7);
    assert_true(fabs(point.rel_mse - 0.1 * 0.2 / (0.86 * 0.86) / 2) < 1e-7);
    assert_true(isnan(point.nrmse)); /* two pixels tell nothing */
    bp_study_errors(&pa, &pa, &pa, 0.5, &point);
    assert_true(point.mse == 0 && isnan(point.nrmse));
}

/* ---- paired differences ---- */

#define K 4u

/* Two renders of the same random numbers: noise 0.3 in common, and in each replicate of x `bias` (alternately
 * up and down by `swing` from pixel to pixel) and noise 0.01 of its own. */
static void make_pair(double bias, double swing, BpFilm *base, BpFilm *x) {
    base->scale_log2 = x->scale_log2 = 30;
    for (size_t cell = 0; cell < PIXELS * K; cell++) {
        const uint32_t count = base->counts[cell] = x->counts[cell] = 8;
        const double common = 1 + 0.3 * normal(), sign = (cell / K) % 2 == 0 ? 1 : -1;
        const double other = common + bias + sign * swing + 0.01 * normal();
        for (size_t c = 0; c < 3; c++) {
            base->sums[3 * cell + c] = (int64_t)ldexp(count * common, 30);
            x->sums[3 * cell + c] = (int64_t)ldexp(count * other, 30);
        }
    }
}

static void test_paired(void **state) {
    (void)state;
    enum { TRIALS = 300 };
    BpFilm *base = NULL, *x = NULL;
    BpError err = {0};
    int held = 0, held_square = 0;
    double widest = 0, mean_square = 0;
    stream.state = 3;
    assert_int_equal(bp_film_create(WIDTH, HEIGHT, K, &base, &err), BP_OK);
    assert_int_equal(bp_film_create(WIDTH, HEIGHT, K, &x, &err), BP_OK);
    const double bias = 0.001, swing = 0.002, brightness = 2;
    const double square = (bias * bias + swing * swing) / (brightness * brightness);
    for (int t = 0; t < TRIALS; t++) {
        BpStudyEstimate difference, squares;
        make_pair(bias, swing, base, x);
        assert_int_equal(bp_study_paired(x, base, brightness, &difference, &squares, &err), BP_OK);
        held += difference.low <= bias / brightness && bias / brightness <= difference.high;
        held_square += squares.low <= square && square <= squares.high;
        widest = fmax(widest, difference.high - difference.low);
        mean_square += squares.value / square / TRIALS;
    }
    print_message("intervals hold: bias %d, square %d of %d; widest %.2g; mean square %.3f of the true\n",
                  held, held_square, TRIALS, widest, mean_square);
    assert_true(held >= 0.91 * TRIALS && held <= 0.985 * TRIALS);
    assert_true(held_square >= 0.90 * TRIALS && held_square <= 0.99 * TRIALS);
    assert_true(fabs(mean_square - 1) < 0.05);
    /* Unpaired, the common noise would make it 0.3 / 0.01 times wider. */
    assert_true(widest < 3 * 2 * 1.96 * 0.01 / sqrt((double)(PIXELS * K)) / brightness);
    BpFilm *narrow = NULL;
    BpStudyEstimate a, b;
    assert_int_equal(bp_film_create(WIDTH - 1, HEIGHT, K, &narrow, &err), BP_OK);
    assert_int_equal(bp_study_paired(narrow, base, 1, &a, &b, &err), BP_ERR_USAGE);
    bp_error_clear(&err);
    bp_film_destroy(&narrow);
    bp_film_destroy(&base);
    bp_film_destroy(&x);
}

/* The difference from references of other random numbers, as devices without double have it. */
static void test_unpaired(void **state) {
    (void)state;
    enum { TRIALS = 300 };
    int held = 0;
    stream.state = 4;
    for (int t = 0; t < TRIALS; t++) {
        BpPicture x = make_grey(0.01, 0.05), r1 = make_grey(0, 0.03), r2 = make_grey(0, 0.03);
        x.error = malloc(3 * PIXELS * sizeof(float));
        assert_non_null(x.error);
        for (size_t i = 0; i < 3 * PIXELS; i++) x.error[i] = 0.05f;
        const BpStudyEstimate difference = bp_study_unpaired(&x, &r1, &r2, 2);
        held += difference.low <= 0.005 && 0.005 <= difference.high;
        bp_picture_clear(&x);
        bp_picture_clear(&r1);
        bp_picture_clear(&r2);
    }
    print_message("intervals hold: %d of %d\n", held, TRIALS);
    assert_true(held >= 0.91 * TRIALS && held <= 0.985 * TRIALS);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fit_exact),      cmocka_unit_test(test_fit_noisy),
        cmocka_unit_test(test_fit_limits),     cmocka_unit_test(test_errors),
        cmocka_unit_test(test_errors_by_hand), cmocka_unit_test(test_paired),
        cmocka_unit_test(test_unpaired),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
