/* cover.c: the cover of the book, in the ways its editions draw it.
 *
 * In:    edition, grid, seed.   Out: a BpScene.
 * Knows: the book's listings.   Does not know: JSON, OpenCL.
 *
 * The order of the draws is fixed, since C and C++ leave the order of a call's arguments open and pictures
 * must not depend on a compiler:
 *   for a = -grid .. grid-1, for b = -grid .. grid-1 (edition 3rust: .. grid in both):
 *     one draw: which material; one: centre x = a + 0.9 u; one: centre z = b + 0.9 u;
 *     within 0.9 of (4, 0.2, 0) the cell stays empty and draws no more (edition 3rust has no such rule);
 *     below 0.80 matte: six draws, red = u1 u2, green = u3 u4, blue = u5 u6;
 *     below 0.95 metal: three draws, 0.5 + 0.5 u each (edition 3rust: 0.4 + 0.6 u), then fuzz = 0.5 u;
 *     else glass: no draw.
 * The draws are those of bp_random_next (base/random.h). */
#include "base/random.h"
#include "scene/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GRID_MAX = 5000, GLASS = 1, BIG_MATTE = 2, BIG_METAL = 3, NAMED_MATERIALS = 4, NAMED_SPHERES = 4 };

typedef struct Edition {
    const char *name, *title, *source;
    double metal_low;
    BpScatter scatter;
    BpFuzzShape fuzz_shape;
    uint32_t height, samples_per_pixel, max_depth;
    bool extra_row, keeps_all;        /* cells up to +grid; no room kept round the big metal sphere */
    double aperture, defocus_degrees; /* one of the two */
} Edition;

#define FIRST_EDITION                                                                                        \
    .metal_low = 0.5, .scatter = BP_SCATTER_COSINE_CUBED, .fuzz_shape = BP_FUZZ_BALL, .height = 800,         \
    .samples_per_pixel = 10, .max_depth = 51, .aperture = 0.1
#define THIRD_EDITION                                                                                        \
    .scatter = BP_SCATTER_LAMBERTIAN, .fuzz_shape = BP_FUZZ_BALL, .height = 800, .samples_per_pixel = 500,   \
    .max_depth = 50, .aperture = 0.1
#define FOURTH_EDITION                                                                                       \
    .metal_low = 0.5, .scatter = BP_SCATTER_LAMBERTIAN, .fuzz_shape = BP_FUZZ_SPHERE, .height = 675,         \
    .samples_per_pixel = 500, .max_depth = 50, .defocus_degrees = 0.6
#define BOOK "Ray Tracing in One Weekend, "

static const Edition editions[] = {
    {"1", "The cover, first edition", BOOK "first edition (1.53), chapter 12", FIRST_EDITION},
    {"3", "The cover, third edition", BOOK "third edition (3.2.3), Image 21", .metal_low = 0.5,
     THIRD_EDITION},
    {"3rust", "The cover, third edition in Rust", BOOK "third edition (3.2.3) in Rust, Image 21",
     .metal_low = 0.4, .extra_row = true, .keeps_all = true, THIRD_EDITION},
    {"4", "The cover, fourth edition", BOOK "fourth edition, Image 23", FOURTH_EDITION},
};

/* ---- materials and spheres ---------------------------------------------------------------------------- */

static BpStatus add_material(BpScene *scene, BpMaterial material, const char *name, BpError *err) {
    material.name = NULL;
    BP_TRY(bp_copy_text(name, &material.name, err));
    scene->materials[scene->material_count++] = material;
    return BP_OK;
}

static void add_sphere(BpScene *scene, double x, double y, double z, double radius, size_t material) {
    scene->spheres[scene->sphere_count++] = (BpSphere){
        .center = {x, y, z}, .radius = radius, .material = (uint32_t)material, .albedo = BP_NO_ALBEDO};
}

static BpMaterial matte(const Edition *edition, double r, double g, double b) {
    return (BpMaterial){.kind = BP_MATERIAL_LAMBERTIAN,
                        .albedo = {r, g, b},
                        .refraction_index = 1,
                        .scatter = edition->scatter};
}

static BpMaterial metal(const Edition *edition, double r, double g, double b, double fuzz) {
    return (BpMaterial){.kind = BP_MATERIAL_METAL,
                        .albedo = {r, g, b},
                        .refraction_index = 1,
                        .fuzz = fuzz,
                        .fuzz_shape = edition->fuzz_shape};
}

static BpStatus add_cell(BpScene *scene, const Edition *edition, int a, int b, BpRandom *random,
                         BpError *err) {
    const double choice = bp_random_next(random);
    const double x = a + 0.9 * bp_random_next(random);
    const double z = b + 0.9 * bp_random_next(random);
    if (!edition->keeps_all && !(hypot(x - 4, z) > 0.9)) return BP_OK; /* both centres are 0.2 high */
    size_t material = GLASS;
    char name[64];
    if (choice < 0.8) {
        double albedo[3];
        for (int i = 0; i < 3; i++) {
            const double first = bp_random_next(random);
            albedo[i] = first * bp_random_next(random);
        }
        material = scene->material_count;
        snprintf(name, sizeof name, "matte %zu", material);
        BP_TRY(add_material(scene, matte(edition, albedo[0], albedo[1], albedo[2]), name, err));
    } else if (choice < 0.95) {
        double albedo[3];
        for (int i = 0; i < 3; i++)
            albedo[i] = edition->metal_low + (1 - edition->metal_low) * bp_random_next(random);
        const double fuzz = 0.5 * bp_random_next(random);
        material = scene->material_count;
        snprintf(name, sizeof name, "metal %zu", material);
        BP_TRY(add_material(scene, metal(edition, albedo[0], albedo[1], albedo[2], fuzz), name, err));
    }
    add_sphere(scene, x, 0.2, z, 0.2, material);
    return BP_OK;
}

/* ---- the whole ---------------------------------------------------------------------------------------- */

static void set_camera(BpCamera *camera, const Edition *edition) {
    bp_camera_defaults(camera);
    const double from[3] = {13, 2, 3};
    memcpy(camera->lookfrom, from, sizeof from);
    memset(camera->lookat, 0, sizeof camera->lookat);
    camera->width = 1200;
    camera->height = edition->height;
    camera->aspect_ratio = edition->height == 675 ? 16.0 / 9.0 : 3.0 / 2.0;
    camera->samples_per_pixel = edition->samples_per_pixel;
    camera->max_depth = edition->max_depth;
    camera->vfov_degrees = 20;
    camera->focus_dist = 10;
    camera->lens_radius = edition->defocus_degrees > 0
                              ? bp_lens_radius(edition->defocus_degrees, camera->focus_dist)
                              : edition->aperture / 2;
}

static BpStatus fill(BpScene *scene, const Edition *edition, int grid, uint64_t seed, BpError *err) {
    const BpMaterial glass = {.kind = BP_MATERIAL_DIELECTRIC, .refraction_index = 1.5};
    BpRandom random = {seed};
    BP_TRY(bp_copy_text(edition->title, &scene->title, err));
    BP_TRY(bp_copy_text(edition->source, &scene->source, err));
    set_camera(&scene->camera, edition);
    BP_TRY(add_material(scene, matte(edition, 0.5, 0.5, 0.5), "ground", err));
    BP_TRY(add_material(scene, glass, "glass", err));
    BP_TRY(add_material(scene, matte(edition, 0.4, 0.2, 0.1), "brown", err));
    BP_TRY(add_material(scene, metal(edition, 0.7, 0.6, 0.5, 0), "mirror", err));
    add_sphere(scene, 0, -1000, 0, 1000, 0);
    const int end = edition->extra_row ? grid + 1 : grid;
    for (int a = -grid; a < end; a++) {
        for (int b = -grid; b < end; b++) BP_TRY(add_cell(scene, edition, a, b, &random, err));
    }
    add_sphere(scene, 0, 1, 0, 1, GLASS);
    add_sphere(scene, -4, 1, 0, 1, BIG_MATTE);
    add_sphere(scene, 4, 1, 0, 1, BIG_METAL);
    return bp_scene_validate(scene, err);
}

BpStatus bp_scene_generate_cover(const char *edition_name, unsigned grid, uint64_t seed, BpScene **scene,
                                 BpError *err) {
    const Edition *edition = NULL;
    *scene = NULL;
    for (size_t i = 0; i < sizeof editions / sizeof *editions; i++) {
        if (strcmp(edition_name, editions[i].name) == 0) edition = &editions[i];
    }
    if (edition == NULL)
        return bp_fail(err, BP_ERR_USAGE, "edition: found \"%s\", expected 1, 3, 3rust or 4", edition_name);
    if (grid > GRID_MAX)
        return bp_fail(err, BP_ERR_USAGE, "grid: found %u, expected 0 to %d (in the book: 11)", grid,
                       GRID_MAX);
    const size_t side = 2 * (size_t)grid + (edition->extra_row ? 1 : 0);
    BpScene *result = NULL;
    BP_TRY(bp_scene_create_empty("", &result, err));
    BpStatus status = BP_OK;
    result->materials = malloc((side * side + NAMED_MATERIALS) * sizeof *result->materials);
    result->spheres = malloc((side * side + NAMED_SPHERES) * sizeof *result->spheres);
    if (result->materials == NULL || result->spheres == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu spheres", side * side + NAMED_SPHERES);
        goto done;
    }
    BP_TRY_GOTO(status, fill(result, edition, (int)grid, seed, err), done);
    *scene = result;
    result = NULL;
done:
    bp_scene_destroy(&result);
    return status;
}
