/* test_kernel_power.c: how often the check rejects the kernel: the true one over 200 seeds, and kernels that
 * were made too bright by factors chosen for a predicted power. */
#include "check/check.h"
#include "check/statistics.h"
#include "support/kernel_copy.h"
#include "support/open_render.h"
#include "verdict_scenes.h"

static void draw_kernel(const BpScene *scene, uint64_t samples, uint64_t seed, BpSums *sums) {
    BpRender *render = NULL;
    BpRenderOptions options;
    BpError err = {0};
    bp_render_defaults(scene, &options);
    options.sampler = BP_SAMPLER_INDEPENDENT;
    options.samples_per_pixel = samples;
    options.max_depth = 6;
    options.light_sampling = BP_LIGHT_SAMPLING_OFF; /* the reference finds lamps by chance, and the level
                                                       holds for equal spreads */
    options.seed = seed;
    BpStatus status = bp_sums_init(sums, scene->camera.width, scene->camera.height, &err);
    if (status == BP_OK) status = open_render_on_device(scene, &options, &render, &err);
    if (status == BP_OK) status = bp_check_render_kernel(render, sums, NULL, &err);
    if (status != BP_OK) fail_msg("%s\n%s", err.message, err.attachment != NULL ? err.attachment : "");
    bp_render_destroy(&render);
}

static BpVerdict check(const BpScene *scene, uint64_t samples, uint64_t seed, double level) {
    BpSums kernel, reference;
    BpVerdict verdict;
    draw_kernel(scene, samples, seed, &kernel);
    draw_reference(scene, samples, ~seed, &reference);
    assert_int_equal(bp_verdict(&kernel, &reference, level, BP_VERDICT_MARGIN, &verdict, NULL), BP_OK);
    bp_sums_clear(&kernel);
    bp_sums_clear(&reference);
    return verdict;
}

static void control(void **state) {
    (void)state;
    BuiltScene built;
    coloured_scene(&built);
    int rejected = 0, interval_missed = 0;
    for (uint64_t seed = 0; seed < 200; ++seed) {
        const BpVerdict verdict = check(&built.scene, 200, seed, 0.05);
        rejected += verdict.conclusion == BP_DISAGREE;
        interval_missed += verdict.ratio_low > 1 || verdict.ratio_high < 1;
    }
    printf("control: rejected %d of 200 at 0.05; the 95 %% interval missed 1 %d times\n", rejected,
           interval_missed);
    assert_in_range(rejected, 2, 21);
    assert_true(bp_binomial_two_sided((uint64_t)interval_missed, 200, 0.05) > 1e-4);
}

static void calibrated(void **state) {
    (void)state;
    BuiltScene built;
    grey_scene(&built);
    double mean, variance;
    measure_picture(&built.scene, ~UINT64_C(99), &mean, &variance);
    const double powers[3] = {0.1, 0.5, 0.9}, samples = 256;
    for (int i = 0; i < 3; ++i) {
        const double bias = bias_of_power(powers[i], mean, variance, samples);
        char brighter[512];
        snprintf(brighter, sizeof brighter,
                 "scatter4(R(%.9f) * path.radiance.x, R(%.9f) * path.radiance.y, "
                 "R(%.9f) * path.radiance.z,",
                 1 + bias, 1 + bias, 1 + bias);
        KernelCopy copy;
        kernel_copy_open(&copy, "entry/trace_packet.cl",
                         "scatter4(path.radiance.x, path.radiance.y, path.radiance.z,", brighter);
        int by_picture = 0, rejected = 0;
        for (uint64_t run = 0; run < 100; ++run) {
            const BpVerdict verdict =
                check(&built.scene, (uint64_t)samples, 1000 * (uint64_t)(i + 1) + run, 1e-4);
            by_picture += verdict.worst[BP_FAMILY_PICTURE].z > picture_limit();
            rejected += verdict.conclusion == BP_DISAGREE;
        }
        kernel_copy_close(&copy);
        const double p = bp_binomial_two_sided((uint64_t)by_picture, 100, powers[i]);
        printf("calibrated: radiance x %.5f: predicted power %.1f, found by the picture's means %d, in all "
               "%d of 100 "
               "(p = %.4f)\n",
               1 + bias, powers[i], by_picture, rejected, p);
        assert_true(p > 1e-4);
        assert_true(rejected >= by_picture);
    }
}

/* 0.5 % too bright on a 64 x 64 diffuse scene at the default count: rejected at least 9 times of 10; the true
 * kernel never. */
static void half_percent(void **state) {
    (void)state;
    BuiltScene built;
    diffuse_scene(&built);
    int wrong = 0, right = 0;
    for (uint64_t seed = 0; seed < 10; ++seed)
        right += check(&built.scene, BP_CHECK_SAMPLES_DEFAULT, seed, BP_VERDICT_LEVEL).conclusion != BP_AGREE;
    KernelCopy copy;
    kernel_copy_open(&copy, "entry/trace_packet.cl",
                     "scatter4(path.radiance.x, path.radiance.y, path.radiance.z,",
                     "scatter4(R(1.005) * path.radiance.x, R(1.005) * path.radiance.y, "
                     "R(1.005) * path.radiance.z,");
    for (uint64_t seed = 10; seed < 20; ++seed)
        wrong +=
            check(&built.scene, BP_CHECK_SAMPLES_DEFAULT, seed, BP_VERDICT_LEVEL).conclusion == BP_DISAGREE;
    kernel_copy_close(&copy);
    printf("0.5 %% too bright: rejected %d of 10; the true kernel %d of 10\n", wrong, right);
    assert_true(wrong >= 9);
    assert_int_equal(right, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(control), cmocka_unit_test(calibrated),
                                       cmocka_unit_test(half_percent)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
