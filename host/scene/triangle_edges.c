/* triangle_edges.c: see triangle_edges.h. */
#include "triangle_edges.h"

#include "base/status.h"
#include "material.h"
#include "shape_rules.h"

#include <stdlib.h>
#include <string.h>

static int compare_whole(uint32_t a, uint32_t b) {
    return a < b ? -1 : a > b;
}

static int compare_places(const BpTriangleEdge *a, const BpTriangleEdge *b) {
    int order = compare_whole(a->material, b->material);
    if (order == 0) order = compare_whole(a->interior, b->interior);
    for (int i = 0; i < 2 && order == 0; i++) order = bp_compare_points(a->ends[i], b->ends[i]);
    return order;
}

bool bp_same_edge(const BpTriangleEdge *a, const BpTriangleEdge *b) {
    return compare_places(a, b) == 0;
}

static int compare_edges(const void *a_pointer, const void *b_pointer) {
    const BpTriangleEdge *a = a_pointer, *b = b_pointer;
    const int order = compare_places(a, b);
    return order != 0 ? order : compare_whole(a->triangle, b->triangle);
}

static bool lets_light_in(const BpScene *scene, size_t triangle) {
    return bp_material_is(scene->materials[scene->triangles[triangle].material].kind, BP_HAS_INSIDE);
}

static BpTriangleEdge edge_of(const BpScene *scene, size_t triangle, int side) {
    const BpTriangle *const owner = &scene->triangles[triangle];
    const double *from = owner->vertices[side], *to = owner->vertices[(side + 1) % 3];
    const bool forward = bp_compare_points(from, to) < 0;
    BpTriangleEdge edge = {.way = forward ? 1 : -1,
                           .triangle = (uint32_t)triangle,
                           .material = owner->material,
                           .interior = bp_shape_named_interior(scene, scene->sphere_count + triangle)};
    memcpy(edge.ends[0], forward ? from : to, sizeof edge.ends[0]);
    memcpy(edge.ends[1], forward ? to : from, sizeof edge.ends[1]);
    return edge;
}

BpStatus bp_triangle_edges(const BpScene *scene, BpTriangleEdges *edges, BpError *err) {
    const size_t listed = bp_scene_listed_triangles(scene);
    size_t triangles = 0;
    *edges = (BpTriangleEdges){0};
    for (size_t i = 0; i < listed; i++) triangles += lets_light_in(scene, i);
    if (triangles == 0) return BP_OK;
    edges->list = malloc(3 * triangles * sizeof *edges->list);
    if (edges->list == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the edges of %zu triangles", triangles);
    for (size_t i = 0; i < listed; i++)
        for (int side = 0; side < 3 && lets_light_in(scene, i); side++)
            edges->list[edges->count++] = edge_of(scene, i, side);
    qsort(edges->list, edges->count, sizeof *edges->list, compare_edges);
    return BP_OK;
}

void bp_triangle_edges_clear(BpTriangleEdges *edges) {
    free(edges->list);
    *edges = (BpTriangleEdges){0};
}
