/* test_cost_choices.c: which ways `ballpark cost` compares, and what it advises. */
#include "support/unit_test.h"

#include "study/configurations.h"
#include "study/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the front, the advice ---- */

static void set_series(BpStudySeries *series, double noise, double seconds, double floor) {
    series->count = 2;
    for (size_t i = 0; i < 2; i++) {
        BpStudyPoint *point = &series->points[i];
        point->samples = i == 0 ? 100 : 400;
        point->claimed = i == 0 ? noise : noise / 2;
        point->mse = point->claimed * point->claimed + floor;
        point->nrmse = sqrt(point->mse);
        point->seconds = (i == 0 ? 1 : 4) * seconds;
    }
    series->bias_square = (BpStudyEstimate){floor, 0.9 * floor, 1.1 * floor};
}

static void test_advice(void **state) {
    (void)state;
    static BpStudyResult result;
    static BpScene scene;
    scene.camera.width = scene.camera.height = 10;
    scene.path = "s.json";
    memset(&result, 0, sizeof result);
    result.scene = &scene;
    result.full_width = result.full_height = 20;
    result.count = 4;
    set_series(&result.series[0], 0.10, 1.0, 4e-6);                      /* the base: floor 0.2 % */
    set_series(&result.series[1], 0.10, 2.0, 0);                         /* right, twice the time */
    set_series(&result.series[2], 0.10, 0.5, 2.5e-4);                    /* quick, floor 1.6 % */
    set_series(&result.series[3], 0.10, 0.95, 0);                        /* hardly quicker, and right */
    result.series[3].bias_square = (BpStudyEstimate){1e-5, -1e-5, 3e-5}; /* a floor that is not shown */
    bp_study_summarize(&result);
    assert_true(fabs(result.series[2].efficiency - 2) < 1e-12);
    assert_true(fabs(result.series[1].efficiency - 0.5) < 1e-12);
    assert_true(fabs(result.series[0].fit_floor - 4e-6) < 1e-12);
    assert_true(fabs(result.series[0].fit_slope - 1) < 1e-9);

    /* 5 %: V / N with V = 1 and no floor but the quick one's: 1 / (0.0025 - 0.00025) = 444.4 samples; a
     * pixel's sample takes 0.5 s / 10^4, and there are 400 pixels. */
    assert_int_equal(result.advice[0].series, 2);
    assert_true(result.advice[0].reachable && result.advice[0].samples == 445);
    assert_true(result.advice[0].extrapolated); /* 400 are the most that were measured */
    assert_true(fabs(result.advice[0].seconds - 445 * 400 * 0.5e-4) < 1e-9);
    /* 1 %: the quick one cannot; the base can, and what is 5 % quicker is not clearly so. */
    assert_int_equal(result.advice[1].series, 0);
    assert_true(result.advice[1].samples == ceil(1 / (1e-4 - 4e-6)));
    /* 0.2 %: the base's own floor. */
    assert_int_equal(result.advice[2].series, 3);
    assert_true(result.advice[2].samples == 250000);
    /* Noise that falls faster than 1 / N: between two counts by the line through both in logarithms. */
    for (size_t s = 0; s < 4; s++) result.series[s].points[1].claimed = 0.10 / 4;
    bp_study_advise(&result);
    assert_int_equal(result.advice[0].series,
                     2); /* 0.0475^2 = 0.0025 - 0.00025: 100 * 4^(log 4.44 / log 16) */
    assert_true(result.advice[0].samples == ceil(100 * pow(4, log(0.01 / 0.00225) / log(16))));
    assert_false(result.advice[0].extrapolated);
    for (size_t s = 0; s < 4; s++) result.series[s].points[1].claimed = 0.10 / 2;
    bp_study_advise(&result);

    char text[512];
    assert_non_null(strstr(bp_study_advice_text(&result, &result.advice[0], text, sizeof text),
                           "445 samples per pixel, about 8.9 s at 20x20 (samples and time extrapolated)"));
    /* No way there. */
    for (size_t s = 0; s < 4; s++) result.series[s].bias_square = (BpStudyEstimate){1e-5, 0.9e-5, 1.1e-5};
    bp_study_advise(&result);
    assert_true(result.advice[1].reachable && !result.advice[2].reachable);
    assert_non_null(strstr(bp_study_advice_text(&result, &result.advice[2], text, sizeof text),
                           "no configuration reaches it"));

    /* The front: of equal noise the quick one, until its floor; never the slowest. */
    assert_true(result.series[2].points[0].front);
    assert_false(result.series[0].points[0].front);
    assert_true(result.series[3].points[1].front);
    assert_false(result.series[1].points[0].front || result.series[1].points[1].front);
    result.series[1].points[1].nrmse = (double)NAN; /* unknown errors are on no front, and beat nothing */
    bp_study_front(&result);
    assert_false(result.series[1].points[1].front);
    assert_true(result.series[3].points[1].front);
}

/* What render would refuse is no advice: adaptive sampling begins at 32 samples per pixel. */
static void test_advice_can_be_followed(void **state) {
    (void)state;
    static BpStudyResult result;
    static BpScene scene;
    scene.camera.width = scene.camera.height = 10;
    result.scene = &scene;
    result.full_width = result.full_height = 10;
    result.count = 2;
    set_series(&result.series[0], 0.05, 1, 0);
    set_series(&result.series[1], 0.025, 0.5, 0); /* V = 1/16, in half of the time */
    result.series[1].configuration.options.adaptive = true;
    bp_study_summarize(&result);
    assert_int_equal(result.advice[0].series, 0); /* 5 %: 25 of those */
    assert_true(result.advice[0].samples == 100);
    assert_int_equal(result.advice[1].series, 1); /* 1 % */
    assert_true(result.advice[1].samples == 625);
    result.series[1].configuration.options.adaptive = false;
    bp_study_advise(&result);
    assert_int_equal(result.advice[0].series, 1);
    assert_true(result.advice[0].samples == 25);
}

/* ---- the configurations ---- */

static const BpStudyConfiguration *find(const BpStudyConfiguration *configurations, size_t count,
                                        const char *name) {
    for (size_t s = 0; s < count; s++)
        if (strcmp(configurations[s].name, name) == 0) return &configurations[s];
    return NULL;
}

static BpScene *load(const char *name) {
    BpScene *scene = NULL;
    BpError err = {0};
    char path[512];
    snprintf(path, sizeof path, SOURCE_DIR "/scenes/%s.json", name);
    if (bp_scene_load(path, &scene, &err) != BP_OK) fail_msg("%s", err.message);
    return scene;
}

/* A study that had time for the least only, or whose clock or references were too coarse, says so. */
static void test_shortness(void **state) {
    (void)state;
    static BpStudyResult result;
    static BpScene scene;
    char text[512];
    memset(&result, 0, sizeof result);
    result.scene = &scene;
    result.budget = 60;
    result.count = 2;
    for (size_t s = 0; s < 2; s++) {
        BpStudySeries *series = &result.series[s];
        series->count = 3;
        for (size_t i = 0; i < 3; i++) series->points[i].samples = 4u << 2 * i;
        series->time_ratio = (BpStudyEstimate){1, 0.9, 1.1};
        series->bias_square = (BpStudyEstimate){0, -1e-8, 1e-8};
    }
    for (int t = 0; t < BP_STUDY_TARGETS; t++)
        result.advice[t] = (BpStudyAdvice){.target = t == 0   ? 0.05
                                                     : t == 1 ? 0.01
                                                              : 0.002,
                                           .reachable = true,
                                           .series = 1};
    assert_string_equal(bp_study_shortness_text(&result, text, sizeof text), "");

    result.series[1].bias_square.high = 9e-6; /* 0.3 %: more than the 0.2 % that are promised */
    assert_non_null(strstr(bp_study_shortness_text(&result, text, sizeof text),
                           ": a bias of up to 0.3 % would have gone unnoticed. Give it more time, as in "
                           "`ballpark cost --time 240s`."));
    result.advice[2].reachable = false; /* nothing is promised */
    assert_string_equal(bp_study_shortness_text(&result, text, sizeof text), "");
    result.series[1].bias_square.high = (double)NAN; /* a device without double: the curve's floor counts */
    assert_string_equal(bp_study_shortness_text(&result, text, sizeof text), "");

    result.budget = 1;
    result.series[1].time_ratio.value = (double)NAN;
    assert_non_null(strstr(bp_study_shortness_text(&result, text, sizeof text),
                           ": it has too few measurements to compare times. Give it more time, as in "
                           "`ballpark cost --time 60s`."));
    result.series[0].count = result.series[1].count = 2;
    result.series[1].bias_square.high = 9e-4;
    assert_non_null(strstr(bp_study_shortness_text(&result, text, sizeof text),
                           ": it got no further than 16 samples per pixel, and a bias of up to 3.0 % would"));
}

static void test_configurations(void **state) {
    (void)state;
    BpStudyConfiguration configurations[BP_STUDY_CONFIGURATIONS_MAX];
    BpRenderOptions base;
    BpScene *glass = load("v4-18-glass-hollow"), *matte = load("v4-10-lambertian");
    bp_render_defaults(glass, &base);
    base.sampler = BP_SAMPLER_SOBOL;
    size_t count = bp_study_configurations(glass, &base, true, configurations);
    assert_string_equal(configurations[0].axis, "base");
    assert_string_equal(configurations[0].command, "");
    assert_string_equal(configurations[1].axis, "truth");
    assert_string_equal(configurations[1].command, "--precision double --depth 1000");
    assert_int_equal(configurations[1].fresnel, BP_STUDY_FRESNEL_EXACT);
    assert_null(find(configurations, count, "Sobol samples")); /* that is the base */
    assert_null(find(configurations, count, "depth 50"));
    assert_null(find(configurations, count, "Schlick's Fresnel"));
    assert_string_equal(find(configurations, count, "depth 10")->command, "--depth 10");
    assert_int_equal(find(configurations, count, "exact Fresnel")->fresnel, BP_STUDY_FRESNEL_EXACT);
    assert_string_equal(find(configurations, count, "all shortcuts")->command,
                        "--math fast --numerics plain --depth 10");
    for (size_t a = 0; a < count; a++) /* one axis at a time: no two are the same */
        for (size_t b = 0; b < a && a != 1; b++)
            assert_true(strcmp(configurations[a].command, configurations[b].command) != 0 ||
                        configurations[a].fresnel != configurations[b].fresnel);

    count = bp_study_configurations(glass, &base, false, configurations); /* a device without double */
    for (size_t s = 0; s < count; s++)
        assert_int_equal(configurations[s].options.precision, BP_PRECISION_SINGLE);
    assert_non_null(find(configurations, count, "exact Fresnel"));

    bp_render_defaults(matte, &base);
    base.sampler = BP_SAMPLER_INDEPENDENT;
    base.max_depth = 10;
    count = bp_study_configurations(matte, &base, true, configurations);
    for (size_t s = 0; s < count; s++) assert_int_equal(configurations[s].fresnel, BP_STUDY_FRESNEL_SCENE);
    assert_string_equal(configurations[0].command, "--sampler independent --depth 10");
    assert_string_equal(find(configurations, count, "Sobol samples")->command, "--depth 10");
    assert_string_equal(find(configurations, count, "depth 50")->command, "--sampler independent");

    /* Roulette is one where paths can be deep. */
    bp_render_defaults(matte, &base);
    count = bp_study_configurations(matte, &base, true, configurations);
    assert_null(find(configurations, count, "roulette for deep paths")); /* that is the base */
    assert_non_null(strstr(find(configurations, count, "deep paths traced on")->command, "--roulette off"));
    base.max_depth = 8;
    count = bp_study_configurations(matte, &base, true, configurations);
    assert_null(find(configurations, count, "deep paths traced on"));
    bp_scene_destroy(&glass);
    bp_scene_destroy(&matte);

    /* Rays through glass are an axis where there are such rays, and rays to lamps are of use. */
    BpScene *lit = load("../tests/unseen/scenes/lamp-0.1"), *moving = load("../tests/unseen/scenes/moving");
    bp_render_defaults(lit, &base);
    base.sampler = BP_SAMPLER_SOBOL;
    base.caustics = BP_CAUSTICS_OFF; /* as bp_render_choose_caustics() leaves it, or BP_CAUSTICS_ON */
    count = bp_study_configurations(lit, &base, true, configurations);
    assert_string_equal(configurations[0].command, "--caustics off");
    assert_string_equal(find(configurations, count, "rays through focusers")->command, "--caustics on");
    assert_null(find(configurations, count, "caustics found by chance")); /* that is the base */
    assert_string_equal(find(configurations, count, "lamps found by chance")->command,
                        "--light-sampling off --caustics off");
    base.caustics = BP_CAUSTICS_ON;
    count = bp_study_configurations(lit, &base, true, configurations);
    assert_string_equal(configurations[0].command, "--caustics on");
    assert_null(find(configurations, count, "rays through focusers"));
    assert_string_equal(find(configurations, count, "caustics found by chance")->command, "--caustics off");
    bp_render_defaults(moving, &base);
    count = bp_study_configurations(moving, &base, true, configurations);
    assert_null(find(configurations, count, "rays through focusers"));
    assert_non_null(find(configurations, count, "lamps found by chance"));
    bp_scene_destroy(&lit);
    bp_scene_destroy(&moving);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_advice),
        cmocka_unit_test(test_advice_can_be_followed),
        cmocka_unit_test(test_shortness),
        cmocka_unit_test(test_configurations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
