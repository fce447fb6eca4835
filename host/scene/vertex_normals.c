/* vertex_normals.c: see vertex_normals.h. */
#include "vertex_normals.h"

#include "vector.h"

#include <math.h>
#include <stdlib.h>

bool bp_unit_normal(const double direction[3], float normal[3]) {
    const double length = hypot(hypot(direction[0], direction[1]), direction[2]);
    const bool has = length > 0 && isfinite(length);
    const double divisor = has && fabs(length - 1) > 1e-6 ? length : 1;
    for (int a = 0; a < 3; a++) normal[a] = has ? (float)(direction[a] / divisor) : 0;
    return has;
}

/* Adds the face's normal to the sums of its vertices, by its angles. */
static void add_face(const double (*positions)[3], const uint32_t face[3], double (*sums)[3]) {
    double sides[3][3], normal[3];
    for (int k = 0; k < 3; k++) {
        const double *const from = positions[face[k]], *const to = positions[face[(k + 1) % 3]];
        for (int a = 0; a < 3; a++) sides[k][a] = to[a] - from[a];
    }
    bp_cross(sides[0], sides[1], normal);
    const double length = hypot(hypot(normal[0], normal[1]), normal[2]);
    if (!(length > 0)) return;
    for (int k = 0; k < 3; k++) {
        const double *const out = sides[k], *const in = sides[(k + 2) % 3];
        const double angle = atan2(length, -bp_dot(out, in)); /* all three sides span the same area */
        for (int a = 0; a < 3; a++) sums[face[k]][a] += angle * (normal[a] / length);
    }
}

BpStatus bp_vertex_normals(const double (*positions)[3], size_t vertex_count, const uint32_t (*faces)[3],
                           size_t face_count, float (*normals)[3][3], BpError *err) {
    double(*sums)[3] = calloc(vertex_count + 1, sizeof *sums);
    if (sums == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the normals of %zu vertices", vertex_count);
    for (size_t f = 0; f < face_count; f++) add_face(positions, faces[f], sums);
    for (size_t f = 0; f < face_count; f++)
        for (int k = 0; k < 3; k++) bp_unit_normal(sums[faces[f][k]], normals[f][k]);
    free(sums);
    return BP_OK;
}
