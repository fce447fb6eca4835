/* test_adaptive.c: passes on made-up samples: the budget is kept, samples go where the error is, and nothing
 * that a pixel's samples bring decides about how many it gets. */
#include "film_data.h"

#include "film/adaptive.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 44, HEIGHT = 30, PIXELS = WIDTH * HEIGHT, REPLICATES = 4 };

/* Radiance of one sample: 0, or rarely something bright; the mean is 1 everywhere. The picture's right side
 * has rarer, brighter samples, hence more noise. */
static double draw(uint64_t seed, size_t pixel, uint64_t sample, double rare) {
    const double share = pixel % WIDTH < WIDTH / 2 ? 0.5 : rare;
    return data_uniform((seed << 40) + ((uint64_t)pixel << 20) + sample) < share ? 1 / share : 0;
}

typedef struct Run {
    BpFilm *film, *shown; /* shown to the planner: the same, or with neighbours exchanged */
    BpAdaptive *adaptive;
    uint64_t seeds[2]; /* of black and of white pixels */
    uint64_t counts[PIXELS];
    bool exchanged;
    double rare; /* share of the samples on the right side that are bright */
} Run;

static unsigned colour_of(size_t pixel) {
    return (unsigned)(pixel % WIDTH + pixel / WIDTH) & 1;
}

static void sample_pixel(Run *run, size_t pixel, uint64_t first, uint64_t count) {
    assert_int_equal(run->counts[pixel], first); /* no gap, nothing twice */
    for (uint64_t s = first; s < first + count; s++) {
        const double x = draw(run->seeds[colour_of(pixel)], pixel, s, run->rare);
        const double rgb[3] = {x, x, x};
        data_add(run->film, pixel, s, rgb);
        data_add(run->shown, run->exchanged ? pixel ^ 1 : pixel, s, rgb);
        /* Paths of 1 to 4 segments. */
        run->shown->pixel_segments[run->exchanged ? pixel ^ 1 : pixel] +=
            1 + data_bits((run->seeds[colour_of(pixel)] << 40) + ((uint64_t)pixel << 20) + s) % 4;
    }
    run->counts[pixel] += count;
}

static void run_open(Run *run, uint64_t black, uint64_t white, bool exchanged, double rare) {
    memset(run, 0, sizeof *run);
    run->seeds[0] = black;
    run->seeds[1] = white;
    run->exchanged = exchanged;
    run->rare = rare;
    assert_int_equal(bp_film_create(WIDTH, HEIGHT, REPLICATES, &run->film, NULL), BP_OK);
    assert_int_equal(bp_film_create(WIDTH, HEIGHT, REPLICATES, &run->shown, NULL), BP_OK);
    run->shown->pixel_segments = calloc(PIXELS, sizeof *run->shown->pixel_segments);
    assert_non_null(run->shown->pixel_segments);
    run->film->scale_log2 = run->shown->scale_log2 = 30;
    assert_int_equal(bp_adaptive_create(WIDTH, HEIGHT, 1u << 26, &run->adaptive, NULL), BP_OK);
    for (size_t pixel = 0; pixel < PIXELS; pixel++) sample_pixel(run, pixel, 0, BP_ADAPTIVE_FIRST);
}

static void run_close(Run *run) {
    bp_film_destroy(&run->film);
    bp_film_destroy(&run->shown);
    bp_adaptive_destroy(&run->adaptive);
}

/* Passes up to a mean of `samples`; checks that they are passes. */
static void run_to(Run *run, uint64_t samples) {
    for (int passes = 0;; passes++) {
        bool more = false;
        BpAdaptivePass pass;
        assert_true(passes < 64);
        assert_int_equal(bp_adaptive_next(run->adaptive, run->shown, samples, &more, &pass, NULL), BP_OK);
        if (!more) break;
        assert_true(pass.pixel_count > 0 && pass.pixel_count <= PIXELS);
        for (uint32_t i = 0; i < pass.pixel_count; i++) {
            if (i > 0) assert_true(pass.pixels[i] > pass.pixels[i - 1]);
            sample_pixel(run, pass.pixels[i], pass.first, pass.count);
        }
    }
    uint64_t total = 0, most = 0;
    for (size_t pixel = 0; pixel < PIXELS; pixel++) {
        total += run->counts[pixel];
        if (run->counts[pixel] > most) most = run->counts[pixel];
    }
    assert_int_equal(total, bp_adaptive_samples(run->adaptive));
    assert_int_equal(most, bp_adaptive_samples_max(run->adaptive));
}

static double mean_count(const Run *run, size_t from, size_t to) {
    double total = 0;
    for (size_t pixel = 0; pixel < PIXELS; pixel++)
        if (pixel % WIDTH >= from && pixel % WIDTH < to) total += (double)run->counts[pixel];
    return total / (double)(HEIGHT * (to - from));
}

static void budget_is_kept(void **state) {
    (void)state;
    for (uint64_t samples = 16; samples < 3000; samples += samples / 3) {
        Run run;
        run_open(&run, 1, 2, false, 0.05);
        run_to(&run, samples);
        const double mean = mean_count(&run, 0, WIDTH);
        assert_true(mean <= (double)samples);
        assert_true(mean >
                    0.85 * (double)samples); /* 30 tiles: a last step may be too large for what is left */
        for (size_t pixel = 0; pixel < PIXELS; pixel++)
            assert_true(run.counts[pixel] >= 16 && 8 * run.counts[pixel] > samples);
        run_close(&run);
    }
}

static void samples_go_where_the_error_is(void **state) {
    (void)state;
    Run run;
    run_open(&run, 1, 2, false, 0.05);
    run_to(&run, 256);
    /* Variances 1 and 19: counts in the ratio of their roots, 4.4, but for powers of two. */
    const double ratio = mean_count(&run, WIDTH / 2 + 4, WIDTH) / mean_count(&run, 0, WIDTH / 2 - 4);
    assert_true(ratio > 3 && ratio < 6.5);
    run_to(&run, 1024);
    assert_true(mean_count(&run, 0, WIDTH) > 900);
    run_close(&run);
}

static void equal_errors_get_equal_counts(void **state) {
    (void)state;
    BpFilm *film = NULL;
    BpAdaptive *adaptive = NULL;
    bool more = true;
    BpAdaptivePass pass;
    assert_int_equal(bp_film_create(WIDTH, HEIGHT, REPLICATES, &film, NULL), BP_OK);
    for (size_t i = 0; i < PIXELS * REPLICATES; i++) film->counts[i] = 4; /* black, all of it */
    assert_int_equal(bp_adaptive_create(WIDTH, HEIGHT, 1u << 26, &adaptive, NULL), BP_OK);
    for (uint64_t have = 16; have < 128; have *= 2) {
        assert_int_equal(bp_adaptive_next(adaptive, film, 128, &more, &pass, NULL), BP_OK);
        assert_true(more);
        assert_int_equal(pass.pixel_count, PIXELS);
        assert_int_equal(pass.first, have);
        assert_int_equal(pass.count, have);
    }
    assert_int_equal(bp_adaptive_next(adaptive, film, 128, &more, &pass, NULL), BP_OK);
    assert_false(more);
    bp_adaptive_destroy(&adaptive);
    bp_film_destroy(&film);
}

/* The proof that there is no bias: other samples in the black pixels change no black pixel's count, whatever
 * they do to the white ones, round after round; and the other way about. */
static void own_samples_decide_nothing(void **state) {
    (void)state;
    static const uint64_t rounds[] = {40, 64, 100, 260, 300, 1100};
    Run first, black, white;
    run_open(&first, 1, 2, false, 0.05);
    run_open(&black, 3, 2, false, 0.05);
    run_open(&white, 1, 4, false, 0.05);
    int changed = 0;
    for (size_t r = 0; r < sizeof rounds / sizeof rounds[0]; r++) {
        run_to(&first, rounds[r]);
        run_to(&black, rounds[r]);
        run_to(&white, rounds[r]);
        for (size_t pixel = 0; pixel < PIXELS; pixel++) {
            const Run *other = colour_of(pixel) == 0 ? &black : &white,
                      *rest = colour_of(pixel) == 0 ? &white : &black;
            assert_int_equal(first.counts[pixel], other->counts[pixel]);
            changed += first.counts[pixel] != rest->counts[pixel];
        }
    }
    assert_true(changed > 1000); /* or the test would show nothing */
    run_close(&first);
    run_close(&black);
    run_close(&white);
}

/* Mean over seeds and pixels, which should be 1, in standard errors. */
static double deviation(bool exchanged, double *mean) {
    enum { SEEDS = 600 };
    double sum = 0, square = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        Run run;
        run_open(&run, seed + 1000, seed + 1000, exchanged, 0.004);
        run_to(&run, 48);
        double means[3];
        bp_film_mean(run.film, means);
        sum += means[0];
        square += means[0] * means[0];
        run_close(&run);
    }
    *mean = sum / SEEDS;
    return (*mean - 1) / sqrt((square / SEEDS - *mean * *mean) / (SEEDS - 1));
}

static void no_bias(void **state) {
    (void)state;
    double mean = 0, wrong = 0;
    const double z = deviation(false, &mean), z_wrong = deviation(true, &wrong);
    print_message("mean %.5f (%.1f standard errors off); decided by a pixel's own samples: %.5f (%.1f)\n",
                  mean, z, wrong, z_wrong);
    assert_true(fabs(z) < 4);
    assert_true(z_wrong < -5); /* the test sees a bias where there is one */
}

static void odd_sizes(void **state) {
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {1, 9}, {7, 1}, {8, 8}, {17, 3}, {2, 2}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        const size_t pixels = (size_t)sizes[i][0] * sizes[i][1];
        BpFilm *film = NULL;
        BpAdaptive *adaptive = NULL;
        bool more = true;
        BpAdaptivePass pass;
        assert_int_equal(bp_film_create(sizes[i][0], sizes[i][1], REPLICATES, &film, NULL), BP_OK);
        for (size_t p = 0; p < pixels; p++)
            for (uint64_t s = 0; s < 16; s++) {
                const double x = draw(5, p, s, 0.05);
                data_add(film, p, s, (const double[3]){x, x, x});
            }
        assert_int_equal(bp_adaptive_create(sizes[i][0], sizes[i][1], 100, &adaptive, NULL), BP_OK);
        for (int passes = 0; more; passes++) {
            assert_true(passes < 20);
            assert_int_equal(bp_adaptive_next(adaptive, film, 90, &more, &pass, NULL), BP_OK);
        }
        assert_true(bp_adaptive_samples(adaptive) <= 90 * pixels);
        assert_true(bp_adaptive_samples_max(adaptive) <= 100); /* the most that was allowed */
        bp_adaptive_destroy(&adaptive);
        bp_film_destroy(&film);
    }
}

/* Decisions that are restored take the place of others, further ones too, and lead to the same passes. */
static void restored_over_others(void **state) {
    (void)state;
    static Run saved, other;
    uint8_t *bytes = NULL, *again = NULL;
    size_t size = 0, size_again = 0;
    bool more = false;
    BpAdaptivePass pass, pass_again;
    run_open(&saved, 1, 2, false, 0.05);
    run_open(&other, 3, 4, true, 0.01);
    run_to(&saved, 64);
    run_to(&other, 512);
    assert_int_equal(bp_adaptive_save(saved.adaptive, &bytes, &size, NULL), BP_OK);
    assert_int_equal(bp_adaptive_restore(other.adaptive, bytes, size, NULL), BP_OK);
    assert_int_equal(bp_adaptive_save(other.adaptive, &again, &size_again, NULL), BP_OK);
    assert_int_equal(size, size_again);
    assert_memory_equal(bytes, again, size);
    assert_int_equal(bp_adaptive_samples(other.adaptive), bp_adaptive_samples(saved.adaptive));
    assert_int_equal(bp_adaptive_next(saved.adaptive, saved.shown, 256, &more, &pass, NULL), BP_OK);
    assert_true(more);
    assert_int_equal(bp_adaptive_next(other.adaptive, saved.shown, 256, &more, &pass_again, NULL), BP_OK);
    assert_true(more);
    assert_int_equal(pass.pixel_count, pass_again.pixel_count);
    assert_memory_equal(pass.pixels, pass_again.pixels, pass.pixel_count * sizeof *pass.pixels);
    assert_true(pass.first == pass_again.first && pass.count == pass_again.count);
    free(bytes);
    free(again);
    run_close(&saved);
    run_close(&other);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(budget_is_kept),
        cmocka_unit_test(samples_go_where_the_error_is),
        cmocka_unit_test(equal_errors_get_equal_counts),
        cmocka_unit_test(own_samples_decide_nothing),
        cmocka_unit_test(no_bias),
        cmocka_unit_test(odd_sizes),
        cmocka_unit_test(restored_over_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
