/* test_film_estimate.c: means and error bars of synthetic pictures whose true errors are known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "film_data.h"

#include <stdlib.h>
#include <string.h>

#define SIDE 150u

/* SIDE x SIDE pixels of `samples` normal samples each: mean 2, deviation 0.5. The channels draw their own
 * numbers, or all the same one. */
static BpFilm *make(uint32_t replicates, uint64_t samples, bool channels_agree, uint64_t key) {
    BpFilm *film = NULL;
    assert_int_equal(bp_film_create(SIDE, SIDE, replicates, &film, NULL), BP_OK);
    film->scale_log2 = 36;
    for (size_t pixel = 0; pixel < SIDE * SIDE; pixel++)
        for (uint64_t s = 0; s < samples; s++) {
            double rgb[3];
            for (uint64_t c = 0; c < 3; c++)
                rgb[c] =
                    2 + 0.5 * data_normal((((key << 20) + pixel) * 256 + s) * 4 + (channels_agree ? 0 : c));
            data_add(film, pixel, s, rgb);
        }
    return film;
}

/* NRMSE against its true value. With 22500 pixels of 3 degrees of freedom the estimated variance is right
 * within sqrt(2 / 67500) = 0.54 %, one sigma; its root within 0.27 %. */
static void assert_nrmse(uint32_t replicates, uint64_t samples, bool channels_agree, uint64_t key) {
    BpFilm *film = make(replicates, samples, channels_agree, key);
    const double weights = sqrt(0.2126 * 0.2126 + 0.7152 * 0.7152 + 0.0722 * 0.0722);
    const double deviation = 0.5 * (channels_agree ? 1 : weights);
    const double expected = deviation / sqrt((double)samples) / 2;
    const double found = bp_film_nrmse(film);
    if (fabs(found / expected - 1) > 4 * 0.0027) fail_msg("nrmse %g, expected %g", found, expected);
    bp_film_destroy(&film);
}

static void nrmse_is_what_theory_says(void **state) {
    (void)state;
    assert_nrmse(4, 16, false, 1);
    assert_nrmse(4, 16, true, 2);
    assert_nrmse(8, 8, false, 3);
}

/* Six samples in four replicates: 2 2 1 1. */
static void unequal_counts_keep_it_unbiased(void **state) {
    (void)state;
    assert_nrmse(4, 6, true, 4);
    assert_nrmse(4, 5, false, 5);
    /* The control: means of replicates taken for equally good give (1/2 + 1/2 + 1 + 1) / 16 of the variance,
     * for 1 / 6: 6 % more error. The tolerance above would have seen it. */
    assert_true(sqrt(3.0 / 16 * 6) > 1.06);
    /* The weighted mean is the plain mean of all samples. */
    BpFilm *one = NULL;
    assert_int_equal(bp_film_create(1, 1, 4, &one, NULL), BP_OK);
    one->scale_log2 = 30;
    for (uint64_t s = 0; s < 6; s++) data_add(one, 0, s, (double[3]){(double)s, 0, 0});
    double mean[3];
    bp_film_mean(one, mean);
    assert_true(fabs(mean[0] - 2.5) < 1e-15);
    /* By hand: replicate means 2 3 2 3, counts 2 2 1 1, s^2 = 6 * 0.25 / 3, error = sqrt(0.5 / 6) */
    BpPicture picture;
    assert_int_equal(bp_film_picture(one, &picture, NULL), BP_OK);
    assert_true(fabs((double)picture.error[0] - sqrt(0.5 / 6)) < 1e-7);
    assert_true(picture.error[1] == 0);
    assert_int_equal(picture.samples[0], 6);
    bp_picture_clear(&picture);
    bp_film_destroy(&one);
}

/* How often the true mean lies within `width` standard errors. */
static double coverage(const BpPicture *picture, double width) {
    size_t inside = 0;
    for (size_t i = 0; i < SIDE * SIDE * 3; i++)
        inside += fabs((double)picture->rgb[i] - 2) <= width * (double)picture->error[i];
    return (double)inside / (SIDE * SIDE * 3);
}

/* Student's t of 3 degrees of freedom: 95 % within 3.182 standard errors, 85.49 % within 1.96, 60.9 %
 * within 1. 67500 intervals make the share sure within sqrt(0.95 * 0.05 / 67500) = 0.0008, and 0.0014,
 * 0.0019. */
static void error_bars_cover_the_truth(void **state) {
    (void)state;
    BpFilm *film = make(4, 16, false, 6);
    BpPicture picture;
    assert_int_equal(bp_film_picture(film, &picture, NULL), BP_OK);
    assert_int_equal(picture.width, SIDE);
    assert_true(fabs(coverage(&picture, 3.182446) - 0.95) < 4 * 0.0008);
    assert_true(fabs(coverage(&picture, 1.959964) - 0.8552) < 4 * 0.0014);
    assert_true(fabs(coverage(&picture, 1) - 0.6090) < 4 * 0.0019);
    for (size_t i = 0; i < SIDE * SIDE; i++) assert_int_equal(picture.samples[i], 16);
    bp_picture_clear(&picture);
    bp_film_destroy(&film);
}

static void what_is_unknown_is_nan(void **state) {
    (void)state;
    BpFilm *a = NULL;
    assert_int_equal(bp_film_create(2, 1, 4, &a, NULL), BP_OK);
    assert_true(isnan(bp_film_nrmse(a))); /* no samples */
    data_add(a, 0, 0, (double[3]){1, 1, 1});
    data_add(a, 0, 4, (double[3]){3, 3, 3});
    BpPicture picture;
    assert_int_equal(bp_film_picture(a, &picture, NULL), BP_OK);
    assert_true(picture.rgb[0] == 2 && picture.rgb[3] == 0);
    assert_true(isnan(picture.error[0]) && isnan(picture.error[3])); /* one replicate, none */
    assert_int_equal(picture.samples[0], 2);
    assert_int_equal(picture.samples[1], 0);
    bp_picture_clear(&picture);
    data_add(a, 0, 1, (double[3]){1, 1, 1});
    assert_true(isnan(bp_film_nrmse(a))); /* the second pixel still has none */
    data_add(a, 1, 0, (double[3]){1, 1, 1});
    data_add(a, 1, 1, (double[3]){1, 1, 1});
    assert_true(bp_film_nrmse(a) > 0);
    double mean[3];
    bp_film_mean(a, mean);
    assert_true(fabs(mean[1] - (5.0 / 3 + 1) / 2) < 1e-15);
    memset(a->sums, 0, 24 * sizeof *a->sums);
    assert_true(isnan(bp_film_nrmse(a))); /* black: a mean of 0 */
    bp_film_destroy(&a);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nrmse_is_what_theory_says),
        cmocka_unit_test(unequal_counts_keep_it_unbiased),
        cmocka_unit_test(error_bars_cover_the_truth),
        cmocka_unit_test(what_is_unknown_is_nan),
    };
    return cmocka_run_group_tests_name("film_estimate", tests, NULL, NULL);
}
