/* test_without_double.c: a study on a device that says it has no double: the truth is the reference tracer's,
 * and what is known without it still comes out. */
#include "support/unit_test.h"

#include "base/status.h"
#include "study/study.h"

#include <math.h>
#include <string.h>

/* Inside a sphere that glows with 1 and reflects half: D segments give 2 (1 - 2^-D). */
static const char furnace[] =
    "{\"camera\": {\"image_width\": 8, \"max_depth\": 50},"
    " \"materials\": {\"m\": {\"type\": \"lambertian\", \"albedo\": [0.5, 0.5, 0.5], \"emit\": [1, 1, 1]}},"
    " \"spheres\": [{\"center\": [0, 0, 0], \"radius\": 5, \"material\": \"m\"}]}";
static const char glass[] =
    "{\"camera\": {\"image_width\": 24, \"max_depth\": 50},"
    " \"materials\": {\"g\": {\"type\": \"dielectric\", \"refraction_index\": 1.5},"
    "                 \"m\": {\"type\": \"lambertian\", \"albedo\": [0.5, 0.4, 0.3]}},"
    " \"spheres\": [{\"center\": [0, 0, -1], \"radius\": 0.5, \"material\": \"g\"},"
    "               {\"center\": [0, -100.5, -1], \"radius\": 100, \"material\": \"m\"}]}";

static void must(BpStatus status, const BpError *err) {
    if (status != BP_OK) fail_msg("%s", err->message);
}

typedef struct Run {
    BpScene *scene;
    BpStudy *study;
    const BpStudyResult *result;
} Run;

static Run run_study(const char *text, double seconds) {
    Run run = {0};
    BpError err = {0};
    BpDeviceInfo device;
    BpRenderOptions options;
    BpStudyProgress progress = {0};
    must(bp_scene_parse(text, strlen(text), "test", &run.scene, &err), &err);
    must(bp_device_find(NULL, &device, &err), &err);
    device.has_double = false;
    bp_render_defaults(run.scene, &options);
    options.sampler = BP_SAMPLER_SOBOL;
    options.roulette = BP_ROULETTE_OFF; /* of the furnace every sample is known */
    must(bp_study_create(run.scene, &options, &device, 100, 100, seconds, &run.study, &err), &err);
    assert_int_equal(bp_study_stop(run.study, &err), BP_ERR_INTERRUPTED); /* nothing to compare yet */
    bp_error_clear(&err);
    while (!progress.finished) {
        must(bp_study_step(run.study, &progress, &err), &err);
        assert_true(progress.fraction >= 0 && progress.fraction <= 1 && progress.seconds_left >= 0);
    }
    must(bp_study_stop(run.study, &err), &err); /* a study that has ended stays as it is */
    run.result = bp_study_result(run.study);
    assert_false(run.result->reference_is_kernel);
    assert_false(run.result->cut_short);
    for (size_t s = 0; s < run.result->count; s++)
        assert_int_equal(run.result->series[s].configuration.options.precision, BP_PRECISION_SINGLE);
    return run;
}

static void end(Run *run) {
    bp_study_destroy(&run->study);
    bp_scene_destroy(&run->scene);
}

static const BpStudySeries *find(const BpStudyResult *result, const char *name) {
    for (size_t s = 0; s < result->count; s++)
        if (strcmp(result->series[s].configuration.name, name) == 0) return &result->series[s];
    fail_msg("there is no %s", name);
    return NULL;
}

static void test_known_bias(void **state) {
    (void)state;
    Run run = run_study(furnace, 0.5);
    assert_true(fabs(run.result->brightness - 2) < 1e-6);
    const int depths[] = {5, 10};
    for (int i = 0; i < 2; i++) {
        char name[16];
        snprintf(name, sizeof name, "depth %d", depths[i]);
        const BpStudySeries *series = find(run.result, name);
        assert_true(fabs(series->bias.value + pow(2, -depths[i])) < 1e-6);
        assert_true(fabs(series->change.value + pow(2, -depths[i])) < 1e-6);
        assert_true(fabs(series->points[series->count - 1].nrmse - pow(2, -depths[i])) < 1e-6);
    }
    end(&run);
}

/* With exact Fresnel nothing is wrong but noise: what the references see is what the replicates claim, and
 * the brightness is right within its interval; Schlick's error shows. */
static void test_noise_and_bias(void **state) {
    (void)state;
    Run run = run_study(glass, 3);
    const BpStudySeries *exact = find(run.result, "exact Fresnel"), *base = &run.result->series[0];
    for (size_t i = 0; i < exact->count; i++) {
        const BpStudyPoint *point = &exact->points[i];
        const double claimed = point->claimed * point->claimed;
        assert_true(fabs(point->mse - claimed) <= 5 * point->mse_error + 0.1 * claimed);
    }
    const double error = (exact->bias.high - exact->bias.low) / (2 * 1.96);
    print_message("exact: brightness off by %+.4f +- %.4f %%; Schlick: pixels by %.2f %%\n",
                  100 * exact->bias.value, 196 * error, 100 * sqrt(fmax(0, exact->change_square.value)));
    assert_true(error > 0 && fabs(exact->bias.value) <= 4.5 * error);
    assert_true(isnan(base->bias_square.value)); /* unknown without a kernel in double */
    assert_true(exact->change_square.low > 0);
    end(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_bias),
        cmocka_unit_test(test_noise_and_bias),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
