/* test_analytic.c: closed forms against the reference tracer and against the kernel. */
#include "analytic.h"
#include "check/check.h"
#include "check/statistics.h"
#include "reference/reference.h"
#include "support/open_render.h"
#include "support/unit_test.h"

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

typedef void Tracer(const BpScene *scene, uint64_t first_sample, uint64_t samples, uint64_t seed,
                    BpSums *sums);

static void trace_reference(const BpScene *scene, uint64_t first_sample, uint64_t samples, uint64_t seed,
                            BpSums *sums) {
    const BpReferenceOptions options = {
        .first_sample = first_sample, .samples = samples, .seed = seed, .max_depth = scene->camera.max_depth};
    assert_int_equal(bp_reference_render(scene, &options, sums, NULL, NULL), BP_OK);
}

static void trace_kernel(const BpScene *scene, uint64_t first_sample, uint64_t samples, uint64_t seed,
                         BpSums *sums) {
    BpRender *render = NULL;
    BpError err = {0};
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.sampler = BP_SAMPLER_INDEPENDENT;
    options.first_sample = first_sample;
    options.samples_per_pixel = samples;
    options.seed = seed;
    BpStatus status = open_render_on_device(scene, &options, &render, &err);
    if (status == BP_OK) status = bp_check_render_kernel(render, sums, NULL, &err);
    if (status != BP_OK) fail_msg("%s", err.message);
    bp_render_destroy(&render);
}

/* Every case, to 1e-5 over all cases and channels together. */
static void judge_all(Tracer *trace, double tolerance) {
    static AnalyticCase analytic;
    size_t cases = 0;
    while (analytic_case(cases, &analytic)) ++cases;
    const double z_limit = bp_normal_upper_quantile(bp_level_bonferroni(1e-5, 3 * cases) / 2);
    int failures = 0;
    for (size_t i = 0; analytic_case(i, &analytic); ++i) {
        const BpScene *scene = &analytic.built.scene;
        BpSums sums;
        assert_int_equal(bp_sums_init(&sums, scene->camera.width, scene->camera.height, NULL), BP_OK);
        const uint64_t pixels = (uint64_t)scene->camera.width * scene->camera.height, few = 1000;
        uint64_t samples = few;
        trace(scene, 0, few, 100 + i, &sums);
        if (is_noisy(&sums)) {
            samples = 250000 / pixels;
            trace(scene, few, samples - few, 100 + i, &sums);
        }
        for (size_t p = 0; p < pixels; ++p) assert_int_equal(sums.pixels[p].count, samples);
        failures += judge(&analytic, &sums, tolerance, z_limit);
        bp_sums_clear(&sums);
    }
    assert_int_equal(failures, 0);
}

static void reference(void **state) {
    (void)state;
    judge_all(trace_reference, 1e-10);
}

static void kernel(void **state) {
    (void)state;
    judge_all(trace_kernel, BP_VERDICT_ROUNDING);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(reference), cmocka_unit_test(kernel)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
