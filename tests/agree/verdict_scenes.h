/* verdict_scenes.h: the small scenes on which the verdict's own error rates are measured, and how much too
 * bright they must be to be found with a given power.
 *
 * Knows: the reference.   Does not know: what is compared with it. */
#ifndef TESTS_AGREE_VERDICT_SCENES_H
#define TESTS_AGREE_VERDICT_SCENES_H

#include "check/statistics.h"
#include "check/verdict.h"
#include "reference/reference.h"
#include "support/build_scene.h"
#include "support/unit_test.h"

#include <math.h>

/* Coloured matte spheres under three lamps and a dim sky: noise in every channel, of different sources. */
static inline void coloured_scene(BuiltScene *built) {
    built_scene_init(built);
    BpMaterial *material;
    const double places[3][2] = {{-1.5, -2}, {0, -3}, {1.5, -2}};
    for (int c = 0; c < 3; ++c) {
        const uint32_t matte = built_material(built, BP_MATERIAL_LAMBERTIAN, 0.4, NULL);
        const uint32_t lamp = built_material(built, BP_MATERIAL_DIFFUSE_LIGHT, 0, &material);
        material->emit[c] = 12;
        built->scene.background_bottom[c] = 0.1;
        built->scene.background_top[c] = 0.3;
        built_sphere(built, places[c][0], 0, places[c][1], 0.5, matte);
        built_sphere(built, places[2 - c][0], 2, places[c][1], 0.4, lamp);
    }
    built_sphere(built, 0, -100.5, -2, 100, 0);
    BpCamera *camera = &built->scene.camera;
    camera->width = camera->height = 16;
    camera->pixel_sampling = BP_PIXEL_SQUARE;
}

/* The same without colour: the three channels are one test, so the power of the picture's means is a matter
 * of one z. */
static inline void grey_scene(BuiltScene *built) {
    coloured_scene(built);
    for (size_t i = 0; i < built->scene.material_count; ++i) {
        double *emit = built->materials[i].emit;
        const double most = emit[0] + emit[1] + emit[2];
        for (int c = 0; c < 3; ++c) emit[c] = most;
    }
}

/* Two matte spheres under the sky: 64 x 64 pixels. */
static inline void diffuse_scene(BuiltScene *built) {
    built_scene_init(built);
    built_material(built, BP_MATERIAL_LAMBERTIAN, 0.5, NULL);
    built_sphere(built, 0, -100.5, -1, 100, 0);
    built_sphere(built, 0, 0, -1, 0.5, 0);
    BpCamera *camera = &built->scene.camera;
    camera->width = camera->height = 64;
    camera->pixel_sampling = BP_PIXEL_SQUARE;
}

/* The reference's sums of a scene, which the caller clears. */
static inline void draw_reference(const BpScene *scene, uint64_t samples, uint64_t seed, BpSums *sums) {
    const BpReferenceOptions options = {.samples = samples, .seed = seed, .max_depth = 6};
    assert_int_equal(bp_sums_init(sums, scene->camera.width, scene->camera.height, NULL), BP_OK);
    assert_int_equal(bp_reference_render(scene, &options, sums, NULL, NULL), BP_OK);
}

/* The mean of a grey scene's picture, and the variance of that mean where each pixel has one sample. */
static inline void measure_picture(const BpScene *scene, uint64_t seed, double *mean, double *variance) {
    enum { SAMPLES = 4096 };
    BpSums sums;
    draw_reference(scene, SAMPLES, seed, &sums);
    *mean = *variance = 0;
    const double pixels = (double)sums.width * sums.height;
    for (size_t p = 0; p < (size_t)sums.width * sums.height; ++p) {
        const double m = sums.pixels[p].sum[0] / SAMPLES;
        *mean += m / pixels;
        *variance += (sums.pixels[p].sum2[0] / SAMPLES - m * m) / (pixels * pixels);
    }
    bp_sums_clear(&sums);
}

/* The z above which the means of a whole picture are rejected. */
static inline double picture_limit(void) {
    return bp_normal_upper_quantile(bp_level_bonferroni(0.45 * BP_VERDICT_LEVEL, 3) / 2);
}

/* By how much one of two pictures of so many samples a pixel is to be brighter, as a share, for this
 * probability that the picture's means are rejected. */
static inline double bias_of_power(double power, double mean, double variance, double samples) {
    double bias = 0;
    for (int step = 0; step < 20; ++step) { /* the brighter side is noisier in proportion */
        const double error = sqrt(variance * (1 + pow(1 + bias, 2)) / samples) / mean;
        bias = bp_z_detectable(picture_limit(), power) * error + BP_VERDICT_ROUNDING;
    }
    return bias;
}

#endif
