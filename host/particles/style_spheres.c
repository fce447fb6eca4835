/* style_spheres.c: see style_spheres.h. */
#include "style_spheres.h"

#include "base/format.h"
#include "base/pages.h"
#include "base/thread_pool.h"
#include "style_colors.h"
#include "style_shapes.h"
#include "style_sizes.h"

#include <stdlib.h>
#include <string.h>

/* Room for `count` more spheres and `colors` more colours. */
static BpStatus make_room(BpStyleJob *job, size_t count, size_t colors, BpError *err) {
    BpScene *const scene = job->scene;
    if (count > BP_SPHERES_MAX || scene->sphere_count > BP_SPHERES_MAX - count)
        return bp_fail(err, BP_ERR_SCENE, "found more than %u spheres, expected fewer", BP_SPHERES_MAX);
    if (scene->sphere_count + count > job->capacity) {
        size_t capacity = scene->sphere_count + count;
        if (job->capacity > 0 && capacity < job->capacity + job->capacity / 2)
            capacity = job->capacity + job->capacity / 2;
        const size_t bytes = (capacity + 1) * sizeof(BpSphere);
        BpSphere *const spheres = bp_large_pages(realloc(scene->spheres, bytes), bytes);
        if (spheres == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu spheres", capacity);
        scene->spheres = spheres;
        job->capacity = capacity;
    }
    if (scene->albedo_count + colors > job->albedo_capacity) {
        size_t capacity = scene->albedo_count + colors;
        if (job->albedo_capacity > 0 && capacity < job->albedo_capacity + job->albedo_capacity / 2)
            capacity = job->albedo_capacity + job->albedo_capacity / 2;
        const size_t bytes = (capacity + 1) * sizeof *scene->albedos;
        float(*const albedos)[3] = bp_large_pages(realloc(scene->albedos, bytes), bytes);
        if (albedos == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu colours", capacity);
        scene->albedos = albedos;
        job->albedo_capacity = capacity;
    }
    return BP_OK;
}

static bool has_albedos(const BpStyleJob *job) {
    return bp_material_has(job->scene->materials[job->material].kind, BP_MEMBER_ALBEDO);
}

/* Sphere `place` of those that follow the scene's own, and colour `color_place`; with room for both. NULL:
 * the colour is there already. */
static void fill_sphere(const BpStyleJob *job, size_t place, const double center[3], double radius,
                        size_t color_place, const double color[3]) {
    const BpScene *const scene = job->scene;
    const size_t albedo = scene->albedo_count + color_place;
    BpSphere *const sphere = &scene->spheres[scene->sphere_count + place];
    *sphere = (BpSphere){.radius = radius, .material = job->material, .albedo = BP_NO_ALBEDO};
    memcpy(sphere->center, center, sizeof sphere->center);
    if (!has_albedos(job)) return;
    for (int c = 0; c < 3 && color != NULL; c++)
        scene->albedos[albedo][c] = color[c] > 0 ? color[c] < 1 ? (float)color[c] : 1.0f : 0.0f;
    sphere->albedo = (uint32_t)albedo;
}

static void count_spheres(BpStyleJob *job, size_t count, size_t colors) {
    job->scene->sphere_count += count;
    if (has_albedos(job)) job->scene->albedo_count += colors;
}

/* The place of a colour; bonds in turn often have the same. */
static uint32_t albedo_of(BpStyleJob *job, const double color[3]) {
    BpScene *const scene = job->scene;
    float share[3];
    if (!has_albedos(job)) return BP_NO_ALBEDO;
    for (int c = 0; c < 3; c++) share[c] = color[c] > 0 ? color[c] < 1 ? (float)color[c] : 1.0f : 0.0f;
    for (size_t i = scene->albedo_count; i > 0 && i + 2 > scene->albedo_count; i--)
        if (scene->albedos[i - 1][0] == share[0] && scene->albedos[i - 1][1] == share[1] &&
            scene->albedos[i - 1][2] == share[2])
            return (uint32_t)(i - 1);
    memcpy(scene->albedos[scene->albedo_count], share, sizeof share);
    return (uint32_t)scene->albedo_count++;
}

BpStatus bp_style_put_color(BpStyleJob *job, const double color[3], uint32_t *albedo, BpError *err) {
    BP_TRY(make_room(job, 0, 1, err));
    *albedo = albedo_of(job, color);
    return BP_OK;
}

BpStatus bp_style_put_capsule(BpStyleJob *job, const double a[3], const double b[3], double radius,
                              const double color_a[3], const double color_b[3], BpError *err) {
    BpScene *const scene = job->scene;
    BP_TRY(make_room(job, 0, 2, err));
    if (bp_scene_shapes(scene) >= BP_SPHERES_MAX)
        return bp_fail(err, BP_ERR_SCENE, "found more than %u spheres and bonds, expected fewer",
                       BP_SPHERES_MAX);
    if (scene->capsule_count >= job->capsule_capacity) {
        const size_t capacity = scene->capsule_count + scene->capsule_count / 2 + 64;
        BpCapsule *const capsules = realloc(scene->capsules, capacity * sizeof *capsules);
        if (capsules == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu bonds", capacity);
        scene->capsules = capsules;
        job->capsule_capacity = capacity;
    }
    BpCapsule *const capsule = &scene->capsules[scene->capsule_count];
    *capsule = (BpCapsule){.radius = radius, .material = job->material};
    memcpy(capsule->ends[0], a, sizeof capsule->ends[0]);
    memcpy(capsule->ends[1], b, sizeof capsule->ends[1]);
    capsule->albedo[0] = albedo_of(job, color_a);
    capsule->albedo[1] = albedo_of(job, color_b);
    scene->capsule_count++;
    return BP_OK;
}

/* Particles become spheres block by block, on all threads: those without a radius are found first, which says
 * where the spheres of each block belong. */
typedef struct Blocks {
    BpStyleJob *job;
    size_t *places; /* of each block: how many spheres are shown, then the place of its first */
    size_t *bodies; /* of each block: how many others are */
    bool one_color; /* of all: then there is one entry for it, which caches hold */
} Blocks;

static void find_radii(void *context, uint32_t block, unsigned thread) {
    (void)thread;
    const Blocks *const blocks = context;
    BpStyleJob *const job = blocks->job;
    for (size_t i = bp_block_begin(block); i < bp_block_end(block, job->p->count); i++) {
        if (!job->shown[i]) continue;
        const double radius = bp_style_radius(job, i);
        /* As in scenes; NaN, 0 and below: nothing to see. */
        job->shown[i] = radius > 1e-37 && radius <= BP_COORDINATE_MAX;
        if (!job->shown[i]) continue;
        if (bp_style_has_body(job, i))
            blocks->bodies[block]++;
        else
            blocks->places[block]++;
    }
}

static void fill_spheres(void *context, uint32_t block, unsigned thread) {
    (void)thread;
    const Blocks *const blocks = context;
    const BpStyleJob *const job = blocks->job;
    size_t place = blocks->places[block];
    for (size_t i = bp_block_begin(block); i < bp_block_end(block, job->p->count); i++) {
        double color[3];
        if (!job->shown[i] || bp_style_has_body(job, i)) continue;
        if (!blocks->one_color || place == 0) bp_style_color(job, i, color);
        fill_sphere(job, place, job->p->position[i], bp_style_radius(job, i), blocks->one_color ? 0 : place,
                    !blocks->one_color || place == 0 ? color : NULL);
        place++;
    }
}

BpStatus bp_style_put_particles(BpStyleJob *job, BpError *err) {
    const BpParticles *const p = job->p;
    const uint32_t block_count = bp_block_count(p->count);
    size_t put = 0, bodies = 0;
    const bool one_color = job->color_by == BP_COLOR_CONSTANT && job->style->color_count == 0;
    BP_TRY(make_room(job, job->shown_count, one_color ? 1 : job->shown_count, err));
    Blocks blocks = {job, calloc((size_t)block_count + 1, sizeof *blocks.places),
                     calloc((size_t)block_count + 1, sizeof *blocks.bodies), one_color};
    BpThreadPool *pool = bp_thread_pool_create(block_count > 1 ? 0 : 1);
    if (blocks.places == NULL || blocks.bodies == NULL || pool == NULL) {
        free(blocks.places);
        free(blocks.bodies);
        bp_thread_pool_destroy(&pool);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", p->count);
    }
    bp_parallel_for(pool, find_radii, &blocks, block_count);
    for (uint32_t b = 0; b < block_count; b++) {
        const size_t here = blocks.places[b];
        blocks.places[b] = put;
        put += here;
        bodies += blocks.bodies[b];
    }
    bp_parallel_for(pool, fill_spheres, &blocks, block_count);
    bp_thread_pool_destroy(&pool);
    free(blocks.places);
    free(blocks.bodies);
    count_spheres(job, put, one_color && put > 0 ? 1 : put);
    const size_t without = job->shown_count - put - bodies;
    char number[32];
    if (without > 0)
        bp_style_say(job, "left out: %s without a radius above 0",
                     bp_format_whole(without, number, sizeof number));
    if (put + bodies == 0)
        return bp_fail(err, BP_ERR_SCENE, "found no particle to show, expected one at least");
    return BP_OK;
}
