/* film_sample.h: one film for the tests of .bpa files. */
#ifndef BP_TEST_ACCUMULATOR_SAMPLE_H
#define BP_TEST_ACCUMULATOR_SAMPLE_H

#include "support/output_temp.h"

#include "film_data.h"

/* Small, with numbers that need all their bits. */
static BpFilm *make(void) {
    BpFilm *a = NULL;
    assert_int_equal(bp_film_create(5, 3, 4, &a, NULL), BP_OK);
    a->scale_log2 = -20;
    a->scene_hash = 0xfedcba9876543210u;
    a->seed = UINT64_MAX;
    a->max_depth = 50;
    a->sampler = BP_SAMPLER_SOBOL;
    a->precision = BP_PRECISION_DOUBLE;
    a->math = BP_MATH_FAST;
    a->numerics = BP_NUMERICS_PLAIN;
    a->transfer = BP_TRANSFER_SRGB;
    a->partial = true;
    a->segments = UINT64_C(1) << 60;
    a->truncated_paths = 3;
    a->invalid_samples = 20 + 300 + 4000;
    a->not_finite_samples = 20;
    a->negative_samples = 300;
    a->out_of_range_samples = 4000;
    a->shadow_rays = (UINT64_C(1) << 59) + 1;
    a->title = strdup("A \"title\",\nwith Gr\xc3\xbc\xc3\x9f"
                      "en");
    assert_int_equal(bp_film_add_range(a, 0, 9, NULL), BP_OK);
    assert_int_equal(bp_film_add_range(a, (UINT64_C(1) << 32) - 2, 2, NULL), BP_OK);
    assert_int_equal(bp_film_add_fine_sums(a, NULL), BP_OK);
    a->coarse = true;
    for (size_t cell = 0; cell < 60; cell++) {
        a->counts[cell] = cell % 7 == 0 ? 0 : 1 + (uint32_t)(cell % 2);
        for (size_t c = 0; c < 3 && a->counts[cell] > 0; c++)
            a->sums[3 * cell + c] = (int64_t)(data_bits(3 * cell + c) >> 2),
                               a->fine_sums[3 * cell + c] = (int64_t)(data_bits(1000 + 3 * cell + c) >> 2);
    }
    a->job = (struct BpSampleRange){0, UINT64_C(1) << 32};
    assert_int_equal(bp_film_add_met(a, NULL), BP_OK);
    for (size_t i = 0; i < 15; i++) a->met[i] = i % 3 + 1; /* no pixel has fewer samples than 3 */
    a->pixel_segments = calloc(15, sizeof *a->pixel_segments);
    assert_int_equal(bp_film_add_aovs(a, NULL), BP_OK);
    for (size_t i = 0; i < 45; i++) {
        a->pixel_segments[i / 3] = data_bits(2000 + i);
        a->depth[i / 3] = i % 5 == 0 ? INFINITY : (float)data_normal(3000 + i);
        a->normal[i] = (float)data_normal(4000 + i);
        a->albedo[i] = (float)data_uniform(5000 + i);
    }
    assert_int_equal(bp_unseen_create(15, &a->unseen, NULL), BP_OK);
    for (size_t i = 0; i < 15; i++)
        a->unseen->pixels[i] =
            (BpUnseenPixel){i % 4 == 0 ? 0 : (float)data_uniform(7000 + i), (float)data_uniform(8000 + i)};
    for (size_t c = 0; c < 3; c++) a->unseen->tint[c] = (float)data_uniform(9000 + c);
    a->plan = calloc(1, sizeof *a->plan);
    *a->plan = (BpFilmPlan){.adaptive = true,
                            .ended = true,
                            .first_sample = 2,
                            .target = 1000,
                            .done = 7,
                            .pass_samples = 3,
                            .next_pixel = 14,
                            .samples_max = 5000,
                            .error = 0.125,
                            .decisions = malloc(50),
                            .decision_bytes = 50};
    for (size_t i = 0; i < 50; i++) a->plan->decisions[i] = (uint8_t)data_bits(6000 + i);
    return a;
}

#endif
