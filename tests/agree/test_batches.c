/* test_batches.c: are the samples of different pixels, and of different seeds, independent of each other?
 *
 * 32 seeds render the same picture. The variance of a block's mean between seeds must be what the spread of
 * the samples within pixels predicts: their ratio, pooled over 64 blocks, is 1 with 31 * 64 degrees of
 * freedom. Pixels that share random numbers raise it, samples of a pixel that repel each other lower it. */
#include "check/check.h"
#include "reference/reference.h"
#include "reference/vec.h"
#include "support/build_scene.h"
#include "support/distributions.h"
#include "support/open_render.h"
#include "support/unit_test.h"

#include <math.h>
#include <stdio.h>

enum { SEEDS = 32, SIDE = 64, BLOCKS_SIDE = 8, BLOCKS = BLOCKS_SIDE * BLOCKS_SIDE, SAMPLES = 16 };
static const double level = 1e-4;

typedef struct Batches {
    double mean[SEEDS][BLOCKS],
        variance[SEEDS][BLOCKS]; /* of block means; the variance predicted from within */
} Batches;

/* Between over within, pooled. */
static double pooled_ratio(const Batches *batches) {
    double ratio = 0;
    for (int b = 0; b < BLOCKS; ++b) {
        double sum = 0, square = 0, within = 0;
        for (int s = 0; s < SEEDS; ++s) {
            sum += batches->mean[s][b];
            within += batches->variance[s][b] / SEEDS;
        }
        for (int s = 0; s < SEEDS; ++s) square += pow(batches->mean[s][b] - sum / SEEDS, 2);
        ratio += square / (SEEDS - 1) / within / BLOCKS;
    }
    return ratio;
}

static void limits(double *low, double *high) {
    const double degrees = (SEEDS - 1) * BLOCKS;
    *low = chi_square_upper_quantile(1 - level / 2, degrees) / degrees;
    *high = chi_square_upper_quantile(level / 2, degrees) / degrees;
}

static void collect(const BpSums *sums, int seed, Batches *batches) {
    const int step = SIDE / BLOCKS_SIDE;
    for (int p = 0; p < SIDE * SIDE; ++p) {
        const BpPixelSums *pixel = &sums->pixels[p];
        const int block = p / SIDE / step * BLOCKS_SIDE + p % SIDE / step;
        const double n = (double)pixel->count, mean = pixel->sum[BP_SUMS_LUMINANCE] / n;
        const double spread = fmax(0, pixel->sum2[BP_SUMS_LUMINANCE] / n - mean * mean) / (n - 1);
        batches->mean[seed][block] += mean / (step * step);
        batches->variance[seed][block] += spread / pow(step, 4);
    }
}

/* Noise in every block: a matte ground, balls, a sky that changes with height. */
static void noisy_scene(BuiltScene *built) {
    built_scene_init(built);
    BpMaterial *metal;
    built_material(built, BP_MATERIAL_LAMBERTIAN, 0.6, NULL);
    built_material(built, BP_MATERIAL_METAL, 0.8, &metal);
    metal->fuzz = 0.5;
    built_sphere(built, 0, -100.5, -1, 100, 0);
    built_sphere(built, -0.6, 0, -1.2, 0.5, 0);
    built_sphere(built, 0.6, 0, -1.2, 0.5, 1);
    for (int c = 0; c < 3; ++c) built->scene.background_bottom[c] = 0.1;
    built->scene.camera.width = built->scene.camera.height = SIDE;
    built->scene.camera.pixel_sampling = BP_PIXEL_SQUARE;
}

static void judge(const char *who, const Batches *batches) {
    double low, high;
    limits(&low, &high);
    const double ratio = pooled_ratio(batches);
    printf("%-10s between over within %.4f, allowed %.4f to %.4f\n", who, ratio, low, high);
    assert_true(low > 0.85 && high < 1.15);
    assert_true(ratio > low && ratio < high);
}

static void kernel(void **state) {
    (void)state;
    static Batches batches;
    BuiltScene built;
    noisy_scene(&built);
    for (int seed = 0; seed < SEEDS; ++seed) {
        BpRender *render = NULL;
        BpRenderOptions options;
        BpError err = {0};
        BpSums sums;
        bp_render_defaults(&built.scene, &options);
        options.sampler = BP_SAMPLER_INDEPENDENT;
        options.samples_per_pixel = SAMPLES;
        options.seed = (uint64_t)seed; /* neighbours, as a user would choose them */
        BpStatus status = bp_sums_init(&sums, SIDE, SIDE, &err);
        if (status == BP_OK) status = open_render_on_device(&built.scene, &options, &render, &err);
        if (status == BP_OK) status = bp_check_render_kernel(render, &sums, NULL, &err);
        if (status != BP_OK) fail_msg("%s", err.message);
        collect(&sums, seed, &batches);
        bp_render_destroy(&render);
        bp_sums_clear(&sums);
    }
    judge("kernel", &batches);
}

static void reference(void **state) {
    (void)state;
    static Batches batches;
    BuiltScene built;
    noisy_scene(&built);
    for (int seed = 0; seed < SEEDS; ++seed) {
        BpSums sums;
        const BpReferenceOptions options = {.samples = SAMPLES, .seed = (uint64_t)seed, .max_depth = 50};
        assert_int_equal(bp_sums_init(&sums, SIDE, SIDE, NULL), BP_OK);
        assert_int_equal(bp_reference_render(&built.scene, &options, &sums, NULL, NULL), BP_OK);
        collect(&sums, seed, &batches);
        bp_sums_clear(&sums);
    }
    judge("reference", &batches);
}

/* One simulated picture's block: 64 pixels, a share of which repeats its left neighbour's noise. */
static void simulate(Random *random, int shared_percent, Batches *batches) {
    for (int s = 0; s < SEEDS; ++s) {
        for (int b = 0; b < BLOCKS; ++b) {
            double mean = 0, last = 0;
            for (int p = 0; p < 64; ++p) {
                /* The mean of a pixel's samples is close to normal; twelve uniforms are too. */
                double noise = -6;
                for (int i = 0; i < 12; ++i) noise += random_real(random);
                if (p % 2 == 1 && p / 2 % 100 < 32 * shared_percent / 100) noise = last;
                mean += noise / 64;
                last = noise;
            }
            batches->mean[s][b] = mean;
            batches->variance[s][b] = 1.0 / 64;
        }
    }
}

/* The power: independent pixels pass 100 times; where a quarter of the pixel pairs shares its numbers, the
 * test finds it at least 90 times in 100; where all pairs do, always. */
static void power(void **state) {
    (void)state;
    static Batches batches;
    const int shared[3] = {0, 25, 100}, least[3] = {0, 90, 100}, most[3] = {1, 100, 100};
    double low, high;
    limits(&low, &high);
    Random random = random_stream(5, 0, 0);
    for (int i = 0; i < 3; ++i) {
        int found = 0;
        for (int run = 0; run < 100; ++run) {
            simulate(&random, shared[i], &batches);
            const double ratio = pooled_ratio(&batches);
            found += ratio < low || ratio > high;
        }
        printf("%3d %% of pixel pairs share their numbers: found %d times of 100\n", shared[i], found);
        assert_in_range(found, least[i], most[i]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(kernel), cmocka_unit_test(reference),
                                       cmocka_unit_test(power)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
