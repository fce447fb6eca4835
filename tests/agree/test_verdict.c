/* test_verdict.c: what the verdict says of the reference against itself, right and wronged.
 *
 * Nothing here touches a device: both sides are the reference, with other seeds, so every rejection is the
 * verdict's own. */
#include "check/statistics.h"
#include "check/verdict.h"
#include "reference/reference.h"
#include "support/unit_test.h"
#include "verdict_scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The sums as they would be had every sample been brighter by the factor. */
static void brighten(BpSums *sums, double factor) {
    for (size_t p = 0; p < (size_t)sums->width * sums->height; ++p) {
        for (int c = 0; c < BP_SUMS_CHANNELS; ++c) {
            sums->pixels[p].sum[c] *= factor;
            sums->pixels[p].sum2[c] *= pow(factor, 2);
            sums->pixels[p].sum4[c] *= pow(factor, 4);
        }
    }
}

static BpVerdict judge(const BpSums *kernel, const BpSums *reference, double level) {
    BpVerdict verdict;
    assert_int_equal(bp_verdict(kernel, reference, level, BP_VERDICT_MARGIN, &verdict, NULL), BP_OK);
    return verdict;
}

/* 200 pairs of right renderers at the level 0.05: rejected by chance, 2 to 21 times (see test_statistics). */
static void control(void **state) {
    (void)state;
    BuiltScene built;
    coloured_scene(&built);
    int rejected = 0, by_family[BP_FAMILIES] = {0}, ratio_missed = 0;
    for (uint64_t i = 0; i < 200; ++i) {
        BpSums a, b;
        draw_reference(&built.scene, 200, 2 * i + 1, &a);
        draw_reference(&built.scene, 200, 2 * i + 2, &b);
        const BpVerdict verdict = judge(&a, &b, 0.05);
        rejected += verdict.conclusion == BP_DISAGREE;
        for (int f = 0; f < BP_FAMILIES; ++f) by_family[f] += verdict.worst[f].z > verdict.worst[f].limit;
        ratio_missed += verdict.ratio_low > 1 || verdict.ratio_high < 1;
        bp_sums_clear(&a);
        bp_sums_clear(&b);
    }
    printf("rejected %d of 200 (families %d %d %d %d); the 95 %% interval missed 1 %d times\n", rejected,
           by_family[0], by_family[1], by_family[2], by_family[3], ratio_missed);
    assert_in_range(rejected, 2, 21);
    /* 10 expected; exact binomial at 1e-4 */
    assert_true(bp_binomial_two_sided((uint64_t)ratio_missed, 200, 0.05) > 1e-4);
}

/* Radiance x (1 + e), e chosen for power 0.1, 0.5 and 0.9 of the whole picture's means: 100 runs each must
 * reject that often. The scene is grey, so that the three channels are one test; then the power is a matter
 * of one z. */
static void calibrated(void **state) {
    (void)state;
    BuiltScene built;
    grey_scene(&built);
    BpSums a, b;
    double mean, variance;
    measure_picture(&built.scene, 99, &mean, &variance);
    const double powers[3] = {0.1, 0.5, 0.9}, samples = 256;
    for (int i = 0; i < 3; ++i) {
        const double bias = bias_of_power(powers[i], mean, variance, samples);
        int by_picture = 0, rejected = 0;
        for (uint64_t run = 0; run < 100; ++run) {
            draw_reference(&built.scene, (uint64_t)samples, 1000 + 200 * (uint64_t)i + 2 * run, &a);
            draw_reference(&built.scene, (uint64_t)samples, 1001 + 200 * (uint64_t)i + 2 * run, &b);
            brighten(&a, 1 + bias);
            const BpVerdict verdict = judge(&a, &b, BP_VERDICT_LEVEL);
            by_picture += verdict.worst[BP_FAMILY_PICTURE].z > picture_limit();
            rejected += verdict.conclusion == BP_DISAGREE;
            bp_sums_clear(&a);
            bp_sums_clear(&b);
        }
        const double p = bp_binomial_two_sided((uint64_t)by_picture, 100, powers[i]);
        printf("radiance x %.5f: predicted power %.1f, found by the picture's means %d, in all %d of 100 (p "
               "= %.3f)\n",
               1 + bias, powers[i], by_picture, rejected, p);
        assert_true(p > 1e-4);
        assert_true(rejected >= by_picture);
    }
}

/* 0.5 % too bright on a 64 x 64 diffuse scene at the default count must be found, and nothing must be found
 * where there is nothing. */
static void half_percent(void **state) {
    (void)state;
    BuiltScene built;
    diffuse_scene(&built);
    for (int c = 0; c < 3; ++c) built.scene.background_top[c] = 0.5 + 0.2 * c;
    BpSums a, b;
    draw_reference(&built.scene, 1024, 1, &a);
    draw_reference(&built.scene, 1024, 2, &b);
    const BpVerdict right = judge(&a, &b, BP_VERDICT_LEVEL);
    char *text = bp_verdict_text(&right);
    assert_non_null(text);
    fputs(text, stdout);
    assert_true(right.conclusion == BP_AGREE && right.shown_within < 0.005 && right.smallest_bias < 0.005);
    assert_true(strncmp(text, "agree", 5) == 0);
    free(text);
    brighten(&a, 1.005);
    const BpVerdict wrong = judge(&a, &b, BP_VERDICT_LEVEL);
    text = bp_verdict_text(&wrong);
    assert_non_null(text);
    fputs(text, stdout);
    assert_int_equal(wrong.conclusion, BP_DISAGREE);
    assert_true(wrong.worst[BP_FAMILY_PICTURE].z > wrong.worst[BP_FAMILY_PICTURE].limit);
    assert_true(strncmp(text, "DISAGREE", 8) == 0);
    free(text);
    bp_sums_clear(&a);
    bp_sums_clear(&b);
}

/* ---- corner cases: sums written by hand ------------------------------------------------------------ */

static void constant_picture(BpSums *sums, uint32_t width, uint32_t height, uint64_t samples, double value) {
    assert_int_equal(bp_sums_init(sums, width, height, NULL), BP_OK);
    for (size_t p = 0; p < (size_t)width * height; ++p)
        for (uint64_t s = 0; s < samples; ++s)
            bp_pixel_sums_add(&sums->pixels[p], (double[3]){value, value, value}, 1);
}

static void without_noise(void **state) {
    (void)state;
    BpSums a, b;
    constant_picture(&a, 3, 2, 10, 0.7);
    constant_picture(&b, 3, 2, 10, 0.7 * (1 + 1e-5)); /* what single precision may cost */
    assert_int_equal(judge(&a, &b, 1e-4).conclusion, BP_AGREE);
    bp_sums_clear(&b);
    constant_picture(&b, 3, 2, 10, 0.7 * (1 + 1e-4));
    const BpVerdict verdict = judge(&a, &b, 1e-4);
    assert_int_equal(verdict.conclusion, BP_DISAGREE);
    assert_true(verdict.block_columns == 3 && verdict.block_rows == 2);
    bp_sums_clear(&a);
    bp_sums_clear(&b);
}

/* Light that rays to lamps bring to every sample, and that by chance one of very many finds, with a
 * brightness of up to B: a reference that has found none is no evidence while it should have made a few finds
 * only, and is when they should be a hundred. The same for a kernel that has missed it. */
static void rare_light(void **state) {
    (void)state;
    const double light = 0.5, samples = 1000.0 * 8 * 8;
    for (int swapped = 0; swapped < 2; ++swapped) {
        BpSums with, without;
        constant_picture(&with, 8, 8, 1000, 1 + light);
        constant_picture(&without, 8, 8, 1000, 1);
        with.means_only = true;
        const BpSums *const kernel = swapped ? &without : &with, *const reference =
                                                                     swapped ? &with : &without;
        const double finds[] = {1, 10, 100};
        for (int i = 0; i < 3; ++i) {
            with.brightest = without.brightest = samples * light / finds[i];
            const BpVerdict verdict = judge(kernel, reference, BP_VERDICT_LEVEL);
            assert_int_equal(verdict.conclusion == BP_DISAGREE, finds[i] > 50);
            assert_true(fabs(verdict.worst[BP_FAMILY_PICTURE].z - sqrt(finds[i])) < 0.01);
        }
        /* Where both find it alike, a difference is one. */
        with.means_only = false;
        assert_int_equal(judge(kernel, reference, BP_VERDICT_LEVEL).conclusion, BP_DISAGREE);
        bp_sums_clear(&with);
        bp_sums_clear(&without);
    }
}

static void black_pictures(void **state) {
    (void)state;
    BpSums a, b;
    constant_picture(&a, 4, 4, 100, 0);
    constant_picture(&b, 4, 4, 100, 0);
    BpVerdict verdict = judge(&a, &b, 1e-4);
    assert_int_equal(verdict.conclusion, BP_INCONCLUSIVE); /* nothing was seen, so nothing is shown */
    assert_true(isnan(verdict.ratio) && isnan(verdict.smallest_bias) && isinf(verdict.shown_within));
    assert_int_equal(bp_verdict_samples_needed(&verdict, 100), 0);
    char *text = bp_verdict_text(&verdict);
    assert_true(strncmp(text, "INCONCLUSIVE", 12) == 0);
    assert_non_null(strstr(text, "no ratio"));
    free(text);
    /* 30 bright fireflies on one side alone: too few for means, plain for their number. */
    for (int p = 0; p < 16; ++p)
        for (int i = 0; i < 2; ++i) {
            bp_pixel_sums_add(&a.pixels[p], (double[3]){50, 50, 50}, 1);
            bp_pixel_sums_add(&b.pixels[p], (double[3]){0, 0, 0}, 1);
        }
    verdict = judge(&a, &b, 1e-4);
    assert_true(verdict.conclusion == BP_DISAGREE && verdict.worst[BP_FAMILY_PICTURE].counted);
    bp_sums_clear(&a);
    bp_sums_clear(&b);
}

static void one_wrong_block(void **state) {
    (void)state;
    BpSums a, b;
    constant_picture(&a, 64, 64, 4, 0.5);
    constant_picture(&b, 64, 64, 4, 0.5);
    for (int p = 0; p < 64 * 64; ++p) { /* the same noise everywhere, and one block of a darker by a tenth */
        const double dim = p % 64 / 8 == 5 && p / 64 / 8 == 2 ? 0.9 : 1;
        for (int i = 0; i < 200; ++i) {
            const double x = i % 2, y = (i + p) % 2;
            bp_pixel_sums_add(&a.pixels[p], (double[3]){dim * x, dim * x, dim * x}, 1);
            bp_pixel_sums_add(&b.pixels[p], (double[3]){y, y, y}, 1);
        }
    }
    const BpVerdict verdict = judge(&a, &b, 1e-4);
    assert_int_equal(verdict.conclusion, BP_DISAGREE);
    assert_true(verdict.worst[BP_FAMILY_PICTURE].z < verdict.worst[BP_FAMILY_PICTURE].limit);
    const BpVerdictTest *block = &verdict.worst[BP_FAMILY_BLOCKS];
    assert_true(block->z > block->limit && block->column == 5 && block->row == 2);
    bp_sums_clear(&a);
    bp_sums_clear(&b);
}

/* The mean right and the spread wrong: only the squares can tell. */
static void wrong_spread(void **state) {
    (void)state;
    BpSums a, b;
    assert_int_equal(bp_sums_init(&a, 8, 8, NULL), BP_OK);
    assert_int_equal(bp_sums_init(&b, 8, 8, NULL), BP_OK);
    for (int p = 0; p < 64; ++p)
        for (int i = 0; i < 400; ++i) {
            const double x = i % 4 == 0 ? 2 : 0, y = i % 2 == 0 ? 1 : 0;
            bp_pixel_sums_add(&a.pixels[p], (double[3]){x, x, x}, 1);
            bp_pixel_sums_add(&b.pixels[p], (double[3]){y, y, y}, 1);
        }
    const BpVerdict verdict = judge(&a, &b, 1e-4);
    assert_int_equal(verdict.conclusion, BP_DISAGREE);
    assert_true(verdict.worst[BP_FAMILY_PICTURE].z == 0);
    assert_true(verdict.worst[BP_FAMILY_PICTURE_SQUARES].z > 10);
    bp_sums_clear(&a);
    bp_sums_clear(&b);
}

static void invalid_samples(void **state) {
    (void)state;
    BpSums a, b;
    constant_picture(&a, 2, 2, 10, 0.5);
    constant_picture(&b, 2, 2, 10, 0.5);
    assert_int_equal(judge(&a, &b, 1e-4).conclusion, BP_AGREE);
    bp_pixel_sums_add(&a.pixels[3], (double[3]){0.5, NAN, 0.5}, 2);
    const BpVerdict verdict = judge(&a, &b, 1e-4);
    assert_int_equal(verdict.conclusion, BP_DISAGREE);
    assert_int_equal(verdict.invalid_kernel, 1);
    bp_sums_clear(&a);
    bp_sums_clear(&b);
}

/* Noise of `samples` fair coins a pixel, worth 0 or 1 in each channel, on both sides; `lights`: which
 * channels. */
static void coins(BpSums *sums, uint64_t samples, unsigned seed, const double lights[3]) {
    uint64_t state = seed;
    assert_int_equal(bp_sums_init(sums, 8, 8, NULL), BP_OK);
    for (size_t p = 0; p < 64; ++p)
        for (uint64_t s = 0; s < samples; ++s) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            const double x = (double)(state >> 63);
            bp_pixel_sums_add(&sums->pixels[p], (double[3]){x * lights[0], x * lights[1], x * lights[2]}, 1);
        }
}

static BpVerdict judge_coins(uint64_t samples, double margin, const double lights[3]) {
    BpSums a, b;
    BpVerdict verdict;
    coins(&a, samples, 1, lights);
    coins(&b, samples, 2, lights);
    assert_int_equal(bp_verdict(&a, &b, 1e-4, margin, &verdict, NULL), BP_OK);
    bp_sums_clear(&a);
    bp_sums_clear(&b);
    return verdict;
}

/* What is not rejected agrees only where equality is shown within the margin; more samples settle it, as many
 * as the verdict asks for. */
static void nothing_passes_without_evidence(void **state) {
    (void)state;
    const double white[3] = {1, 1, 1};
    const BpVerdict few = judge_coins(20, 0.01, white);
    assert_int_equal(few.conclusion, BP_INCONCLUSIVE);
    assert_true(few.shown_within > 0.01 && few.shown_within < 1);
    const double low = 1 - few.ratio_low, high = few.ratio_high - 1; /* all channels are equal here */
    assert_true(fabs(few.shown_within - (low > high ? low : high)) < 1e-9);
    assert_int_equal(judge_coins(20, few.shown_within * 1.001, white).conclusion, BP_AGREE);
    assert_int_equal(judge_coins(20, few.shown_within * 0.999, white).conclusion, BP_INCONCLUSIVE);
    BpSums a, b; /* the same with the sides changed: then the other end of the interval is the farther one */
    coins(&a, 20, 2, white);
    coins(&b, 20, 1, white);
    const BpVerdict changed = judge(&a, &b, 1e-4);
    const double below = 1 - changed.ratio_low, above = changed.ratio_high - 1;
    assert_true(fabs(changed.shown_within - (below > above ? below : above)) < 1e-9);
    assert_true((low > high) != (below > above));
    bp_sums_clear(&a);
    bp_sums_clear(&b);
    const uint64_t needed = bp_verdict_samples_needed(&few, 20);
    assert_in_range(needed, 40, 20000);
    assert_int_equal(judge_coins(needed, 0.01, white).conclusion, BP_AGREE);
    char *text = bp_verdict_text(&few);
    assert_true(strncmp(text, "INCONCLUSIVE", 12) == 0);
    assert_non_null(strstr(text, "NOT ENOUGH"));
    free(text);
}

/* A channel without light on either side has nothing to show; one that is lit on one side alone has. */
static void dark_channels(void **state) {
    (void)state;
    const BpVerdict red = judge_coins(20000, 0.01, (const double[3]){1, 0, 0});
    assert_int_equal(red.conclusion, BP_AGREE);
    BpSums a, b;
    constant_picture(&a, 2, 2, 10, 0.5);
    constant_picture(&b, 2, 2, 10, 0.5);
    for (int p = 0; p < 4; ++p) { /* one faint blue sample in ten: too little to be rejected by itself */
        a.pixels[p].sum[BP_SUMS_BLUE] = b.pixels[p].sum[BP_SUMS_BLUE] = 0;
        a.pixels[p].sum2[BP_SUMS_BLUE] = b.pixels[p].sum2[BP_SUMS_BLUE] = 0;
        a.pixels[p].sum4[BP_SUMS_BLUE] = b.pixels[p].sum4[BP_SUMS_BLUE] = 0;
        a.pixels[p].lit[BP_SUMS_BLUE] = b.pixels[p].lit[BP_SUMS_BLUE] = 0;
    }
    BpVerdict verdict = judge(&a, &b, 1e-4);
    assert_int_equal(verdict.conclusion, BP_AGREE);
    a.pixels[0].sum[BP_SUMS_BLUE] = 0.1;
    a.pixels[0].sum2[BP_SUMS_BLUE] = 0.01;
    a.pixels[0].lit[BP_SUMS_BLUE] = 1;
    verdict = judge(&a, &b, 1e-4);
    assert_int_equal(verdict.conclusion, BP_INCONCLUSIVE);
    assert_true(isinf(verdict.shown_within));
    bp_sums_clear(&a);
    bp_sums_clear(&b);
}

/* Evidence never outweighs a fault. */
static void faults_disagree(void **state) {
    (void)state;
    BpSums a, b;
    constant_picture(&a, 2, 2, 10, 0.5);
    constant_picture(&b, 2, 2, 10, 0.5);
    BpVerdict verdict = judge(&a, &b, 1e-4);
    bp_verdict_add_picture(&verdict, 0.5 * BP_VERDICT_PICTURE_OFF);
    assert_int_equal(verdict.conclusion, BP_AGREE);
    bp_verdict_add_picture(&verdict, 2 * BP_VERDICT_PICTURE_OFF);
    assert_int_equal(verdict.conclusion, BP_DISAGREE);
    bp_sums_clear(&a);
    constant_picture(&a, 2, 2, 10, 0.51);
    assert_int_equal(bp_verdict(&a, &b, 1e-4, 1, &verdict, NULL), BP_OK); /* a margin that all is within */
    assert_int_equal(verdict.conclusion, BP_DISAGREE);
    bp_sums_clear(&a);
    bp_sums_clear(&b);
}

static void refusals(void **state) {
    (void)state;
    BpSums a, b;
    BpVerdict verdict;
    BpError err = {0};
    constant_picture(&a, 2, 2, 10, 0.5);
    constant_picture(&b, 2, 3, 10, 0.5);
    assert_int_equal(bp_verdict(&a, &b, 1e-4, 0.01, &verdict, &err), BP_ERR_USAGE);
    assert_non_null(strstr(err.message, "2 x 3"));
    assert_int_equal(bp_verdict(&a, &a, 0, 0.01, &verdict, &err), BP_ERR_USAGE);
    assert_int_equal(bp_verdict(&a, &a, 1e-4, 0, &verdict, &err), BP_ERR_USAGE);
    assert_non_null(strstr(err.message, "margin"));
    bp_sums_clear(&b);
    constant_picture(&b, 2, 2, 1, 0.5);
    assert_int_equal(bp_verdict(&a, &b, 1e-4, 0.01, &verdict, &err), BP_ERR_USAGE);
    bp_error_clear(&err);
    bp_sums_clear(&a);
    bp_sums_clear(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(control),
        cmocka_unit_test(calibrated),
        cmocka_unit_test(half_percent),
        cmocka_unit_test(without_noise),
        cmocka_unit_test(black_pictures),
        cmocka_unit_test(one_wrong_block),
        cmocka_unit_test(wrong_spread),
        cmocka_unit_test(invalid_samples),
        cmocka_unit_test(rare_light),
        cmocka_unit_test(refusals),
        cmocka_unit_test(nothing_passes_without_evidence),
        cmocka_unit_test(dark_channels),
        cmocka_unit_test(faults_disagree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
