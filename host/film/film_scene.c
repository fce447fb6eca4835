/* film_scene.c: the scale of a scene's sums, and the hash by which films are compared; see film.h. */
#include "film.h"

#include "roulette_types.h"
#include "scene/material.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SAMPLE_BITS 38 /* a sample is at most 2^38 steps; 2^24 of them reach 2^62 */
#define PI 3.14159265358979323846
#define SCALE_MAX 126 /* 2^scale and its inverse are normal floats */

static double largest(const double rgb[3]) {
    return fmax(rgb[0], fmax(rgb[1], rgb[2]));
}

/* The largest share of light that a shape passes on. */
static double shape_albedo(const BpScene *scene, size_t shape) {
    const BpMaterial *material = &scene->materials[bp_shape_material(scene, shape)];
    const uint32_t own = bp_shape_albedo(scene, shape);
    const BpCapsule *const capsule = bp_shape_capsule(scene, shape);
    if (!bp_material_has(material->kind, BP_MEMBER_ALBEDO)) return 1;
    if (own == BP_NO_ALBEDO) return largest(material->albedo);
    const float *albedo = scene->albedos[own],
                *other = scene->albedos[capsule != NULL ? capsule->albedo[1] : own];
    return (double)fmaxf(fmaxf(albedo[0], fmaxf(albedo[1], albedo[2])),
                         fmaxf(other[0], fmaxf(other[1], other[2])));
}

/* 1 + a + a^2 + ... of `terms` terms, or a little more. With roulette, each of the `deep` last ones may be as
 * large as its limit. */
static double geometric(double a, double terms, double deep) {
    return a < 1 ? fmin(1 / (1 - a) + deep * (double)ROULETTE_LIMIT, terms) : terms;
}

static double angle_between(const double a[3], const double b[3]) {
    const double across =
        hypot(hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2]), a[0] * b[1] - a[1] * b[0]);
    return atan2(across, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/* The radiance of discs that share a direction adds up. In any direction, every two of the discs there
 * overlap, so it is at most that of a disc and all that overlap it. */
static double discs_together(const BpScene *scene) {
    double most = 0;
    for (size_t i = 0; i < scene->disc_count; i++) {
        const BpDisc *a = &scene->discs[i];
        double sum[3] = {0};
        for (size_t j = 0; j < scene->disc_count; j++) {
            const BpDisc *b = &scene->discs[j];
            const double apart = angle_between(a->direction, b->direction) * (180 / PI);
            const double slack = 1e-4; /* degrees: what single precision makes of directions */
            if (apart > a->half_angle_degrees + b->half_angle_degrees + slack) continue;
            for (int c = 0; c < 3; c++) sum[c] += b->radiance[c];
        }
        most = fmax(most, largest(sum));
    }
    return most;
}

/* The most that a path may weigh for the colour that it flies by (kernels/medium/flight.cl). */
static double flight_weight(const BpScene *scene) {
    for (size_t i = 0; i < scene->medium_count; i++)
        if (bp_medium_is_coloured(&scene->media[i])) return 3;
    return 1;
}

/* Whether light may come by way of two balls of glass or mirrors in turn. */
static bool has_pair(const BpScene *scene) {
    size_t count = 0;
    for (size_t i = 0; i < scene->sphere_count && count < 2; i++) {
        const BpMaterial *material = &scene->materials[scene->spheres[i].material];
        count += material->kind == BP_MATERIAL_DIELECTRIC ||
                 (material->kind == BP_MATERIAL_METAL && !(material->fuzz > 0));
    }
    return count == 2;
}

double bp_scene_radiance_bound(const BpScene *scene, uint32_t max_depth, BpLightSampling light_sampling,
                               BpCaustics caustics, BpRoulette roulette) {
    double brightest = fmax(largest(scene->background_bottom), largest(scene->background_top));
    double brightest_lamp = 0, passed_on = 0, scattered = 0, heaviest = 1;
    if (scene->environment != NULL) brightest = brightest_lamp = largest(scene->environment->bound);
    brightest += discs_together(scene);
    for (size_t i = 0; i < scene->disc_count; i++)
        brightest_lamp = fmax(brightest_lamp, largest(scene->discs[i].radiance));
    /* Most scenes use a material many times in a row; the colours of its spheres matter only where light is
     * passed on. */
    uint32_t known = UINT32_MAX;
    bool colours = true;
    for (size_t i = 0; i < bp_scene_shapes(scene); i++) {
        if (bp_shape_material(scene, i) == known && !colours) continue;
        known = bp_shape_material(scene, i);
        const BpMaterial *material = &scene->materials[known];
        colours = largest(material->emit) > 0 ||
                  (light_sampling != BP_LIGHT_SAMPLING_OFF && bp_material_is_lit(material));
        const double emitted = largest(material->emit);
        brightest = fmax(brightest, emitted);
        brightest_lamp = fmax(brightest_lamp, emitted);
        if (bp_material_is(material->kind, BP_SHOWS_COLOUR)) brightest = fmax(brightest, 1 + emitted);
        if (!bp_material_is(material->kind, BP_SCATTERS)) continue;
        heaviest = fmax(heaviest, bp_material_types[material->kind].weight);
        const double albedo = shape_albedo(scene, i);
        if (bp_material_is_lit(material)) scattered = fmax(scattered, albedo);
        if (emitted > 0) passed_on = fmax(passed_on, albedo);
    }
    for (size_t i = 0; i < scene->medium_count; i++)
        if (bp_medium_scatters(&scene->media[i])) scattered = 1; /* rays go to lamps from there too */
    /* Lobes that weigh more than the albedo do so at every vertex. */
    const double weight = flight_weight(scene) * pow(heaviest, max_depth > 0 ? max_depth - 1 : 0);
    const double deep =
        roulette == BP_ROULETTE_ON && max_depth > ROULETTE_SEGMENTS ? max_depth - ROULETTE_SEGMENTS : 0;
    double bound = weight * brightest * geometric(passed_on, max_depth, passed_on > 0 ? deep : 0);
    /* A ray to a lamp brings half of its radiance at most, and so does each of the up to three ways through a
     * focuser, and of the up to five through a pair. To the camera lead up to three through each of four
     * chains. */
    const double focused = caustics == BP_CAUSTICS_ON ? 3 * 0.5 : 0;
    const double paired = caustics == BP_CAUSTICS_ON && has_pair(scene) ? 5 * 0.5 : 0;
    if (light_sampling != BP_LIGHT_SAMPLING_OFF && max_depth >= 2)
        bound += weight * brightest_lamp *
                 ((0.5 + focused + paired) * scattered * geometric(scattered, max_depth - 1, deep) +
                  4 * focused + paired);
    if (scene->backdrop != BP_BACKDROP_COLORS) return bound;
    return fmax(bound, fmax(largest(scene->backdrop_bottom), largest(scene->backdrop_top)));
}

int32_t bp_film_scale(const BpScene *scene, uint32_t max_depth, BpLightSampling light_sampling,
                      BpCaustics caustics, BpRoulette roulette) {
    const double bound = bp_scene_radiance_bound(scene, max_depth, light_sampling, caustics, roulette);
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
    /* The picture's proportions follow from its pixels, so aspect_ratio does not matter. */
    hash = mix(hash, ((uint64_t)camera->width << 32) | camera->height);
    hash = mix_real(hash, camera->vfov_degrees);
    hash = mix_reals(hash, camera->lookfrom, 3);
    hash = mix_reals(hash, camera->lookat, 3);
    hash = mix_reals(hash, camera->vup, 3);
    hash = mix_real(hash, camera->lens_radius);
    if (camera->lens_radius > 0) hash = mix_real(hash, camera->focus_dist);
    if (camera->projection == BP_ORTHOGRAPHIC)
        hash = mix_real(mix(hash, 0x6f7274686fu), bp_camera_plane_height(camera));
    return mix(hash, (uint64_t)camera->pixel_sampling);
}

static uint64_t mix_noise(uint64_t hash, const BpTexture *texture) {
    hash = mix(mix(hash, (uint64_t)texture->octaves << 32 | texture->seed), (uint64_t)texture->pattern);
    if (!bp_texture_has_waves(texture)) return hash;
    return mix_real(mix_real(mix(hash, (uint64_t)texture->axis), texture->period), texture->distortion);
}

/* A member that varies: what by. `sphere_colour`: the sphere has a colour of its own instead of the albedo.
 */
static uint64_t mix_textures(uint64_t hash, const BpScene *scene, const BpMaterial *material,
                             bool sphere_colour) {
    for (int m = 0; m < BP_MEMBER_COUNT; m++) {
        if (material->texture[m] == 0 || (m == BP_MEMBER_ALBEDO && sphere_colour)) continue;
        const BpTexture *texture = &scene->textures[material->texture[m] - 1];
        hash = mix(hash, 0x7465787475726530u + (uint64_t)m);
        hash = mix(hash, (uint64_t)texture->type << 8 | (uint64_t)texture->mapping);
        if (bp_texture_has(texture, BP_TEXTURE_FILE))
            hash = mix(mix(hash, texture->image->hash), (uint64_t)texture->wrap);
        for (int i = 0; i < 2 && bp_texture_has(texture, BP_TEXTURE_COLORS); i++)
            hash = mix_reals(hash, texture->colors[i], 3);
        if (texture->mapping == BP_MAPPING_SOLID) {
            hash = mix_reals(mix_real(hash, texture->size), texture->origin, 3);
            if (bp_texture_has(texture, BP_TEXTURE_PATTERN)) hash = mix_noise(hash, texture);
            continue;
        }
        hash = mix_real(mix_reals(hash, texture->up, 3), texture->turn_degrees);
        hash = mix(hash, (uint64_t)texture->repeat[0] << 32 | texture->repeat[1]);
    }
    return hash;
}

/* All but the albedo, which a shape may bring itself. */
static uint64_t hash_material(const BpMaterial *material) {
    uint64_t hash = mix(0xcbf29ce484222325u, (uint64_t)material->kind);
    hash = mix_reals(hash, material->emit, 3);
    for (int m = 0; m < BP_MEMBER_COUNT; m++) {
        const BpMemberInfo *member = &bp_members[m];
        if (m == BP_MEMBER_ALBEDO || m == BP_MEMBER_EMIT || !bp_material_has(material->kind, (BpMember)m))
            continue;
        if (m == BP_MEMBER_OPACITY && bp_material_opacity(material) == 1) continue;
        if (member->form != BP_FORM_CHOICE)
            hash = mix_reals(hash, bp_member_values_of(material, (BpMember)m),
                             member->form == BP_FORM_COLOUR ? 3 : 1);
        else if (member->ignored_if_zero == BP_MEMBER_COUNT ||
                 *bp_member_values_of(material, member->ignored_if_zero) > 0)
            hash = mix(hash, bp_member_choice(material, (BpMember)m));
    }
    return hash;
}

static uint64_t mix_medium(uint64_t hash, const BpScene *scene, uint32_t number) {
    const BpMedium *medium = &scene->media[number - 1];
    hash = mix_reals(mix(hash, 0x6d656469756du), medium->absorption, 3);
    hash = mix_reals(hash, medium->scattering, 3);
    return mix_real(hash, medium->anisotropy);
}

static uint64_t mix_interior(uint64_t hash, const BpScene *scene, size_t shape) {
    const uint32_t interior = bp_shape_interior(scene, shape);
    return interior != 0 ? mix_medium(hash, scene, interior) : hash;
}

/* What a material has beside hash_material(), on a shape with an albedo of its own or BP_NO_ALBEDO. */
static uint64_t mix_colours(uint64_t hash, const BpScene *scene, const BpMaterial *material,
                            uint32_t albedo) {
    if (bp_material_varies(material)) hash = mix_textures(hash, scene, material, albedo != BP_NO_ALBEDO);
    if (!bp_material_has(material->kind, BP_MEMBER_ALBEDO)) return hash;
    if (albedo == BP_NO_ALBEDO) return mix_reals(hash, material->albedo, 3);
    for (size_t c = 0; c < 3; c++) hash = mix_real(hash, (double)scene->albedos[albedo][c]);
    return hash;
}

static uint64_t mix_sphere(uint64_t hash, const BpScene *scene, const BpSphere *sphere) {
    const BpMaterial *material = &scene->materials[sphere->material];
    hash = mix_reals(hash, sphere->center, 3);
    /* Materials without an inside turn the normal towards the ray. */
    const bool inside = bp_material_is(material->kind, BP_HAS_INSIDE);
    hash = mix_real(hash, inside ? sphere->radius : fabs(sphere->radius));
    return mix_colours(hash, scene, material, sphere->albedo);
}

/* Members that came later: a scene without them keeps the hash that it had before. */
static uint64_t mix_surroundings(uint64_t hash, const BpScene *scene) {
    double up[3];
    bp_background_up(scene, up);
    bool is_gradient = scene->environment != NULL;
    if (scene->environment != NULL)
        hash = mix_real(mix(mix(hash, 0x656e7669726fu), scene->environment->hash), scene->environment_turn);
    for (int c = 0; c < 3; c++)
        is_gradient = is_gradient || scene->background_bottom[c] != scene->background_top[c];
    if (is_gradient && !(up[0] == 0 && up[1] == 1 && up[2] == 0)) hash = mix_reals(mix(hash, 0x7570u), up, 3);
    if (scene->shadow_catcher.present)
        hash = mix_real(mix_reals(mix(hash, 0x7363u), scene->shadow_catcher.normal, 3),
                        scene->shadow_catcher.distance);
    if (scene->backdrop == BP_BACKDROP_SKY) return hash;
    hash = mix(hash, 0x6264u + (uint64_t)scene->backdrop);
    if (scene->backdrop == BP_BACKDROP_NONE) return hash;
    hash = mix_reals(hash, scene->backdrop_bottom, 3);
    return mix_reals(hash, scene->backdrop_top, 3);
}

uint64_t bp_scene_hash(const BpScene *scene) {
    uint64_t hash = mix_camera(0xcbf29ce484222325u, &scene->camera);
    hash = mix_reals(hash, scene->background_bottom, 3);
    hash = mix_reals(hash, scene->background_top, 3);
    for (size_t i = 0; i < scene->disc_count; i++) {
        const BpDisc *disc = &scene->discs[i];
        hash = mix_reals(hash, disc->direction, 3);
        hash = mix_real(hash, disc->half_angle_degrees);
        hash = mix_reals(hash, disc->radiance, 3);
        hash = mix(hash, disc->visible_to_camera);
    }
    hash = mix_surroundings(hash, scene);
    if (bp_scene_medium(scene) != 0) hash = mix_medium(hash, scene, bp_scene_medium(scene));
    hash = mix(hash, scene->sphere_count);
    /* Most scenes use a material many times in a row. */
    uint32_t known = UINT32_MAX;
    uint64_t material_hash = 0;
    for (size_t i = 0; i < scene->sphere_count; i++) {
        const BpSphere *sphere = &scene->spheres[i];
        if (sphere->material != known) material_hash = hash_material(&scene->materials[sphere->material]);
        known = sphere->material;
        hash = mix_sphere(mix(hash, material_hash), scene, sphere);
        hash = mix_interior(hash, scene, i);
        if (bp_sphere_moves(scene, i))
            hash = mix_reals(mix(hash, 0x6d6f76657321u), bp_sphere_end(scene, i), 3);
    }
    if (scene->triangle_count > 0) hash = mix(hash, scene->triangle_count);
    for (size_t i = 0; i < scene->triangle_count; i++) {
        const BpTriangle *triangle = &scene->triangles[i];
        if (i == 0 || triangle->material != known)
            material_hash = hash_material(&scene->materials[triangle->material]);
        known = triangle->material;
        for (int k = 0; k < 3; k++) hash = mix_reals(mix(hash, material_hash), triangle->vertices[k], 3);
        hash = mix_colours(hash, scene, &scene->materials[triangle->material], triangle->albedo);
        /* Bodies may be the same triangles in other groups. */
        if (bp_body_of(scene, i) != BP_NO_BODY) hash = mix(hash, bp_body_of(scene, i));
        hash = mix_interior(hash, scene, scene->sphere_count + i);
        const float(*const normals)[3] = bp_triangle_normals(scene, i);
        for (int k = 0; k < 9 && normals != NULL; k++) hash = mix_real(hash, (double)normals[k / 3][k % 3]);
        const float *const at = bp_triangle_coordinates(scene, i);
        if (at != NULL) hash = mix(hash, 0x7576u);
        for (int k = 0; k < 6 && at != NULL; k++) hash = mix_real(hash, (double)at[k]);
    }
    if (scene->capsule_count > 0) hash = mix(mix(hash, 0x63617073u), scene->capsule_count);
    for (size_t i = 0; i < scene->capsule_count; i++) {
        const BpCapsule *capsule = &scene->capsules[i];
        const BpMaterial *material = &scene->materials[capsule->material];
        if (i == 0 || capsule->material != known) material_hash = hash_material(material);
        known = capsule->material;
        hash = mix_real(mix(hash, material_hash), capsule->radius);
        for (int k = 0; k < 2; k++)
            hash = mix_colours(mix_reals(hash, capsule->ends[k], 3), scene, material, capsule->albedo[k]);
        hash = mix_interior(hash, scene, scene->sphere_count + scene->triangle_count + i);
    }
    return hash;
}
