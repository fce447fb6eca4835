/* embree_world.c: the scene as flat float tables (embree_paths.h). */
#include "embree_paths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint32_t material_flags(const BpMaterial *material) {
    uint32_t flags = (uint32_t)material->kind;
    switch (material->kind) {
    case BP_MATERIAL_LAMBERTIAN:
        if (material->scatter == BP_SCATTER_COSINE_CUBED) flags |= FLAG_BALL;
        if (material->scatter == BP_SCATTER_HEMISPHERE) flags |= FLAG_HEMISPHERE;
        break;
    case BP_MATERIAL_METAL:
        if (material->fuzz_shape == BP_FUZZ_BALL) flags |= FLAG_BALL;
        break;
    case BP_MATERIAL_DIELECTRIC:
        if (material->fresnel == BP_FRESNEL_EXACT) flags |= FLAG_EXACT;
        if (material->fresnel == BP_FRESNEL_NONE) flags |= FLAG_NO_FRESNEL;
        if (material->total_reflection == BP_TOTAL_ABSORB) flags |= FLAG_ABSORB;
        if (material->total_reflection == BP_TOTAL_REFRACT) flags |= FLAG_REFRACT;
        break;
    case BP_MATERIAL_DIFFUSE_LIGHT:
    case BP_MATERIAL_NORMALS:
    case BP_MATERIAL_INTERFACE:
    case BP_MATERIAL_OREN_NAYAR: /* not drawn by this peer, like the next three */
    case BP_MATERIAL_ROUGH_METAL:
    case BP_MATERIAL_GLOSSY:
    case BP_MATERIAL_ROUGH_DIELECTRIC:
        break;
    }
    return flags;
}

static uint32_t material_has(const BpMaterial *material) {
    const uint32_t flags = material_flags(material);
    uint32_t has = 0;
    if (material->kind == BP_MATERIAL_METAL) has |= HAS_METAL;
    if (material->kind == BP_MATERIAL_DIELECTRIC) has |= HAS_GLASS;
    if (material->kind == BP_MATERIAL_NORMALS) has |= HAS_NORMALS;
    for (int k = 0; k < 3; k++) {
        if (material->emit[k] > 0) has |= HAS_EMISSION;
    }
    if (flags & FLAG_BALL) has |= HAS_BALL;
    if (flags & FLAG_HEMISPHERE) has |= HAS_HEMISPHERE;
    if (flags & FLAG_EXACT) has |= HAS_EXACT;
    if (flags & (FLAG_ABSORB | FLAG_NO_FRESNEL)) has |= HAS_ODD_GLASS;
    return has;
}

static void set_surface(World *world, size_t entry, const BpMaterial *material, bool inside_out) {
    float *values = world->values + entry * SURFACE_VALUES;
    world->flags[entry] = material_flags(material);
    for (int k = 0; k < 3; k++) {
        values[k] = material->kind == BP_MATERIAL_DIELECTRIC ? 1 : (float)material->albedo[k];
        values[4 + k] = (float)material->emit[k];
    }
    const double index = inside_out ? 1 / material->refraction_index : material->refraction_index;
    values[3] = (float)(material->kind == BP_MATERIAL_DIELECTRIC ? index : material->fuzz);
}

static int compare_radius(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* The largest spheres, when they are at least four times as large as most. */
static void choose_huge(World *world) {
    const size_t count = world->scene->sphere_count;
    float *radii = peer_allocate(count, sizeof *radii);
    for (size_t i = 0; i < count; i++) radii[i] = world->points[4 * i + 3];
    qsort(radii, count, sizeof *radii, compare_radius);
    const float least =
        count > 2 * HUGE_MAX ? fmaxf(4 * radii[count / 2], radii[count - HUGE_MAX]) : INFINITY;
    for (size_t i = 0; i < count && world->huge_count < HUGE_MAX; i++) {
        if (world->points[4 * i + 3] >= least) world->huge[world->huge_count++] = (uint32_t)i;
    }
    free(radii);
}

World world_create(const BpScene *scene, uint64_t seed, bool huge) {
    PeerCamera camera;
    peer_camera(scene, &camera);
    World world = {.scene = scene,
                   .lens = camera.lens,
                   .center = camera.center,
                   .max_depth = scene->camera.max_depth,
                   .seed = (uint32_t)(seed * 0x9e3779b97f4a7c15u >> 32)};
    for (int k = 0; k < 3; k++) {
        world.corner[k] = (float)camera.corner[k];
        world.right[k] = (float)camera.right[k];
        world.down[k] = (float)camera.down[k];
        world.lens_right[k] = (float)camera.lens_right[k];
        world.lens_up[k] = (float)camera.lens_up[k];
        const double bottom = scene->background_bottom[k], top = scene->background_top[k];
        world.sky_middle[k] = (float)(0.5 * (bottom + top)); /* at y = 0 */
        world.sky_slope[k] = (float)(0.5 * (top - bottom));
    }
    /* Surfaces: each material as it is and inside out, then one for every sphere with a colour of its own. */
    const size_t spheres = scene->sphere_count, triangles = scene->triangle_count,
                 materials = scene->material_count;
    world.shapes = spheres + triangles;
    size_t own = 0;
    for (size_t i = 0; i < spheres; i++) own += scene->spheres[i].albedo != BP_NO_ALBEDO;
    const size_t surfaces = 2 * materials + own + 1; /* the last is the sky's */
    world.values = peer_allocate(surfaces * SURFACE_VALUES, sizeof *world.values);
    world.flags = peer_allocate(surfaces, sizeof *world.flags);
    world.flags[surfaces - 1] = BP_MATERIAL_DIFFUSE_LIGHT; /* scatters nothing; its numbers are all 0 */
    world.points = peer_allocate(spheres, 4 * sizeof(float));
    world.vertices = peer_allocate(triangles, 9 * sizeof(float));
    world.surface = peer_allocate(world.shapes + 1, sizeof *world.surface);
    world.surface[world.shapes] = (uint32_t)surfaces - 1;
    for (size_t m = 0; m < 2 * materials; m++) set_surface(&world, m, &scene->materials[m / 2], m & 1);
    size_t next = 2 * materials;
    for (size_t i = 0; i < spheres; i++) {
        const BpSphere *sphere = &scene->spheres[i];
        const BpMaterial *material = &scene->materials[sphere->material];
        const bool inside_out = sphere->radius < 0;
        world.has |= material_has(material);
        for (int k = 0; k < 3; k++)
            world.points[4 * i + (size_t)k] = (float)(sphere->center[k] - camera.origin[k]);
        world.points[4 * i + 3] = (float)fabs(sphere->radius);
        world.surface[i] = 2 * sphere->material + inside_out;
        if (sphere->albedo != BP_NO_ALBEDO) {
            set_surface(&world, next, material, inside_out);
            if (material->kind != BP_MATERIAL_DIELECTRIC)
                memcpy(world.values + next * SURFACE_VALUES, scene->albedos[sphere->albedo],
                       3 * sizeof(float));
            world.surface[i] = (uint32_t)next++;
        }
    }
    for (size_t i = 0; i < triangles; i++) {
        const BpTriangle *triangle = &scene->triangles[i];
        world.has |= material_has(&scene->materials[triangle->material]);
        for (size_t k = 0; k < 9; k++)
            world.vertices[9 * i + k] = (float)(triangle->vertices[k / 3][k % 3] - camera.origin[k % 3]);
        world.surface[spheres + i] = 2 * triangle->material;
    }
    if (huge && spheres > 0) choose_huge(&world);
    return world;
}
