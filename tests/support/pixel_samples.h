/* pixel_samples.h: every single sample of a scene's picture.
 *
 * In:    a scene, options of a render.   Out: radiance and length of each path, in the order of
 * pixels, and of samples within a pixel.
 * Knows: that chunks hand out blocks of samples.   Does not know: what is tested. */
#ifndef TESTS_SUPPORT_PIXEL_SAMPLES_H
#define TESTS_SUPPORT_PIXEL_SAMPLES_H

#include "render/render.h"
#include "support/open_render.h"
#include "support/unit_test.h"

#include <stdlib.h>
#include <string.h>

typedef struct PixelSamples {
    float *values; /* (pixel * samples + sample) * 4, as in BpSampleBlock; the caller frees it */
    size_t count;  /* of samples */
} PixelSamples;

/* Draws the options' samples of every pixel on the default device. */
static inline PixelSamples draw_samples(const BpScene *scene, const BpRenderOptions *options) {
    const size_t each = options->samples_per_pixel; /* of a pixel */
    BpRender *render = NULL;
    BpError err = {0};
    PixelSamples all = {.count = (size_t)scene->camera.width * scene->camera.height * each};
    all.values = malloc(all.count * 4 * sizeof *all.values);
    assert_non_null(all.values);
    size_t got = 0;
    BpStatus status = open_render_on_device(scene, options, &render, &err);
    for (bool finished = false; status == BP_OK && !finished;) {
        BpSampleBlock block = {0};
        status = bp_render_step_samples(render, &block, &finished, &err);
        for (uint32_t i = 0; i < block.pixel_count; ++i, got += block.samples) {
            const size_t place = (block.first_pixel + i) * each + block.first_sample;
            memcpy(all.values + 4 * place, block.values + 4 * (size_t)i * block.samples,
                   4 * (size_t)block.samples * sizeof *all.values);
        }
        bp_sample_block_clear(&block);
    }
    if (status != BP_OK) fail_msg("%s", err.message);
    assert_int_equal(got, all.count);
    bp_render_destroy(&render);
    return all;
}

#endif
