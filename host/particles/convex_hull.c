/* convex_hull.c: see convex_hull.h.
 *
 * Point by point: one that lies above some faces takes their place, joined to the edges around them. Faces in
 * whose plane it lies stay, so all faces of one plane are treated alike, and what is above is one piece whose
 * edge is one ring. */
#include "convex_hull.h"

#include "base/orient.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct Hull {
    const double (*points)[3];
    size_t point_count;
    uint32_t (*faces)[3];
    size_t face_count;
    bool *edges; /* of the faces above a point: by the numbers of both ends */
} Hull;

static bool is_above(const Hull *hull, const uint32_t face[3], uint32_t point) {
    return orient3(hull->points[face[0]], hull->points[face[1]], hull->points[face[2]], hull->points[point]) >
           0;
}

/* Whether a point lies off the line through two others, seen along each of the axes. */
static bool is_off(const Hull *hull, uint32_t a, uint32_t b, uint32_t c) {
    for (int axis = 0; axis < 3; axis++) {
        const int x = (axis + 1) % 3, y = (axis + 2) % 3;
        const double *const p = hull->points[a], *const q = hull->points[b], *const r = hull->points[c];
        if (orient((const double[2]){p[x], p[y]}, (const double[2]){q[x], q[y]},
                   (const double[2]){r[x], r[y]}) != 0)
            return true;
    }
    return false;
}

static bool is_same(const double a[3], const double b[3]) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Four points that are not in one plane: the first, and for each further one the first that will do. */
static bool find_first(const Hull *hull, uint32_t corners[4]) {
    const uint32_t count = (uint32_t)hull->point_count;
    uint32_t at = 1;
    corners[0] = 0;
    while (at < count && is_same(hull->points[0], hull->points[at])) at++;
    corners[1] = at++;
    while (at < count && !is_off(hull, 0, corners[1], at)) at++;
    corners[2] = at++;
    while (at < count && orient3(hull->points[0], hull->points[corners[1]], hull->points[corners[2]],
                                 hull->points[at]) == 0)
        at++;
    corners[3] = at;
    return at < count;
}

static void put_face(Hull *hull, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *const face = hull->faces[hull->face_count++];
    face[0] = a;
    face[1] = b;
    face[2] = c;
}

static void mark_edges(Hull *hull, const uint32_t (*faces)[3], size_t count, bool mark) {
    for (size_t f = 0; f < count; f++)
        for (int k = 0; k < 3; k++)
            hull->edges[(size_t)faces[f][k] * hull->point_count + faces[f][(k + 1) % 3]] = mark;
}

/* `above`: room for all faces. */
static void add_point(Hull *hull, uint32_t point, uint32_t (*above)[3]) {
    size_t kept = 0, count = 0;
    for (size_t f = 0; f < hull->face_count; f++) {
        if (is_above(hull, hull->faces[f], point))
            memcpy(above[count++], hull->faces[f], sizeof *above);
        else
            memmove(hull->faces[kept++], hull->faces[f], sizeof *above);
    }
    hull->face_count = kept;
    mark_edges(hull, (const uint32_t(*)[3])above, count, true);
    for (size_t f = 0; f < count; f++)
        for (int k = 0; k < 3; k++) {
            const uint32_t a = above[f][k], b = above[f][(k + 1) % 3];
            if (!hull->edges[(size_t)b * hull->point_count + a]) put_face(hull, a, b, point);
        }
    mark_edges(hull, (const uint32_t(*)[3])above, count, false);
}

BpStatus convex_hull(const double (*points)[3], size_t point_count, uint32_t (**faces)[3], size_t *count,
                     BpError *err) {
    Hull hull = {.points = points, .point_count = point_count};
    uint32_t first[4], (*above)[3] = NULL;
    *faces = NULL;
    *count = 0;
    if (!find_first(&hull, first)) return BP_OK;
    const size_t most = 2 * point_count; /* of n corners 2 n - 4 faces */
    hull.faces = calloc(most, sizeof *hull.faces);
    hull.edges = calloc(point_count * point_count, sizeof *hull.edges);
    above = calloc(most, sizeof *above);
    if (hull.faces == NULL || hull.edges == NULL || above == NULL) {
        free(hull.faces);
        free(hull.edges);
        free(above);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the hull of %zu points", point_count);
    }
    const bool up = is_above(&hull, (const uint32_t[3]){first[0], first[1], first[2]}, first[3]);
    const uint32_t a = first[0], b = first[up ? 2 : 1], c = first[up ? 1 : 2], top = first[3];
    put_face(&hull, a, b, c);
    put_face(&hull, b, a, top);
    put_face(&hull, c, b, top);
    put_face(&hull, a, c, top);
    for (uint32_t i = 0; i < (uint32_t)point_count; i++) add_point(&hull, i, above);
    free(hull.edges);
    free(above);
    *faces = hull.faces;
    *count = hull.face_count;
    return BP_OK;
}
