/* test_bits.c: what the hash of a picture depends on, and how a difference is measured. */
#include "check/bits.h"
#include "support/unit_test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 4, HEIGHT = 3, PIXELS = WIDTH * HEIGHT, REPLICATES = 2, CELLS = PIXELS * REPLICATES };

/* Every pixel has 4 samples and a radiance of its own. */
static BpFilm *film_of(void) {
    BpFilm *film = NULL;
    assert_int_equal(bp_film_create(WIDTH, HEIGHT, REPLICATES, &film, NULL), BP_OK);
    film->scale_log2 = 20;
    for (int i = 0; i < CELLS; ++i) film->counts[i] = 2;
    for (int i = 0; i < 3 * CELLS; ++i) film->sums[i] = ((int64_t)1 << 20) + i * 1000;
    return film;
}

static bool same_hash(const BpFilm *a, const BpFilm *b) {
    char one[17], other[17];
    bp_bits_hash(a, one);
    bp_bits_hash(b, other);
    assert_int_equal(strlen(one), 16);
    return strcmp(one, other) == 0;
}

static void every_sum_and_count_matters(void **state) {
    (void)state;
    BpFilm *a = film_of(), *b = film_of();
    assert_true(same_hash(a, b));
    for (int i = 0; i < 3 * CELLS; ++i) {
        ++b->sums[i];
        assert_false(same_hash(a, b));
        --b->sums[i];
    }
    for (int i = 0; i < CELLS; ++i) {
        ++b->counts[i];
        assert_false(same_hash(a, b));
        --b->counts[i];
    }
    assert_int_equal(bp_film_add_fine_sums(b, NULL), BP_OK);
    assert_true(same_hash(a, b)); /* zeros are as good as none */
    for (int i = 0; i < 3 * CELLS; ++i) {
        b->fine_sums[i] = -1;
        assert_false(same_hash(a, b));
        b->fine_sums[i] = 0;
    }
    const int64_t first = b->sums[0]; /* the order of pixels */
    b->sums[0] = b->sums[3];
    b->sums[3] = first;
    assert_false(same_hash(a, b));
    bp_film_destroy(&a);
    bp_film_destroy(&b);
}

/* The same on every machine: recorded hashes come from others. */
static void the_hash_is_this_one(void **state) {
    (void)state;
    BpFilm *film = film_of();
    char hash[17];
    bp_bits_hash(film, hash);
    assert_string_equal(hash, "3fc308685b274733");
    bp_film_destroy(&film);
}

static BpBitsDifference compare(const BpFilm *film, const BpFilm *recorded) {
    char hash[17], *radiance = bp_bits_radiance(recorded);
    BpBitsDifference difference;
    bp_bits_hash(recorded, hash);
    assert_non_null(radiance);
    assert_int_equal(strlen(radiance), PIXELS * 3 * 8);
    assert_int_equal(bp_bits_compare(film, hash, radiance, &difference, NULL), BP_OK);
    free(radiance);
    assert_int_equal(difference.pixels, PIXELS);
    return difference;
}

/* Adds `steps` to the sum of a pixel's green. */
static void change(BpFilm *film, int pixel, int64_t steps) {
    film->sums[3 * (REPLICATES * pixel) + 1] += steps;
}

static void kinds_of_differences(void **state) {
    (void)state;
    BpFilm *old = film_of(), *film = film_of();
    assert_int_equal(compare(film, old).kind, BP_BITS_SAME);

    assert_int_equal(bp_film_add_fine_sums(film, NULL), BP_OK); /* less than a float shows */
    film->fine_sums[7] = 1;
    BpBitsDifference found = compare(film, old);
    assert_true(found.kind == BP_BITS_ROUNDING && found.different == 0 && found.largest == 0);

    change(film, 2, 8);
    found = compare(film, old);
    assert_true(found.kind == BP_BITS_ROUNDING && found.different == 1);
    assert_true(found.largest > 1e-6 && found.largest < BP_BITS_ROUNDING_MAX);
    assert_true(fabs(found.mean) < 1e-6);

    change(film, 5, 1 << 20);
    found = compare(film, old);
    assert_true(found.kind == BP_BITS_PATHS && found.different == 2);
    assert_true(found.largest > 0.4 && found.largest < 0.6); /* a quarter of a sample, over 0.5 */
    assert_true(found.mean > 0.02 && found.mean < 0.04);

    for (int pixel = 6; pixel < PIXELS; ++pixel) change(film, pixel, 1 << 20);
    found = compare(film, old);
    assert_true(found.kind == BP_BITS_PICTURE && found.different == 8);

    for (int k = 0; k < REPLICATES; ++k) film->counts[k] = 0; /* a pixel without samples */
    assert_true(isinf(compare(film, old).largest));
    bp_film_destroy(&old);
    bp_film_destroy(&film);
}

static void damaged_recordings(void **state) {
    (void)state;
    BpFilm *film = film_of();
    BpBitsDifference difference;
    BpError err = {0};
    char *radiance = bp_bits_radiance(film);
    assert_int_equal(bp_bits_compare(film, "0", radiance + 8, &difference, &err), BP_ERR_FILE);
    assert_non_null(strstr(err.message, "4 x 3 pixels"));
    radiance[9] = 'g';
    assert_int_equal(bp_bits_compare(film, "0", radiance, &difference, &err), BP_ERR_FILE);
    free(radiance);
    bp_error_clear(&err);
    bp_film_destroy(&film);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_sum_and_count_matters), cmocka_unit_test(the_hash_is_this_one),
        cmocka_unit_test(kinds_of_differences), cmocka_unit_test(damaged_recordings)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
