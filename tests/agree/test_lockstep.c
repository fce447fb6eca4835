/* test_lockstep.c: the same random numbers through single and double precision, sample by sample.
 *
 * Until two paths part (at an edge, or where a choice falls within rounding) they must agree to a few units
 * in the last place of their terms; what parts must be rare, and must not shift the mean. It is no
 * independent evidence, since both come from one kernel text; it finds numerical trouble that statistics
 * would need 1e10 samples to see. */
#include "check/check.h"
#include "support/unit_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SAMPLES = 64 };

typedef struct Samples {
    float *values; /* pixel * SAMPLES + sample, 4 each */
    size_t count;
} Samples;

static Samples draw(const BpScene *scene, BpPrecision precision) {
    BpRenderOptions options;
    BpRender *render = NULL;
    BpError err = {0};
    Samples all = {.count = (size_t)scene->camera.width * scene->camera.height * SAMPLES};
    all.values = malloc(all.count * 4 * sizeof *all.values);
    assert_non_null(all.values);
    bp_render_defaults(scene, &options);
    options.sampler = BP_SAMPLER_INDEPENDENT;
    options.samples_per_pixel = SAMPLES;
    options.precision = precision;
    options.seed = 3;
    BpStatus status = bp_render_create(scene, &options, NULL, 0, &render, &err);
    size_t got = 0;
    for (bool finished = false; status == BP_OK && !finished;) {
        BpSampleBlock block = {0};
        status = bp_render_step_samples(render, &block, &finished, &err);
        for (size_t i = 0; status == BP_OK && i < (size_t)block.pixel_count * block.samples; ++i, ++got) {
            const size_t place =
                (block.first_pixel + i / block.samples) * SAMPLES + block.first_sample + i % block.samples;
            for (size_t k = 0; k < 4; ++k) all.values[4 * place + k] = block.values[4 * i + k];
        }
        bp_sample_block_clear(&block);
    }
    if (status != BP_OK) fail_msg("%s", err.message);
    assert_int_equal(got, all.count);
    bp_render_destroy(&render);
    return all;
}

/* `parting`: the share of paths that may part. */
static void compare(const char *name, uint32_t width, double parting) {
    char path[512];
    BpScene *scene = NULL;
    BpError err = {0};
    snprintf(path, sizeof path, "%s/%s", SOURCE_DIR, name);
    if (bp_scene_load(path, &scene, &err) != BP_OK || bp_scene_set_width(scene, width, &err) != BP_OK)
        fail_msg("%s", err.message);
    const Samples single = draw(scene, BP_PRECISION_SINGLE), wide = draw(scene, BP_PRECISION_DOUBLE);
    size_t parted = 0;
    double close_sum = 0, difference = 0, square = 0, brightness = 0;
    for (size_t i = 0; i < single.count; ++i) {
        const float *a = single.values + 4 * i, *b = wide.values + 4 * i;
        double worst = 0, delta = 0;
        for (int c = 0; c < 3; ++c) {
            worst = fmax(worst, fabs((double)a[c] - (double)b[c]) / (0.1 + fabs((double)b[c])));
            delta += ((double)a[c] - (double)b[c]) / 3;
            brightness += (double)b[c] / 3;
        }
        difference += delta;
        square += delta * delta;
        if (a[3] != b[3] || !(worst < 1e-3))
            ++parted;
        else
            close_sum += worst;
    }
    const double n = (double)single.count, share = (double)parted / n,
                 mean = close_sum / (n - (double)parted);
    const double shift = difference / n, noise = sqrt(fmax(square / n - shift * shift, 0) / n);
    printf("%-44s paths that diverge %.5f %%, mean difference of the others %.1e, shift of the mean %.1e +- "
           "%.1e of %.3f\n",
           name, 100 * share, mean, shift, noise, brightness / n);
    assert_true(share < parting);
    assert_true(mean < 2e-6);
    assert_true(fabs(shift) < 4.5 * noise + 2e-6);
    free(single.values);
    free(wide.values);
    bp_scene_destroy(&scene);
}

static void need_double(void) {
    BpDeviceInfo device;
    if (bp_device_find(NULL, &device, NULL) != BP_OK || device.has_double) return;
    printf("skipped: the device has no double precision\n");
    exit(77);
}

static void scenes(void **state) {
    (void)state;
    compare("scenes/v4-09-hemisphere.json", 64, 2e-3);
    compare("scenes/v4-14-metal-fuzz.json", 64, 2e-3);
    compare("scenes/v4-22-defocus.json", 64, 2e-3);
    compare("scenes/v3-16-glass-hollow.json", 64, 2e-3);
    compare("scenes/cover.json", 64, 2e-3);
    compare("tests/agree/scenes/far-away.json", 64, 2e-3);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(scenes)};
    need_double();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
