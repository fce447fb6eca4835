/* boundaries.c: see boundaries.h. */
#include "boundaries.h"

#include "base/status.h"
#include "scene/material.h"
#include "scene/vector.h"
#include "winding.h"

#ifndef BP_HOST
#define BP_HOST
#endif
#include "scene_types.h"

#include <math.h>
#include <stdlib.h>

_Static_assert(BP_BODIES_MAX <= BODIES_MAX && BP_SPHERES_MAX < BODY_SLOT, "places of bodies and of spheres");

#define PI 3.14159265358979323846

/* `radius`: of a ball of the same volume. */
typedef struct Boundary {
    double radius;
    size_t shape;
    uint32_t slot, medium;
} Boundary;

static int compare_boundaries(const void *a_pointer, const void *b_pointer) {
    const Boundary *a = a_pointer, *b = b_pointer;
    if (a->radius != b->radius) return a->radius < b->radius ? -1 : 1;
    return a->shape < b->shape ? -1 : a->shape > b->shape;
}

static double radius_of_capsule(const BpCapsule *capsule) {
    const double length = sqrt(bp_distance2(capsule->ends[0], capsule->ends[1]));
    return length > 0 ? cbrt((capsule->radius + 0.75 * length) * capsule->radius * capsule->radius)
                      : capsule->radius;
}

static bool lets_light_in(const BpScene *scene, size_t shape) {
    return bp_material_is(scene->materials[bp_shape_material(scene, shape)].kind, BP_HAS_INSIDE);
}

/* Spheres and capsules stand in slots of their own; bodies are many triangles. */
static size_t list_boundaries(const BpScene *scene, const BpTree *tree, Boundary *list) {
    const size_t slots = (size_t)tree->leaf_count * tree->width, triangles = scene->triangle_count;
    size_t found = 0;
    for (size_t slot = 0; slot < slots; ++slot) {
        const size_t i = tree->slot_sphere[slot];
        const bool is_sphere = i < scene->sphere_count;
        if (i >= bp_scene_shapes(scene) || (!is_sphere && i < scene->sphere_count + triangles) ||
            !lets_light_in(scene, i))
            continue;
        const BpCapsule *const capsule = bp_shape_capsule(scene, i);
        list[found++] = (Boundary){.radius = capsule != NULL ? radius_of_capsule(capsule)
                                                             : fabs(scene->spheres[i].radius),
                                   .shape = i,
                                   .slot = (uint32_t)slot,
                                   .medium = bp_shape_interior(scene, i)};
    }
    for (size_t b = 0; b < scene->bodies.count; ++b) {
        const BpBody *body = &scene->bodies.list[b];
        const size_t shape = scene->sphere_count + body->first;
        list[found++] = (Boundary){.radius = cbrt(body->volume * (0.75 / PI)),
                                   .shape = shape,
                                   .slot = BODY_SLOT + (uint32_t)b,
                                   .medium = bp_shape_interior(scene, shape)};
    }
    qsort(list, found, sizeof *list, compare_boundaries);
    return found;
}

/* The bits of the bodies that the camera stands in, by the triangles as the device gets them. */
static uint32_t bodies_around(const BpScene *scene, const double origin[3], bool single) {
    int windings[BP_BODIES_MAX] = {0};
    uint32_t bits = 0;
    for (size_t i = 0; i < scene->triangle_count && scene->bodies.count > 0; ++i) {
        const uint32_t body = bp_body_of(scene, i);
        double at[3][3];
        if (body == BP_NO_BODY) continue;
        for (int k = 0; k < 3; ++k)
            for (int a = 0; a < 3; ++a) {
                const double place = scene->triangles[i].vertices[k][a] - origin[a];
                at[k][a] = single ? (double)(float)place : place;
            }
        windings[body] += bp_axis_crossing(at[0], at[1], at[2]);
    }
    for (uint32_t b = 0; b < BP_BODIES_MAX; ++b) bits |= (uint32_t)(windings[b] != 0) << b;
    return bits;
}

static void put_table(const BpScene *scene, const BpTree *tree, const BpBodyTable *table,
                      uint32_t *boundaries) {
    boundaries[0] = BODY_HEAD + BODY_MASKS * table->material_count;
    boundaries[1] = bodies_around(scene, table->origin, tree->single_precision);
    boundaries[2] = (uint32_t)scene->bodies.count;
    for (uint32_t b = 0; b < scene->bodies.count; ++b) {
        uint32_t *masks = boundaries + BODY_HEAD + BODY_MASKS * (table->first_row + b);
        masks[scene->bodies.list[b].inside_out ? 1 : 0] = 1u << b;
    }
}

BpStatus bp_pack_boundaries(const BpScene *scene, const BpTree *tree, const BpBodyTable *table,
                            uint32_t **boundaries, uint32_t *count, BpError *err) {
    size_t most = 0, found = 0;
    const bool media = bp_scene_has_media(scene);
    for (size_t i = 0; i < bp_scene_shapes(scene) && media; ++i) most += lets_light_in(scene, i);
    const size_t first = table->wanted ? BODY_HEAD + BODY_MASKS * (size_t)table->material_count : 0;
    Boundary *list = malloc((most + 1) * sizeof *list);
    *boundaries = calloc(first + (most + 1) * BOUNDARY_UINTS, sizeof **boundaries);
    if (list == NULL || *boundaries == NULL) {
        free(list);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the boundaries of %zu media", most);
    }
    if (most > 0) found = list_boundaries(scene, tree, list);
    if (table->wanted) put_table(scene, tree, table, *boundaries);
    uint32_t *entry = *boundaries + first;
    for (size_t i = 0; i < found; ++i, entry += BOUNDARY_UINTS) {
        entry[0] = list[i].slot;
        entry[1] = list[i].medium;
    }
    entry[0] = NO_SLOT;
    entry[1] = bp_scene_medium(scene);
    *count = (uint32_t)(first + (found + 1) * BOUNDARY_UINTS);
    free(list);
    return BP_OK;
}
