/* film_scene.c: the scale and the hash of a scene, which tell whose sums these are; see film.h.
 */
#include "film.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SAMPLE_BITS 38 /* a sample is at most 2^38 steps; 2^24 of them reach 2^62 */
#define SCALE_MAX 126  /* 2^scale and its inverse are normal floats */

static double largest(const double rgb[3]) {
    return fmax(rgb[0], fmax(rgb[1], rgb[2]));
}

static bool scatters(const BpMaterial *material) {
    return material->kind == BP_MATERIAL_LAMBERTIAN || material->kind == BP_MATERIAL_METAL ||
           material->kind == BP_MATERIAL_DIELECTRIC;
}

/* The largest share of light that the sphere passes on. */
static double sphere_albedo(const BpScene *scene, const BpSphere *sphere) {
    const BpMaterial *material = &scene->materials[sphere->material];
    if (material->kind == BP_MATERIAL_DIELECTRIC) return 1;
    if (sphere->albedo == BP_NO_ALBEDO) return largest(material->albedo);
    const float *albedo = scene->albedos[sphere->albedo];
    return (double)fmaxf(albedo[0], fmaxf(albedo[1], albedo[2]));
}

double bp_scene_radiance_bound(const BpScene *scene, uint32_t max_depth) {
    double brightest = fmax(largest(scene->background_bottom), largest(scene->background_top));
    double passed_on = 0;
    for (size_t i = 0; i < scene->sphere_count; i++) {
        const BpMaterial *material = &scene->materials[scene->spheres[i].material];
        const double emitted = largest(material->emit);
        brightest = fmax(brightest, emitted);
        /* What a `normals` sphere shows is a colour up to 1. */
        if (material->kind == BP_MATERIAL_NORMALS) brightest = fmax(brightest, 1 + emitted);
        if (emitted > 0 && scatters(material))
            passed_on = fmax(passed_on, sphere_albedo(scene, &scene->spheres[i]));
    }
    return brightest * fmin(1 / (1 - fmin(passed_on, 1)), max_depth);
}

int32_t bp_film_scale(const BpScene *scene, uint32_t max_depth) {
    const double bound = bp_scene_radiance_bound(scene, max_depth);
    if (!(bound > 0)) return SAMPLE_BITS;
    int exponent = 0;
    const double mantissa = frexp(bound, &exponent); /* bound = mantissa * 2^exponent, 1/2 <= mantissa < 1 */
    const int ceil_log2 = mantissa > 0.5 ? exponent : exponent - 1;
    const int scale = SAMPLE_BITS - ceil_log2;
    return scale > SCALE_MAX ? SCALE_MAX : scale < -SCALE_MAX ? -SCALE_MAX : scale;
}

/* ---- the hash ---- */

/* FNV-1a (Fowler, Noll and Vo 1991) with 64-bit words for its bytes, eight times as fast for millions of
 * spheres; the shift brings the high bits down again, which a multiplication alone never does. */
static uint64_t mix(uint64_t hash, uint64_t word) {
    hash = (hash ^ word) * 0x100000001b3u;
    return hash ^ (hash >> 29);
}

static uint64_t mix_real(uint64_t hash, double value) {
    uint64_t bits;
    value += 0.0; /* -0 becomes 0 */
    memcpy(&bits, &value, sizeof bits);
    return mix(hash, bits);
}

static uint64_t mix_reals(uint64_t hash, const double *values, size_t count) {
    for (size_t i = 0; i < count; i++) hash = mix_real(hash, values[i]);
    return hash;
}

static uint64_t mix_camera(uint64_t hash, const BpCamera *camera) {
    /* The picture's proportions are those of its pixels, so aspect_ratio has no say. */
    hash = mix(hash, ((uint64_t)camera->width << 32) | camera->height);
    hash = mix_real(hash, camera->vfov_degrees);
    hash = mix_reals(hash, camera->lookfrom, 3);
    hash = mix_reals(hash, camera->lookat, 3);
    hash = mix_reals(hash, camera->vup, 3);
    hash = mix_real(hash, camera->lens_radius);
    if (camera->lens_radius > 0) hash = mix_real(hash, camera->focus_dist);
    return mix(hash, (uint64_t)camera->pixel_sampling);
}

/* All but the albedo, which a sphere may bring itself. */
static uint64_t hash_material(const BpMaterial *material) {
    uint64_t hash = mix(0xcbf29ce484222325u, (uint64_t)material->kind);
    hash = mix_reals(hash, material->emit, 3);
    switch (material->kind) {
    case BP_MATERIAL_LAMBERTIAN:
        return mix(hash, (uint64_t)material->scatter);
    case BP_MATERIAL_METAL:
        hash = mix_real(hash, material->fuzz);
        return material->fuzz > 0 ? mix(hash, (uint64_t)material->fuzz_shape) : hash;
    case BP_MATERIAL_DIELECTRIC:
        hash = mix_real(hash, material->refraction_index);
        return mix(mix(hash, (uint64_t)material->fresnel), (uint64_t)material->total_reflection);
    case BP_MATERIAL_DIFFUSE_LIGHT:
    case BP_MATERIAL_NORMALS:
        break;
    }
    return hash;
}

static uint64_t mix_sphere(uint64_t hash, const BpScene *scene, const BpSphere *sphere) {
    const BpMaterial *material = &scene->materials[sphere->material];
    hash = mix_reals(hash, sphere->center, 3);
    /* Inside out matters to glass alone: other materials turn the normal to the ray. */
    hash = mix_real(hash, material->kind == BP_MATERIAL_DIELECTRIC ? sphere->radius : fabs(sphere->radius));
    if (material->kind != BP_MATERIAL_LAMBERTIAN && material->kind != BP_MATERIAL_METAL) return hash;
    if (sphere->albedo == BP_NO_ALBEDO) return mix_reals(hash, material->albedo, 3);
    for (size_t c = 0; c < 3; c++) hash = mix_real(hash, (double)scene->albedos[sphere->albedo][c]);
    return hash;
}

uint64_t bp_scene_hash(const BpScene *scene) {
    uint64_t hash = mix_camera(0xcbf29ce484222325u, &scene->camera);
    hash = mix_reals(hash, scene->background_bottom, 3);
    hash = mix_reals(hash, scene->background_top, 3);
    hash = mix(hash, scene->sphere_count);
    /* Most scenes use a material many times in a row. */
    uint32_t known = UINT32_MAX;
    uint64_t material_hash = 0;
    for (size_t i = 0; i < scene->sphere_count; i++) {
        const BpSphere *sphere = &scene->spheres[i];
        if (sphere->material != known) material_hash = hash_material(&scene->materials[sphere->material]);
        known = sphere->material;
        hash = mix_sphere(mix(hash, material_hash), scene, sphere);
    }
    return hash;
}
