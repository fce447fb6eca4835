/* geodesic.c: see geodesic.h.
 *
 * An icosahedron whose edges are cut into n parts and whose faces into n^2 triangles, with all corners moved
 * to the sphere (class I of M. Wenninger, "Spherical Models", 1979). Corners on edges are made once, so that
 * faces share them. */
#include "geodesic.h"

#include "scene/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { CORNERS = 12, EDGES = 30, FACES = 20 };

/* Five faces around the first corner, five around the last, and ten between. */
static const uint32_t icosahedron[FACES][3] = {{0, 1, 2},  {0, 2, 3},  {0, 3, 4},  {0, 4, 5},   {0, 5, 1},
                                               {1, 6, 2},  {2, 6, 7},  {2, 7, 3},  {3, 7, 8},   {3, 8, 4},
                                               {4, 8, 9},  {4, 9, 5},  {5, 9, 10}, {5, 10, 1},  {1, 10, 6},
                                               {11, 7, 6}, {11, 8, 7}, {11, 9, 8}, {11, 10, 9}, {11, 6, 10}};

typedef struct Maker {
    Geodesic *made;
    uint32_t parts;
    double corners[CORNERS][3];
    uint32_t edges[EDGES][2]; /* the lower corner first */
    uint32_t edge_count;
} Maker;

static void set_corners(double corners[CORNERS][3]) {
    const double height = 1 / sqrt(5), width = 2 / sqrt(5);
    for (int i = 0; i < 5; i++) {
        const double upper[3] = {width * cos(2 * PI * i / 5), width * sin(2 * PI * i / 5), height};
        const double lower[3] = {width * cos(2 * PI * (i + 0.5) / 5), width * sin(2 * PI * (i + 0.5) / 5),
                                 -height};
        memcpy(corners[1 + i], upper, sizeof upper);
        memcpy(corners[6 + i], lower, sizeof lower);
    }
    corners[0][2] = 1;
    corners[11][2] = -1;
}

static uint32_t edge_between(Maker *maker, uint32_t low, uint32_t high) {
    uint32_t e = 0;
    while (e < maker->edge_count && (maker->edges[e][0] != low || maker->edges[e][1] != high)) e++;
    if (e < maker->edge_count) return e;
    maker->edges[e][0] = low;
    maker->edges[e][1] = high;
    return maker->edge_count++;
}

/* The number of the vertex of a face that is `at` parts of the way from corner a to corner b. */
static uint32_t on_edge(Maker *maker, uint32_t a, uint32_t b, uint32_t at) {
    const uint32_t parts = maker->parts;
    if (at == 0) return a;
    if (at == parts) return b;
    const uint32_t edge = a < b ? edge_between(maker, a, b) : edge_between(maker, b, a);
    return CORNERS + edge * (parts - 1) + (a < b ? at : parts - at) - 1;
}

/* The number of the vertex of face f with the weights parts - i - j, i and j of its corners, by n. */
static uint32_t vertex_number(Maker *maker, uint32_t f, uint32_t i, uint32_t j) {
    const uint32_t *const face = icosahedron[f], parts = maker->parts, k = parts - i - j;
    if (j == 0) return on_edge(maker, face[0], face[1], i);
    if (i == 0) return on_edge(maker, face[0], face[2], j);
    if (k == 0) return on_edge(maker, face[1], face[2], j);
    /* Rows of parts - 2, parts - 3, ..., 1 vertices inside a face, for j = 1, 2, ... */
    const uint32_t inside = (parts - 1) * (parts - 2) / 2,
                   before = (j - 1) * (parts - 2) - (j - 1) * (j - 2) / 2;
    return CORNERS + EDGES * (parts - 1) + f * inside + before + i - 1;
}

static void put_vertex(Maker *maker, uint32_t f, uint32_t i, uint32_t j, uint32_t number) {
    const uint32_t *const face = icosahedron[f], k = maker->parts - i - j;
    double *const vertex = maker->made->vertices[number];
    for (int a = 0; a < 3; a++)
        vertex[a] =
            k * maker->corners[face[0]][a] + i * maker->corners[face[1]][a] + j * maker->corners[face[2]][a];
    bp_normalize(vertex);
}

static void put_triangle(Maker *maker, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *const triangle = maker->made->triangles[maker->made->triangle_count++];
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
}

static void fill_face(Maker *maker, uint32_t f) {
    const uint32_t parts = maker->parts;
    for (uint32_t j = 0; j <= parts; j++)
        for (uint32_t i = 0; i + j <= parts; i++) {
            const uint32_t here = vertex_number(maker, f, i, j);
            put_vertex(maker, f, i, j, here);
            if (i + j == parts) continue;
            const uint32_t right = vertex_number(maker, f, i + 1, j), up = vertex_number(maker, f, i, j + 1);
            put_triangle(maker, here, right, up);
            if (i + j + 2 <= parts) put_triangle(maker, right, vertex_number(maker, f, i + 1, j + 1), up);
        }
}

/* Gives it the sphere's volume, and finds the error. */
static void scale(Geodesic *made) {
    double volume = 0, nearest = 1;
    for (size_t t = 0; t < made->triangle_count; t++) {
        const double *const a = made->vertices[made->triangles[t][0]],
                            *const b = made->vertices[made->triangles[t][1]],
                            *const c = made->vertices[made->triangles[t][2]];
        double u[3], v[3], normal[3];
        bp_way(a, b, u);
        bp_way(a, c, v);
        bp_cross(u, v, normal);
        volume += bp_dot(a, normal) / 6;
        nearest = fmin(nearest, bp_dot(a, normal) / bp_length(normal));
    }
    const double factor = cbrt(4 * PI / 3 / volume);
    for (size_t v = 0; v < made->vertex_count; v++)
        for (int a = 0; a < 3; a++) made->vertices[v][a] *= factor;
    made->error = fmax(factor - 1, 1 - factor * nearest);
}

BpStatus geodesic_create(unsigned parts, Geodesic *geodesic, BpError *err) {
    Maker maker = {.made = geodesic, .parts = parts};
    *geodesic = (Geodesic){.vertex_count = GEODESIC_VERTICES(parts)};
    geodesic->vertices = calloc(geodesic->vertex_count, sizeof *geodesic->vertices);
    geodesic->triangles = calloc(GEODESIC_TRIANGLES(parts), sizeof *geodesic->triangles);
    if (geodesic->vertices == NULL || geodesic->triangles == NULL) {
        geodesic_clear(geodesic);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a mesh of a sphere");
    }
    set_corners(maker.corners);
    for (uint32_t f = 0; f < FACES; f++) fill_face(&maker, f);
    scale(geodesic);
    return BP_OK;
}

void geodesic_clear(Geodesic *geodesic) {
    free(geodesic->vertices);
    free(geodesic->triangles);
    *geodesic = (Geodesic){0};
}
