/* test_lockstep.c: the same random numbers through single and double precision, sample by sample.
 *
 * Until two paths part (at an edge, or where a choice falls within rounding) they must agree to a few units
 * in the last place of their terms; what parts must be rare, and must not shift the mean. It is no
 * independent evidence, since both come from one kernel text; it finds numerical trouble that statistics
 * would need 1e10 samples to see. */
#include "support/load_scene.h"
#include "support/pixel_samples.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SAMPLES = 64 };

static PixelSamples draw(const BpScene *scene, BpPrecision precision) {
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.sampler = BP_SAMPLER_INDEPENDENT;
    options.samples_per_pixel = SAMPLES;
    options.precision = precision;
    options.seed = 3;
    return draw_samples(scene, &options);
}

/* `parting`: the share of paths that may part. */
static void compare(const char *name, uint32_t width, double parting) {
    BpScene *scene = load_scene(name, width);
    const PixelSamples single = draw(scene, BP_PRECISION_SINGLE), wide = draw(scene, BP_PRECISION_DOUBLE);
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
