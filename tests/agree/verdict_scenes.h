/* verdict_scenes.h: the small scenes on which the verdict's own error rates are measured. */
#ifndef TESTS_AGREE_VERDICT_SCENES_H
#define TESTS_AGREE_VERDICT_SCENES_H

#include "support/build_scene.h"

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

#endif
