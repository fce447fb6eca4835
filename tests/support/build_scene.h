/* build_scene.h: small scenes put together in C, for tests that want no parser between them and the tracer.
 *
 * Knows: BpScene.   Does not know: documents, renderers. */
#ifndef TESTS_SUPPORT_BUILD_SCENE_H
#define TESTS_SUPPORT_BUILD_SCENE_H

#include "scene/scene.h"

typedef struct BuiltScene {
    BpScene scene; /* points into the arrays below: pass it on by address, do not copy it */
    BpMaterial materials[16];
    BpSphere spheres[64];
    char empty[1];
} BuiltScene;

/* No spheres; a white sky; one pixel, its centre ray from the origin along -z. */
static inline void built_scene_init(BuiltScene *built) {
    *built = (BuiltScene){0};
    BpScene *scene = &built->scene;
    scene->path = scene->title = scene->source = built->empty;
    scene->materials = built->materials;
    scene->spheres = built->spheres;
    scene->camera = (BpCamera){.width = 1,
                               .height = 1,
                               .aspect_ratio = 1,
                               .samples_per_pixel = 1,
                               .max_depth = 50,
                               .vfov_degrees = 90,
                               .lookat = {0, 0, -1},
                               .vup = {0, 1, 0},
                               .focus_dist = 1,
                               .pixel_sampling = BP_PIXEL_CENTER};
    for (int c = 0; c < 3; ++c) scene->background_bottom[c] = scene->background_top[c] = 1;
}

/* The index of a new material; the caller fills in the rest through the pointer. */
static inline uint32_t built_material(BuiltScene *built, BpMaterialKind kind, double albedo,
                                      BpMaterial **material) {
    const uint32_t index = (uint32_t)built->scene.material_count++;
    built->materials[index] = (BpMaterial){
        .name = built->empty, .kind = kind, .albedo = {albedo, albedo, albedo}, .refraction_index = 1.5};
    if (material != NULL) *material = &built->materials[index];
    return index;
}

static inline void built_sphere(BuiltScene *built, double x, double y, double z, double radius,
                                uint32_t material) {
    built->spheres[built->scene.sphere_count++] =
        (BpSphere){.center = {x, y, z}, .radius = radius, .material = material, .albedo = BP_NO_ALBEDO};
}

#endif
