/* bodies.c: see bodies.h. */
#include "bodies.h"

#include "material.h"
#include "scene.h"
#include "triangle_edges.h"
#include "vector.h"

#include <math.h>
#include <stdlib.h>

static bool lets_light_in(const BpScene *scene, size_t triangle) {
    return bp_material_is(scene->materials[scene->triangles[triangle].material].kind, BP_HAS_INSIDE);
}

static uint32_t interior_of(const BpScene *scene, size_t triangle) {
    return bp_shape_named_interior(scene, scene->sphere_count + triangle);
}

/* A body that begins with a triangle. */
static BpStatus add_body(const BpScene *scene, size_t triangle, BpBodies *bodies, BpError *err) {
    if ((bodies->count & (bodies->count - 1)) == 0) { /* 0, or a power of two: no room is left */
        const size_t room = bodies->count == 0 ? 1 : 2 * bodies->count;
        BpBody *const list = realloc(bodies->list, room * sizeof *list);
        if (list == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu bodies", room);
        bodies->list = list;
    }
    bodies->of_triangle[triangle] = (uint32_t)bodies->count;
    bodies->list[bodies->count++] = (BpBody){.first = triangle,
                                             .material = scene->triangles[triangle].material,
                                             .interior = interior_of(scene, triangle)};
    return BP_OK;
}

/* ---- triangles of the scene itself ---- */

/* The first triangle of those that hang together with this one, by what is known so far. */
static uint32_t first_of(uint32_t *before, uint32_t triangle) {
    while (before[triangle] != triangle) {
        before[triangle] = before[before[triangle]];
        triangle = before[triangle];
    }
    return triangle;
}

static BpStatus find_listed(const BpScene *scene, BpBodies *bodies, BpError *err) {
    const size_t listed = bp_scene_listed_triangles(scene);
    uint32_t *const before = malloc((listed + 1) * sizeof *before);
    BpTriangleEdges edges = {0};
    if (before == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu triangles", listed);
    BpStatus status = bp_triangle_edges(scene, &edges, err);
    for (size_t i = 0; i < listed; i++) before[i] = (uint32_t)i;
    for (size_t e = 1; e < edges.count; e++) {
        if (!bp_same_edge(&edges.list[e - 1], &edges.list[e])) continue;
        const uint32_t a = first_of(before, edges.list[e - 1].triangle),
                       b = first_of(before, edges.list[e].triangle);
        before[a > b ? a : b] = a > b ? b : a;
    }
    bp_triangle_edges_clear(&edges);
    for (size_t i = 0; i < listed && status == BP_OK; i++) {
        if (!lets_light_in(scene, i)) continue;
        const uint32_t first = first_of(before, (uint32_t)i);
        if (first == i)
            status = add_body(scene, i, bodies, err);
        else
            bodies->of_triangle[i] = bodies->of_triangle[first];
    }
    free(before);
    return status;
}

/* ---- meshes ---- */

static BpStatus find_of_mesh(const BpScene *scene, size_t first, size_t end, BpBodies *bodies, BpError *err) {
    const size_t others = bodies->count;
    for (size_t i = first; i < end; i++) {
        size_t body = others;
        if (!lets_light_in(scene, i)) continue;
        while (body < bodies->count && bodies->list[body].material != scene->triangles[i].material) body++;
        if (body == bodies->count)
            BP_TRY(add_body(scene, i, bodies, err));
        else
            bodies->of_triangle[i] = (uint32_t)body;
    }
    return BP_OK;
}

/* ---- volumes ---- */

/* By the tetrahedra that the triangles make with a vertex of the first. */
static void measure(const BpScene *scene, BpBodies *bodies) {
    for (size_t i = 0; i < scene->triangle_count; i++) {
        if (bodies->of_triangle[i] == BP_NO_BODY) continue;
        BpBody *const body = &bodies->list[bodies->of_triangle[i]];
        double ways[3][3], across[3];
        for (int k = 0; k < 3; k++)
            bp_way(scene->triangles[body->first].vertices[0], scene->triangles[i].vertices[k], ways[k]);
        bp_cross(ways[1], ways[2], across);
        body->volume += bp_dot(ways[0], across) / 6;
    }
    for (size_t b = 0; b < bodies->count; b++) {
        bodies->list[b].inside_out = bodies->list[b].volume < 0;
        bodies->list[b].volume = fabs(bodies->list[b].volume);
    }
}

BpStatus bp_bodies_find(const BpScene *scene, BpBodies *bodies, BpError *err) {
    size_t first = 0;
    *bodies = (BpBodies){0};
    while (first < scene->triangle_count && !lets_light_in(scene, first)) first++;
    if (first == scene->triangle_count || !bp_scene_has_media(scene)) return BP_OK;
    bodies->of_triangle = malloc(scene->triangle_count * sizeof *bodies->of_triangle);
    if (bodies->of_triangle == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu triangles", scene->triangle_count);
    for (size_t i = 0; i < scene->triangle_count; i++) bodies->of_triangle[i] = BP_NO_BODY;
    BpStatus status = find_listed(scene, bodies, err);
    for (size_t m = 0; m < scene->mesh_file_count && status == BP_OK; m++) {
        const bool last = m + 1 == scene->mesh_file_count;
        status = find_of_mesh(scene, scene->mesh_files[m].first,
                              last ? scene->triangle_count : scene->mesh_files[m + 1].first, bodies, err);
    }
    if (status == BP_OK)
        measure(scene, bodies);
    else
        bp_bodies_clear(bodies);
    return status;
}

uint32_t bp_body_of(const BpScene *scene, size_t triangle) {
    return scene->bodies.of_triangle != NULL ? scene->bodies.of_triangle[triangle] : BP_NO_BODY;
}
