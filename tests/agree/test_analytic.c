/* test_analytic.c: closed forms against the reference tracer. */
#include "analytic.h"
#include "check/statistics.h"
#include "reference/reference.h"
#include "unit_test.h"

#include <math.h>
#include <stdio.h>

/* The mean over pixels and its variance. */
static void mean_of(const BpSums *sums, int channel, double *mean, double *variance) {
    const double pixels = (double)sums->width * sums->height;
    *mean = *variance = 0;
    for (size_t p = 0; p < (size_t)sums->width * sums->height; ++p) {
        const BpPixelSums *pixel = &sums->pixels[p];
        const double n = (double)pixel->count, m = pixel->sum[channel] / n;
        *mean += m / pixels;
        *variance += fmax(0, pixel->sum2[channel] / n - m * m) / (n - 1) / (pixels * pixels);
    }
}

static bool is_noisy(const BpSums *sums) {
    double mean, variance, total = 0;
    for (int c = 0; c < 3; ++c) {
        mean_of(sums, c, &mean, &variance);
        total += variance;
    }
    return total > 1e-16;
}

/* `tolerance`: relative rounding error allowed on top of the noise. Prints one line a case; the number of
 * cases that fail is returned. */
static int judge(const AnalyticCase *analytic, const BpSums *sums, double tolerance, double z_limit) {
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        double mean, variance;
        mean_of(sums, c, &mean, &variance);
        const double rest =
            fmax(0, fabs(mean - analytic->expected[c]) - tolerance * fmax(1, analytic->expected[c]));
        const double z = rest > 0 ? rest / sqrt(fmax(variance, 1e-300)) : 0;
        worst = z > worst || isnan(z) ? z : worst;
        if (!(z < z_limit))
            printf("FAILED %s, channel %d: mean %.12g, expected %.12g, z = %.2f\n", analytic->name, c, mean,
                   analytic->expected[c], z);
    }
    printf("%-40s z = %.2f\n", analytic->name, worst);
    return !(worst < z_limit);
}

static void reference(void **state) {
    (void)state;
    static AnalyticCase analytic;
    size_t cases = 0;
    while (analytic_case(cases, &analytic)) ++cases;
    /* 1e-5 over all cases and channels together. */
    const double z_limit = bp_normal_upper_quantile(bp_level_bonferroni(1e-5, 3 * cases) / 2);
    int failures = 0;
    for (size_t i = 0; analytic_case(i, &analytic); ++i) {
        const BpScene *scene = &analytic.built.scene;
        BpSums sums;
        assert_int_equal(bp_sums_init(&sums, scene->camera.width, scene->camera.height, NULL), BP_OK);
        const uint64_t pixels = (uint64_t)scene->camera.width * scene->camera.height;
        BpReferenceOptions options = {.samples = 1000, .seed = 100 + i, .max_depth = scene->camera.max_depth};
        assert_int_equal(bp_reference_render(scene, &options, &sums, NULL, NULL), BP_OK);
        if (is_noisy(&sums)) {
            options.first_sample = options.samples;
            options.samples = 250000 / pixels - options.samples;
            assert_int_equal(bp_reference_render(scene, &options, &sums, NULL, NULL), BP_OK);
        }
        for (size_t p = 0; p < pixels; ++p)
            assert_int_equal(sums.pixels[p].count, options.first_sample + options.samples);
        failures += judge(&analytic, &sums, 1e-10, z_limit);
        bp_sums_clear(&sums);
    }
    assert_int_equal(failures, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(reference)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
