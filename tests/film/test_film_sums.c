/* test_film_sums.c: sums do not drift, merges are exact, limits hold (host/film/film.h). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "film_data.h"

#include <stdlib.h>
#include <string.h>

static BpFilm *make(uint32_t width, uint32_t height, uint32_t replicates) {
    BpFilm *film = NULL;
    assert_int_equal(bp_film_create(width, height, replicates, &film, NULL), BP_OK);
    film->scale_log2 = 36;
    film->scene_hash = 12345;
    film->seed = 7;
    film->max_depth = 50;
    return film;
}

/* Random samples [first, first + count) of every pixel, each a function of pixel and sample number alone. */
static BpFilm *render(uint64_t first, uint64_t count) {
    BpFilm *film = make(7, 5, 4);
    assert_int_equal(bp_film_add_range(film, first, count, NULL), BP_OK);
    for (size_t pixel = 0; pixel < 35; pixel++)
        for (uint64_t s = first; s < first + count; s++) {
            const uint64_t key = 3 * (pixel * 100000 + s);
            data_add(film, pixel, s,
                     (double[3]){4 * data_uniform(key), data_uniform(key + 1) / 9, data_uniform(key + 2)});
        }
    film->segments = 35 * count * 3;
    film->truncated_paths = count;
    film->invalid_samples = 7;
    film->not_finite_samples = 1;
    film->negative_samples = 2;
    film->out_of_range_samples = 4;
    film->shadow_rays = 7 * count;
    return film;
}

static void assert_same_sums(const BpFilm *a, const BpFilm *b) {
    const size_t cells = (size_t)a->width * a->height * a->replicates;
    assert_memory_equal(a->sums, b->sums, cells * 3 * sizeof *a->sums);
    assert_memory_equal(a->counts, b->counts, cells * sizeof *a->counts);
    assert_int_equal(a->range_count, b->range_count);
    assert_memory_equal(a->ranges, b->ranges, a->range_count * sizeof *a->ranges);
    assert_int_equal(a->segments, b->segments);
    assert_int_equal(a->truncated_paths, b->truncated_paths);
    assert_int_equal(a->shadow_rays, b->shadow_rays);
    const double nrmse_a = bp_film_nrmse(a), nrmse_b = bp_film_nrmse(b);
    assert_memory_equal(&nrmse_a, &nrmse_b, sizeof nrmse_a);
}

static void a_million_samples_do_not_drift(void **state) {
    (void)state;
    BpFilm *film = make(1, 1, 4);
    float naive = 0;
    for (uint64_t s = 0; s < 1000000; s++) {
        data_add(film, 0, s, (double[3]){(double)0.1f, (double)0.1f, (double)0.1f});
        naive += 0.1f;
    }
    double mean[3];
    bp_film_mean(film, mean);
    for (int c = 0; c < 3; c++) assert_true(fabs(mean[c] / 0.1 - 1) < 1e-6);
    /* The control: what a plain float sum makes of it. */
    assert_true(fabs((double)naive / 1e6 / 0.1 - 1) > 1e-3);
    /* All replicates are equal, and the error says so. */
    assert_true(bp_film_nrmse(film) < 1e-15);
    bp_film_destroy(&film);
}

static void two_halves_are_the_whole(void **state) {
    (void)state;
    BpFilm *whole = render(0, 66), *first = render(0, 31), *second = render(31, 35);
    assert_int_equal(bp_film_merge(first, second, NULL), BP_OK);
    assert_same_sums(first, whole);
    assert_int_equal(first->range_count, 1);
    assert_int_equal(first->invalid_samples, 14);
    assert_int_equal(first->not_finite_samples, 2);
    assert_int_equal(first->negative_samples, 4);
    assert_int_equal(first->out_of_range_samples, 8);
    bp_film_destroy(&whole);
    bp_film_destroy(&first);
    bp_film_destroy(&second);
}

static void the_order_of_merges_does_not_matter(void **state) {
    (void)state;
    static const uint64_t parts[4][2] = {{0, 3}, {3, 40}, {100, 9}, {50, 21}};
    static const int orders[3][4] = {{0, 1, 2, 3}, {3, 2, 1, 0}, {2, 0, 3, 1}};
    BpFilm *results[3];
    for (int o = 0; o < 3; o++) {
        results[o] = render(parts[orders[o][0]][0], parts[orders[o][0]][1]);
        for (int i = 1; i < 4; i++) {
            BpFilm *part = render(parts[orders[o][i]][0], parts[orders[o][i]][1]);
            assert_int_equal(bp_film_merge(results[o], part, NULL), BP_OK);
            bp_film_destroy(&part);
        }
    }
    assert_int_equal(results[0]->range_count, 3);
    assert_int_equal(results[0]->ranges[1].first, 50);
    assert_int_equal(bp_film_range_total(results[0]), 73);
    assert_same_sums(results[0], results[1]);
    assert_same_sums(results[0], results[2]);
    for (int o = 0; o < 3; o++) bp_film_destroy(&results[o]);
}

/* A merge that must fail, saying `reason`, and leave `into` as it was. */
/* What is no sum: depth, normal and albedo are those of the film with the first samples, whichever comes
 * first; a plan and path lengths belong to one render; a job stays until it is whole. */
static void what_is_no_sum(void **state) {
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        BpFilm *early = render(10, 4), *late = render(20, 4), *none = render(14, 6);
        BpFilm *films[2] = {turned ? late : early, turned ? early : late};
        for (int f = 0; f < 2; f++) {
            assert_int_equal(bp_film_add_aovs(films[f], NULL), BP_OK);
            films[f]->depth[3] = films[f] == early ? 1.5f : 2.5f;
            films[f]->normal[104] = films[f] == early ? 0.25f : 0.5f;
            films[f]->albedo[0] = films[f] == early ? 0.125f : 0.75f;
            films[f]->plan = calloc(1, sizeof *films[f]->plan);
            films[f]->plan->decisions = malloc(1);
            films[f]->pixel_segments = calloc(35, sizeof *films[f]->pixel_segments);
            films[f]->job = (struct BpSampleRange){10, 14};
        }
        none->job = films[0]->job;
        assert_int_equal(bp_film_merge(films[0], films[1], NULL), BP_OK);
        assert_true(films[0]->depth[3] == 1.5f && films[0]->normal[104] == 0.25f &&
                    films[0]->albedo[0] == 0.125f);
        assert_null(films[0]->plan);
        assert_null(films[0]->pixel_segments);
        assert_int_equal(films[0]->job.count, 14);
        /* A film without them takes them over. */
        assert_int_equal(bp_film_merge(none, films[0], NULL), BP_OK);
        assert_true(bp_film_has_aovs(none) && none->depth[3] == 1.5f);
        assert_int_equal(none->job.count, 0); /* all of it is there now */
        bp_film_destroy(&early);
        bp_film_destroy(&late);
        bp_film_destroy(&none);
    }
    BpFilm *one = render(0, 2), *other = render(2, 2);
    one->job = (struct BpSampleRange){0, 8};
    other->job = (struct BpSampleRange){0, 9};
    assert_int_equal(bp_film_merge(one, other, NULL), BP_OK);
    assert_int_equal(one->job.count, 0);
    bp_film_destroy(&one);
    bp_film_destroy(&other);
}

static void refuse_merge(BpFilm *into, const BpFilm *from, BpStatus expected, const char *reason) {
    const BpFilm before = *into;
    const int64_t sum = into->sums[0];
    const uint32_t count = into->counts[0];
    BpError err = {0};
    assert_int_equal(bp_film_merge(into, from, &err), expected);
    bp_error_add_remedy(&err, BP_INTERFACE_COMMAND_LINE);
    if (strstr(err.message, reason) == NULL) fail_msg("'%s' does not say '%s'", err.message, reason);
    assert_int_equal(into->range_count, before.range_count);
    assert_ptr_equal(into->fine_sums, before.fine_sums);
    assert_int_equal(into->segments, before.segments);
    assert_int_equal(into->sums[0], sum);
    assert_int_equal(into->counts[0], count);
}

/* The rays that met something are counted, and the picture's alpha is their share of all; a film that has no
 * such counts is of another scene. */
static void alpha_is_added(void **state) {
    (void)state;
    BpFilm *one = render(0, 4), *other = render(4, 8), *none = render(12, 2);
    assert_int_equal(bp_film_add_met(one, NULL), BP_OK);
    assert_int_equal(bp_film_add_met(other, NULL), BP_OK);
    for (size_t pixel = 0; pixel < 35; pixel++) {
        one->met[pixel] = pixel % 5;
        other->met[pixel] = pixel % 9;
    }
    refuse_merge(one, none, BP_ERR_USAGE, "one has an alpha and the other has none");
    refuse_merge(none, one, BP_ERR_USAGE, "one has an alpha and the other has none");
    assert_int_equal(bp_film_merge(one, other, NULL), BP_OK);
    BpPicture picture;
    assert_int_equal(bp_film_picture(one, &picture, NULL), BP_OK);
    for (size_t pixel = 0; pixel < 35; pixel++) {
        assert_int_equal(one->met[pixel], pixel % 5 + pixel % 9);
        assert_true(picture.samples[pixel] == 12);
        assert_true(picture.alpha[pixel] == (float)((double)one->met[pixel] / 12));
    }
    bp_picture_clear(&picture);
    assert_int_equal(bp_film_picture(none, &picture, NULL), BP_OK);
    assert_null(picture.alpha);
    bp_picture_clear(&picture);
    bp_film_destroy(&one);
    bp_film_destroy(&other);
    bp_film_destroy(&none);
}

static void what_differs_is_named(void **state) {
    (void)state;
    BpFilm *a = render(0, 8), *b = render(8, 8);
#define DIFFER(field, value, reason)                                                                         \
    do {                                                                                                     \
        const BpFilm kept = *b;                                                                              \
        b->field = value;                                                                                    \
        refuse_merge(a, b, BP_ERR_USAGE, reason);                                                            \
        *b = kept;                                                                                           \
    } while (0)
    DIFFER(width, 5, "widths differ (7 and 5");
    DIFFER(height, 7, "heights differ (5 and 7");
    DIFFER(replicates, 2, "replicates differ (4 and 2");
    DIFFER(scale_log2, -3, "scales differ (2^36 and 2^-3");
    DIFFER(scene_hash, 1, "scenes differ");
    DIFFER(seed, 8, "seeds differ (7 and 8)");
    DIFFER(max_depth, 5, "depths differ (50 and 5); use the same --depth");
    DIFFER(sampler, 1, "); use the same --sampler");
    DIFFER(precision, 1, "); use the same --precision");
    DIFFER(math, 1, "); use the same --math");
    DIFFER(numerics, 1, "); use the same --numerics");
    DIFFER(transfer, 1, "transfer curves differ (gamma2 and srgb)");
#undef DIFFER
    BpFilm *fine = render(7, 8); /* what it has and the first has not is not left there either */
    assert_int_equal(bp_film_add_fine_sums(fine, NULL), BP_OK);
    refuse_merge(a, fine, BP_ERR_USAGE, "samples 0 to 7 and 7 to 14 overlap");
    bp_film_destroy(&fine);
    refuse_merge(a, a, BP_ERR_USAGE, "samples 0 to 7 and 0 to 7 overlap, so these samples would count twice");
    assert_int_equal(bp_film_merge(a, b, NULL), BP_OK); /* nothing else was wrong */
    bp_film_destroy(&b);
    b = render(15, 8);
    refuse_merge(a, b, BP_ERR_USAGE,
                 "samples 0 to 15 and 15 to 22 overlap, so these samples would count twice");
    bp_film_destroy(&a);
    bp_film_destroy(&b);
}

static void ranges_join_and_overlaps_are_refused(void **state) {
    (void)state;
    BpFilm *a = make(1, 1, 4);
    assert_int_equal(bp_film_add_range(a, 10, 5, NULL), BP_OK);
    assert_int_equal(bp_film_add_range(a, 20, 5, NULL), BP_OK);
    assert_int_equal(bp_film_add_range(a, 0, 5, NULL), BP_OK);
    assert_int_equal(a->range_count, 3);
    assert_int_equal(bp_film_add_range(a, 14, 1, NULL), BP_ERR_USAGE);
    assert_int_equal(bp_film_add_range(a, 9, 2, NULL), BP_ERR_USAGE);
    assert_int_equal(bp_film_add_range(a, 0, 100, NULL), BP_ERR_USAGE);
    assert_int_equal(bp_film_add_range(a, 7, 0, NULL), BP_ERR_USAGE);
    assert_int_equal(bp_film_add_range(a, UINT64_C(1) << 32, 1, NULL), BP_ERR_USAGE);
    assert_int_equal(bp_film_add_range(a, 30, UINT64_MAX, NULL), BP_ERR_USAGE);
    assert_int_equal(bp_film_add_range(a, (UINT64_C(1) << 32) - 1, 1, NULL), BP_OK);
    assert_int_equal(a->range_count, 4);
    assert_int_equal(bp_film_add_range(a, 15, 5, NULL), BP_OK);
    assert_int_equal(bp_film_add_range(a, 5, 5, NULL), BP_OK);
    assert_int_equal(a->range_count, 2);
    assert_int_equal(a->ranges[0].count, 25);
    /* 0 to 24 and 2^32 - 1: replicate 0 has 0, 4, .. 24, replicate 3 has 3, 7, .. 23 and the last */
    assert_int_equal(bp_film_expected(a, 0), 7);
    assert_int_equal(bp_film_expected(a, 1), 6);
    assert_int_equal(bp_film_expected(a, 3), 7);
    bp_film_destroy(&a);
}

static void overflow_is_out_of_reach(void **state) {
    (void)state;
    BpFilm *a = make(1, 1, 4), *b = make(1, 1, 4);
    BpError err = {0};
    const uint64_t most = UINT64_C(4) * BP_REPLICATE_SAMPLES_MAX;
    assert_int_equal(bp_film_add_range(a, 0, most + 1, &err), BP_ERR_LIMIT);
    assert_non_null(strstr(err.message, "16777217 samples in one replicate"));
    assert_int_equal(bp_film_add_range(a, 0, most, &err), BP_OK);
    assert_int_equal(bp_film_add_range(a, most, 1, &err), BP_ERR_LIMIT);
    assert_int_equal(bp_film_add_range(b, most, 1, &err), BP_OK);
    refuse_merge(a, b, BP_ERR_LIMIT, "in one replicate");
    bp_film_destroy(&a);

    /* Sums that no render makes. */
    a = make(1, 1, 4);
    assert_int_equal(bp_film_add_range(a, 0, 4, &err), BP_OK);
    a->sums[11] = INT64_MAX;
    b->sums[11] = 1;
    refuse_merge(a, b, BP_ERR_LIMIT, "overflow");
    a->sums[11] = INT64_MIN;
    b->sums[11] = -1;
    refuse_merge(a, b, BP_ERR_LIMIT, "overflow");
    b->sums[11] = 1;
    /* Nor totals, which a file holds in 63 bits. */
    uint64_t *const totals[] = {&a->segments, &a->truncated_paths, &a->invalid_samples, &a->shadow_rays};
    b->segments = b->truncated_paths = b->invalid_samples = b->shadow_rays = 1;
    for (size_t i = 0; i < sizeof totals / sizeof totals[0]; i++) {
        *totals[i] = INT64_MAX;
        refuse_merge(a, b, BP_ERR_LIMIT, "overflow 63 bits");
        *totals[i] = INT64_MAX - 1;
    }
    assert_int_equal(bp_film_merge(a, b, &err), BP_OK);
    bp_film_destroy(&a);
    bp_film_destroy(&b);
}

static void sizes_are_checked(void **state) {
    (void)state;
    BpFilm *a = NULL;
    assert_int_equal(bp_film_create(0, 1, 1, &a, NULL), BP_ERR_LIMIT);
    assert_int_equal(bp_film_create(1, 65536, 1, &a, NULL), BP_ERR_LIMIT);
    assert_int_equal(bp_film_create(1, 1, 0, &a, NULL), BP_ERR_LIMIT);
    assert_int_equal(bp_film_create(1, 1, 65, &a, NULL), BP_ERR_LIMIT);
    assert_null(a);
    bp_film_destroy(&a);
    bp_film_destroy(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_million_samples_do_not_drift),
        cmocka_unit_test(two_halves_are_the_whole),
        cmocka_unit_test(the_order_of_merges_does_not_matter),
        cmocka_unit_test(what_is_no_sum),
        cmocka_unit_test(alpha_is_added),
        cmocka_unit_test(what_differs_is_named),
        cmocka_unit_test(ranges_join_and_overlaps_are_refused),
        cmocka_unit_test(overflow_is_out_of_reach),
        cmocka_unit_test(sizes_are_checked),
    };
    return cmocka_run_group_tests_name("film_sums", tests, NULL, NULL);
}
