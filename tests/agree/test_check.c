/* test_check.c: a check's result depends on scene, samples and seed, not on chunks, threads or steps; and
 * what it refuses. */
#include "check/check.h"
#include "support/load_scene.h"
#include "support/unit_test.h"

#include <stdio.h>
#include <string.h>

static BpCheckOptions options_for(const BpScene *scene) {
    BpCheckOptions options = {.level = BP_VERDICT_LEVEL, .margin = 0.05};
    bp_render_defaults(scene, &options.render);
    options.render.samples_per_pixel = 50;
    options.render.sampler = BP_SAMPLER_INDEPENDENT;
    options.render.seed = 8;
    return options;
}

static BpCheck *check_with(const BpScene *scene, const BpCheckOptions *options) {
    BpCheck *check = NULL;
    BpCheckProgress progress = {0};
    const BpCheckResult *result = NULL;
    BpError err = {0};
    if (bp_check_create(scene, options, NULL, &check, &err) != BP_OK) fail_msg("%s", err.message);
    assert_int_equal(bp_check_result(check, &result, NULL), BP_ERR_USAGE);
    while (!progress.finished) {
        if (bp_check_step(check, &progress, &err) != BP_OK) fail_msg("%s", err.message);
        assert_true(progress.done >= 0 && progress.done <= 1);
    }
    return check;
}

static const BpCheckResult *result_of(const BpCheck *check) {
    const BpCheckResult *result = NULL;
    assert_int_equal(bp_check_result(check, &result, NULL), BP_OK);
    return result;
}

static bool same_sums(const BpSums *a, const BpSums *b) {
    return memcmp(a->pixels, b->pixels, (size_t)a->width * a->height * sizeof *a->pixels) == 0;
}

static void chunks_and_threads_change_nothing(void **state) {
    (void)state;
    BpScene *scene = load_scene("scenes/v4-18-glass-hollow.json", 40);
    BpCheckOptions options = options_for(scene);
    BpCheck *plain = check_with(scene, &options);
    assert_int_equal(result_of(plain)->verdict.conclusion, BP_AGREE);
    assert_int_equal(result_of(plain)->samples_per_pixel, 50);
    assert_false(result_of(plain)->timed_out);
    assert_int_equal(result_of(plain)->verdict.samples, 2u * 40u * scene->camera.height * 50u);
    const uint32_t chunks[3] = {999, 4096, 100000};
    for (unsigned i = 0; i < 3; ++i) {
        options.render.chunk_samples = chunks[i];
        options.threads = i + 1;
        BpCheck *other = check_with(scene, &options);
        const BpCheckResult *a = result_of(plain), *b = result_of(other);
        assert_true(same_sums(&a->kernel, &b->kernel));
        assert_true(same_sums(&a->reference, &b->reference));
        assert_int_equal(a->cut_kernel, b->cut_kernel);
        assert_int_equal(a->cut_reference, b->cut_reference);
        for (int f = 0; f < BP_FAMILIES; ++f) assert_true(a->verdict.worst[f].z == b->verdict.worst[f].z);
        bp_check_destroy(&other);
    }
    options.render.seed = 9;
    BpCheck *other = check_with(scene, &options);
    assert_false(same_sums(&result_of(plain)->kernel, &result_of(other)->kernel));
    assert_false(same_sums(&result_of(plain)->reference, &result_of(other)->reference));
    bp_check_destroy(&other);
    bp_check_destroy(&plain);
    bp_scene_destroy(&scene);
}

/* Time that suffices changes nothing, though both sides proceed in rounds. Time that is up before the first
 * round gives no verdict; and in between, the rounds that were whole are judged, as if they had been asked
 * for. How far it gets until a limit is a matter of the machine: so limits are tried until one ends it in
 * between. */
static void limits_of_time(void **state) {
    (void)state;
    BpScene *scene = load_scene("scenes/v4-18-glass-hollow.json", 40);
    BpCheckOptions options = options_for(scene);
    BpCheck *plain = check_with(scene, &options);
    options.seconds = 1e6;
    BpCheck *limited = check_with(scene, &options);
    const BpCheckResult *a = result_of(plain), *b = result_of(limited);
    assert_true(same_sums(&a->kernel, &b->kernel) && same_sums(&a->reference, &b->reference));
    assert_true(a->verdict.picture_off == b->verdict.picture_off && !b->timed_out);
    bp_check_destroy(&limited);
    bp_check_destroy(&plain);

    options.seconds = 1e-9;
    BpError err = {0};
    assert_int_equal(bp_check_create(scene, &options, NULL, &limited, &err), BP_OK);
    assert_int_equal(bp_check_step(limited, NULL, &err), BP_ERR_INCONCLUSIVE);
    assert_non_null(strstr(err.message, "16 samples per pixel"));
    bp_check_destroy(&limited);

    options.render.samples_per_pixel = 1u << 20;
    for (options.seconds = 0.2; options.seconds < 100; options.seconds *= 2) {
        BpCheckProgress progress = {0};
        BpStatus status = bp_check_create(scene, &options, NULL, &limited, &err);
        while (status == BP_OK && !progress.finished) status = bp_check_step(limited, &progress, &err);
        if (status == BP_OK) break;
        assert_int_equal(status, BP_ERR_INCONCLUSIVE);
        bp_check_destroy(&limited);
    }
    b = result_of(limited);
    assert_true(b->timed_out);
    const uint64_t samples = b->samples_per_pixel;
    assert_true(samples >= 16 && samples < 1u << 20 && (samples & (samples - 1)) == 0);
    assert_int_equal(b->verdict.samples, 2u * 40u * scene->camera.height * samples);
    options.seconds = 0;
    options.render.samples_per_pixel = samples;
    plain = check_with(scene, &options);
    a = result_of(plain);
    assert_true(same_sums(&a->kernel, &b->kernel) && same_sums(&a->reference, &b->reference));
    assert_true(a->cut_kernel == b->cut_kernel && a->cut_reference == b->cut_reference);
    assert_true(a->verdict.picture_off == b->verdict.picture_off);
    assert_int_equal(a->verdict.conclusion, b->verdict.conclusion);
    bp_check_destroy(&plain);
    bp_check_destroy(&limited);
    bp_error_clear(&err);
    bp_scene_destroy(&scene);
}

/* Three panels with gaps and a legend below; the third is white where the z is 0. */
static void map(void **state) {
    (void)state;
    BpScene *scene = load_scene("scenes/v4-red-sphere.json", 40); /* no noise: every z is 0 */
    const BpCheckOptions options = options_for(scene);
    BpCheck *check = check_with(scene, &options);
    BpPicture picture;
    assert_int_equal(bp_check_map(result_of(check), BP_TRANSFER_GAMMA2, &picture, NULL), BP_OK);
    const uint32_t zoom = (picture.width - 16) / 120, shown = scene->camera.height * zoom;
    assert_int_equal(picture.width, 3 * 40 * zoom + 16);
    assert_true(picture.height > shown);
    const float *last = picture.rgb + ((size_t)picture.width * shown - 1) * 3;
    assert_true(last[0] == 1 && last[1] == 1 && last[2] == 1);
    const float *first = picture.rgb, *reference = picture.rgb + (size_t)(40 * zoom + 8) * 3;
    for (int c = 0; c < 3; ++c)
        assert_true(first[c] - reference[c] < 1e-5f && reference[c] - first[c] < 1e-5f);
    /* The legend has the colours of the darkest kernel and the brightest. */
    bool blue = false, red = false;
    for (size_t i = (size_t)picture.width * shown; i < (size_t)picture.width * picture.height; ++i) {
        const float *color = picture.rgb + 3 * i;
        blue = blue || (color[2] > 0.9f && color[0] < 0.01f);
        red = red || (color[0] > 0.9f && color[2] < 0.01f);
    }
    assert_true(blue && red);
    bp_picture_clear(&picture);
    bp_check_destroy(&check);
    bp_scene_destroy(&scene);
}

static void refusals(void **state) {
    (void)state;
    BpScene *scene = load_scene("scenes/v4-sky.json", 8);
    BpCheckOptions options = options_for(scene);
    BpCheck *check = NULL;
    BpError err = {0};
    options.render.samples_per_pixel = 1;
    assert_int_equal(bp_check_create(scene, &options, NULL, &check, &err), BP_ERR_USAGE);
    assert_null(check);
    options = options_for(scene);
    options.render.sampler = BP_SAMPLER_SOBOL;
    assert_int_equal(bp_check_create(scene, &options, NULL, &check, &err), BP_ERR_USAGE);
    assert_non_null(strstr(err.message, "independent"));
    bp_error_clear(&err);
    bp_scene_destroy(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(chunks_and_threads_change_nothing),
                                       cmocka_unit_test(limits_of_time), cmocka_unit_test(map),
                                       cmocka_unit_test(refusals)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
