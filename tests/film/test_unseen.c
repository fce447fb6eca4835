/* test_unseen.c: the noise of light that samples have not found yet (host/film/unseen.h), by hand. */
#include "film/film_file.h"
#include "support/output_temp.h"

#include "film_data.h"

#include <math.h>

enum { K = 4 };

/* Pixels in a row of `per` samples a replicate; all black. */
static BpFilm *film_of(uint32_t pixels, uint32_t per) {
    BpFilm *film = NULL;
    assert_int_equal(bp_film_create(pixels, 1, K, &film, NULL), BP_OK);
    film->scale_log2 = 30;
    if (per > 0) assert_int_equal(bp_film_add_range(film, 0, K * per, NULL), BP_OK);
    for (size_t cell = 0; cell < (size_t)pixels * K; ++cell) film->counts[cell] = per;
    return film;
}

/* Every replicate of the pixel has this mean. */
static void fill(BpFilm *film, size_t pixel, size_t replicate, double value) {
    const size_t cell = pixel * K + replicate;
    for (size_t c = 0; c < 3; ++c)
        film->sums[3 * cell + c] = llrint(ldexp(value * film->counts[cell], film->scale_log2));
}

static BpUnseenPixel *unseen_of(BpFilm *film) {
    assert_int_equal(bp_unseen_create((size_t)film->width * film->height, &film->unseen, NULL), BP_OK);
    for (int c = 0; c < 3; ++c) film->unseen->tint[c] = 1;
    return film->unseen->pixels;
}

static void assert_near(double found, double expected, const char *what) {
    if (!(fabs(found - expected) <= 1e-6 * fabs(expected))) /* picture->error is in float */
        fail_msg("%s: %.10g, expected %.10g", what, found, expected);
}

/* ---- weights ---- */

/* Light of chance p that brings c: one film of 3 pixels of 8 samples makes p * 24 finds. */
static void weights_of_finds(void **state) {
    (void)state;
    BpFilm *film = film_of(5, 2);
    BpUnseenPixel *light = unseen_of(film);
    for (int i = 0; i < 3; ++i) light[i] = (BpUnseenPixel){0.25f * 100, 0.25f * 100 * 100};
    light[3] = (BpUnseenPixel){0, 0};
    light[4] = (BpUnseenPixel){0.125f * 6400, 0.125f * 6400 * 6400}; /* brighter by six octaves */
    BpUnseenWeights weights;
    bp_unseen_weigh(film, &weights);
    assert_near(bp_unseen_weight(&weights, &light[0]), 10.0 / (10 + 0.25 * 24), "the weight after 6 finds");
    assert_near(bp_unseen_weight(&weights, &light[4]), 10.0 / (10 + 0.125 * 8), "the weight after 1 find");
    assert_true(bp_unseen_weight(&weights, &light[3]) == 0);
    /* Neighbouring octaves count together: finds of light twice as bright are finds. */
    light[4] = (BpUnseenPixel){0.125f * 200, 0.125f * 200 * 200};
    bp_unseen_weigh(film, &weights);
    assert_near(bp_unseen_weight(&weights, &light[0]), 10.0 / (10 + 6 + 1), "with a brighter neighbour");
    assert_near(bp_unseen_weight(&weights, &light[4]), 10.0 / (10 + 6 + 1), "with a darker neighbour");
    light[4] = (BpUnseenPixel){0.125f * 400, 0.125f * 400 * 400};
    bp_unseen_weigh(film, &weights);
    assert_near(bp_unseen_weight(&weights, &light[0]), 10.0 / (10 + 6), "two octaves apart");
    /* The brightest and the dimmest that there are keep to their places. */
    light[0] = (BpUnseenPixel){1e-38f, 3e38f};
    light[1] = (BpUnseenPixel){3e38f, 1e-38f};
    bp_unseen_weigh(film, &weights);
    for (int i = 0; i < 2; ++i) {
        const double weight = bp_unseen_weight(&weights, &light[i]);
        assert_true(weight >= 0 && weight <= 1);
    }
    bp_film_destroy(&film);
    film = film_of(2, 0);
    unseen_of(film)[0] = (BpUnseenPixel){1, 100};
    bp_unseen_weigh(film, &weights);
    assert_true(bp_unseen_weight(&weights, &film->unseen->pixels[0]) == 1); /* no samples: all is unseen */
    bp_film_destroy(&film);
    film = film_of(1, 2);
    bp_unseen_weigh(film, &weights);
    for (int i = 0; i < BP_UNSEEN_OCTAVES; ++i) assert_true(weights.finds[i] == 0);
    bp_film_destroy(&film);
}

/* ---- claims ---- */

/* Three pixels of 16 samples. What is seen: 1, with replicates at 1 +- 0.1, so s^2 = n v = 4 * 4 * 0.01 / 3
 * and a squared error of 0.16 / 3 / 16. Pixel 1 has light of chance 0.001 that brings 500, and pixel 2 such
 * light that its last replicate has found. */
static const double own_error = 0.01 / 3, chance = 0.001, brings = 500;

static BpFilm *lit_film(void) {
    BpFilm *film = film_of(3, 4);
    for (size_t pixel = 0; pixel < 3; ++pixel)
        for (size_t k = 0; k < K; ++k) fill(film, pixel, k, k % 2 == 0 ? 1.1 : 0.9);
    fill(film, 2, 3, 0.9 + brings / 4); /* one of its four samples */
    BpUnseenPixel *light = unseen_of(film);
    for (int i = 1; i < 3; ++i)
        light[i] = (BpUnseenPixel){(float)(chance * brings), (float)(chance * brings * brings)};
    return film;
}

static void claims_by_hand(void **state) {
    (void)state;
    BpFilm *film = lit_film();
    const double weight = 10 / (10 + chance * 32), mean = chance * brings;
    const double variance = (chance * brings * brings - mean * mean) / 16;
    const double last = 0.9 + brings / 4, middle = (1.1 + 0.9 + 1.1 + last) / 4;
    const double found_error =
        (2 * pow(1.1 - middle, 2) + pow(0.9 - middle, 2) + pow(last - middle, 2)) / 3 / 4;
    /* Behind the last: 1.1, 0.9, 1.1, of the mean 3.1 / 3; as if there were four like them, times 4 / 2.5. */
    const double rest = 3.1 / 3;
    const double rest_error = 1.6 * (2 * pow(1.1 - rest, 2) + pow(0.9 - rest, 2)) / 2 / 4;
    BpUnseenWeights weights;
    bp_unseen_weigh(film, &weights);
    assert_near(bp_film_squared_error(film, &weights, 0), own_error, "a pixel without such light");
    assert_near(bp_film_squared_error(film, &weights, 1), own_error + weight * variance, "not found");
    assert_near(bp_film_squared_error(film, &weights, 2),
                found_error + weight * (variance + rest_error - found_error), "found");
    assert_near(bp_film_squared_error(film, NULL, 2), found_error, "what samples have seen");
    const double squared =
        2 * own_error + weight * variance + found_error + weight * (variance + rest_error - found_error);
    /* In the light of pixel 2, what it has found beyond its other replicates is that of the pilot. */
    const double luminance = 1 + (1 + weight * mean) + (middle + weight * (mean - (middle - rest)));
    assert_near(bp_film_claim(film).luminance, luminance / 3, "the expected luminance");
    assert_near(bp_film_nrmse(film), sqrt(squared / 3) / (luminance / 3), "the noise");
    assert_near(bp_film_unseen_part(film), 2 * weight * variance / squared, "the part of it that is unseen");
    BpPicture picture;
    assert_int_equal(bp_film_picture(film, &picture, NULL), BP_OK);
    for (int c = 0; c < 3; ++c) {
        assert_near((double)picture.rgb[c], 1, "a value");
        assert_near((double)picture.rgb[6 + c], middle, "values are what was sampled");
        assert_near((double)picture.error[c], sqrt(own_error), "the error of a pixel without such light");
        assert_near((double)picture.error[3 + c], sqrt(own_error + weight * variance), "not found");
    }
    bp_picture_clear(&picture);
    bp_film_destroy(&film);
}

/* The error of a channel is that of the luminance in the colour of the light. */
static void the_colour_of_the_light(void **state) {
    (void)state;
    BpFilm *film = lit_film();
    const float tint[3] = {4, 0.25f, 0};
    memcpy(film->unseen->tint, tint, sizeof tint);
    const double weight = 10 / (10 + chance * 32), mean = chance * brings;
    const double variance = (chance * brings * brings - mean * mean) / 16;
    BpPicture picture;
    assert_int_equal(bp_film_picture(film, &picture, NULL), BP_OK);
    for (int c = 0; c < 3; ++c)
        assert_near((double)picture.error[3 + c], sqrt(own_error + weight * variance * (double)tint[c]),
                    "the error of a channel");
    bp_picture_clear(&picture);
    BpUnseenWeights weights;
    bp_unseen_weigh(film, &weights);
    assert_near(bp_film_squared_error(film, &weights, 1), own_error + weight * variance, "of the luminance");
    bp_film_destroy(&film);
}

/* Where no such light comes, nothing changes, to the bit; with few replicates the error stays unknown. */
static void nothing_unseen_changes_nothing(void **state) {
    (void)state;
    BpFilm *plain = lit_film(), *zero = lit_film();
    bp_unseen_destroy(&plain->unseen);
    memset(zero->unseen->pixels, 0, 3 * sizeof *zero->unseen->pixels);
    assert_true(bp_film_nrmse(plain) == bp_film_nrmse(zero));
    assert_true(bp_film_claim(plain).luminance == bp_film_claim(zero).luminance);
    assert_true(bp_film_unseen_part(plain) == 0 && bp_film_unseen_part(zero) == 0);
    BpPicture a, b;
    assert_int_equal(bp_film_picture(plain, &a, NULL), BP_OK);
    assert_int_equal(bp_film_picture(zero, &b, NULL), BP_OK);
    assert_memory_equal(a.error, b.error, 9 * sizeof *a.error);
    bp_picture_clear(&a);
    bp_picture_clear(&b);
    bp_film_destroy(&zero);
    BpFilm *few = lit_film();
    for (size_t k = 1; k < K; ++k) few->counts[K + k] = 0;
    BpUnseenWeights weights;
    bp_unseen_weigh(few, &weights);
    assert_true(isnan(bp_film_squared_error(few, &weights, 1)));
    assert_true(isnan(bp_film_nrmse(few)));
    bp_film_destroy(&few);
    bp_film_destroy(&plain);
}

/* Over many pictures with samples drawn from such light, the mean square of the claims is the true one, long
 * before and long after it is found. */
static void claims_are_true_in_the_mean(void **state) {
    (void)state;
    enum { PICTURES = 400, SIDE = 64 };
    static const uint32_t per[] = {1, 16, 256};
    static const double p = 1.0 / 4096;
    uint64_t counter = 1;
    for (size_t i = 0; i < sizeof per / sizeof per[0]; ++i) {
        double claimed = 0, truth = 0;
        for (int n = 0; n < PICTURES; ++n) {
            BpFilm *film = film_of(SIDE, per[i]);
            BpUnseenPixel *light = unseen_of(film);
            for (size_t pixel = 0; pixel < SIDE; ++pixel) {
                light[pixel] = (BpUnseenPixel){(float)(p * 1000), (float)(p * 1000 * 1000)};
                double mean = 0;
                for (size_t k = 0; k < K; ++k) {
                    double value = 0;
                    for (uint32_t s = 0; s < per[i]; ++s)
                        if (data_uniform(counter++) < p) value += 1000.0 / per[i];
                    fill(film, pixel, k, 1 + value);
                    mean += value / K;
                }
                truth += (mean - p * 1000) * (mean - p * 1000);
            }
            BpUnseenWeights weights;
            bp_unseen_weigh(film, &weights);
            for (size_t pixel = 0; pixel < SIDE; ++pixel)
                claimed += bp_film_squared_error(film, &weights, pixel);
            bp_film_destroy(&film);
        }
        /* 25,600 pixels of 4 to 1024 samples: 25 finds at least, so 20 % of the truth's mean square; */
        const double ratio = claimed / truth, allowed = i == 0 ? 0.8 : 0.25;
        if (!(fabs(ratio - 1) < allowed)) fail_msg("%u samples: claimed over true is %g", K * per[i], ratio);
    }
}

/* A pixel's own noise, far larger than that of the light that may come to it, is not taken for finds of that
 * light: claims are true where there is no such light yet, and where there is. */
static void own_noise_stays(void **state) {
    (void)state;
    enum { PICTURES = 400, SIDE = 64, PER = 16 };
    for (int lit = 0; lit < 2; ++lit) {
        uint64_t counter = 1;
        double claimed = 0, truth = 0;
        for (int n = 0; n < PICTURES; ++n) {
            BpFilm *film = film_of(SIDE, PER);
            BpUnseenPixel *light = unseen_of(film);
            /* Each find brings 2, a tenth of what a pixel's other samples bring by chance. */
            for (size_t pixel = 0; pixel < SIDE; ++pixel) {
                double mean = 0;
                light[pixel] = (BpUnseenPixel){0.002f, 0.004f};
                for (size_t k = 0; k < K; ++k) {
                    double value = 0;
                    for (uint32_t s = 0; s < PER; ++s) {
                        if (data_uniform(counter++) < 0.2) value += 20.0 / PER;
                        if (data_uniform(counter++) < 0.001 && lit) value += 2.0 / PER;
                    }
                    fill(film, pixel, k, value);
                    mean += value / K;
                }
                truth += pow(mean - 4 - (lit ? 0.002 : 0), 2);
            }
            BpUnseenWeights weights;
            bp_unseen_weigh(film, &weights);
            for (size_t pixel = 0; pixel < SIDE; ++pixel)
                claimed += bp_film_squared_error(film, &weights, pixel);
            bp_film_destroy(&film);
        }
        /* The least of two estimates is a little low. */
        if (!(claimed / truth > 0.6 && claimed / truth < 1.1))
            fail_msg("%s light: claimed over true is %g", lit ? "with" : "without", claimed / truth);
    }
}

/* ---- merging ---- */

/* A film of the samples [first, first + 8). */
static BpFilm *part(uint64_t first, bool has_unseen) {
    BpFilm *film = film_of(3, 2);
    free(film->ranges);
    film->ranges = NULL;
    film->range_count = 0;
    assert_int_equal(bp_film_add_range(film, first, 8, NULL), BP_OK);
    for (size_t pixel = 0; pixel < 3; ++pixel)
        for (size_t k = 0; k < K; ++k) fill(film, pixel, k, 1 + 0.1 * (double)((first + k + pixel) % 3));
    if (!has_unseen) return film;
    unseen_of(film)[1] = (BpUnseenPixel){0.5f, 250 + (float)first};
    film->unseen->tint[0] = 3;
    return film;
}

static char *bytes_of(const BpFilm *film, size_t *size) {
    char *bytes = NULL;
    FILE *out = open_memstream(&bytes, size);
    assert_int_equal(bp_film_write_stream(film, out, NULL), BP_OK);
    fclose(out);
    return bytes;
}

/* Whichever of two has it, and in either order: the sum has it, and is the same file. That of films whose
 * devices round differently is that of the first samples. */
static void merging_keeps_it(void **state) {
    (void)state;
    for (unsigned which = 0; which < 4; ++which) {
        const bool first = (which & 1) != 0, second = (which & 2) != 0;
        BpFilm *a = part(0, first), *b = part(8, second), *c = part(0, first), *d = part(8, second);
        assert_int_equal(bp_film_merge(a, b, NULL), BP_OK);
        assert_int_equal(bp_film_merge(d, c, NULL), BP_OK);
        assert_int_equal(a->unseen != NULL, first || second);
        if (a->unseen != NULL) {
            assert_true(a->unseen->pixels[1].square == (first ? 250 : 258));
            assert_true(a->unseen->pixels[1].mean == 0.5f && a->unseen->tint[0] == 3);
        }
        size_t one_size = 0, other_size = 0;
        char *one = bytes_of(a, &one_size), *other = bytes_of(d, &other_size);
        assert_int_equal(one_size, other_size);
        assert_memory_equal(one, other, one_size);
        assert_true(bp_film_nrmse(a) == bp_film_nrmse(d));
        free(one);
        free(other);
        bp_film_destroy(&a);
        bp_film_destroy(&b);
        bp_film_destroy(&c);
        bp_film_destroy(&d);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_of_finds),
        cmocka_unit_test(claims_by_hand),
        cmocka_unit_test(the_colour_of_the_light),
        cmocka_unit_test(nothing_unseen_changes_nothing),
        cmocka_unit_test(claims_are_true_in_the_mean),
        cmocka_unit_test(own_noise_stays),
        cmocka_unit_test(merging_keeps_it),
    };
    return cmocka_run_group_tests_name("unseen", tests, NULL, NULL);
}
