/* triangle_overlap.c: see triangle_overlap.h.
 *
 * Space is halved until a part of it has few triangles, of which every two are compared. A triangle is in
 * each part that its box meets. */
#include "triangle_overlap.h"
#include "triangle_area.h"

#include <stdlib.h>

#define SAME_PLANE 1.0e-12 /* over the size */
#define TOUCHES 1.0e-9     /* over the longest side */
#define FEW 24

/* Whether some line along a side of `a`, whose plane both lie in, has all of `b` outside. */
static bool apart(const BpTriangle *a, const BpTriangle *b, const double normal[3], double slack) {
    for (int k = 0; k < 3; k++) {
        double side[3], across[3], nearest = INFINITY;
        bp_way(a->vertices[k], a->vertices[(k + 1) % 3], side);
        bp_cross(side, normal, across); /* outward */
        bp_normalize(across);
        for (int j = 0; j < 3; j++) {
            double from[3];
            bp_way(a->vertices[k], b->vertices[j], from);
            nearest = fmin(nearest, bp_dot(from, across));
        }
        if (nearest >= -slack) return true;
    }
    return false;
}

static bool overlap(const BpTriangle *a, const BpTriangle *b) {
    double normal[3], other[3], size = 0;
    const double longest = fmax(bp_triangle_area(a, normal), bp_triangle_area(b, other));
    bp_normalize(normal);
    bp_normalize(other);
    for (int k = 0; k < 3; k++) size = fmax(size, fmax(bp_length(a->vertices[k]), bp_length(b->vertices[k])));
    for (int k = 0; k < 3; k++) {
        double from[3];
        bp_way(a->vertices[0], b->vertices[k], from);
        if (fabs(bp_dot(from, normal)) > SAME_PLANE * (size + longest)) return false;
    }
    return !apart(a, b, normal, TOUCHES * longest) && !apart(b, a, other, TOUCHES * longest);
}

typedef struct Box {
    double low[3], high[3];
} Box;

typedef struct Search {
    const BpTriangle *triangles;
    const bool *marks;
    Box *boxes; /* of the triangles */
    BpOverlap *overlap;
} Search;

static Box box_of(const BpTriangle *triangle) {
    Box box;
    for (int a = 0; a < 3; a++) {
        const double x = triangle->vertices[0][a], y = triangle->vertices[1][a], z = triangle->vertices[2][a];
        box.low[a] = fmin(fmin(x, y), z);
        box.high[a] = fmax(fmax(x, y), z);
    }
    return box;
}

static bool boxes_meet(const Box *a, const Box *b) {
    for (int i = 0; i < 3; i++)
        if (a->high[i] < b->low[i] || b->high[i] < a->low[i]) return false;
    return true;
}

static double largest(const Box *box) {
    double size = 0;
    for (int a = 0; a < 3; a++) size = fmax(size, fmax(fabs(box->low[a]), fabs(box->high[a])));
    return size;
}

/* Whether a triangle is certainly off a plane, which overlap() takes ten times as long to find: no side is
 * longer than two sizes, and no size more than 1.8 times the largest coordinate. */
static bool is_off(const double normal[3], const double point[3], const BpTriangle *triangle, double size) {
    for (int k = 0; k < 3; k++) {
        double from[3];
        bp_way(point, triangle->vertices[k], from);
        if (fabs(bp_dot(from, normal)) > SAME_PLANE * 3 * 1.8 * size) return true;
    }
    return false;
}

static void compare_all(const Search *search, const uint32_t *list, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const uint32_t a = list[i];
        const BpTriangle *const triangle = &search->triangles[a];
        double normal[3];
        bp_triangle_area(triangle, normal);
        bp_normalize(normal);
        const double size = largest(&search->boxes[a]);
        for (size_t j = i + 1; j < count; j++) {
            const uint32_t b = list[j];
            if (!search->marks[a] && !search->marks[b]) continue;
            if (!boxes_meet(&search->boxes[a], &search->boxes[b])) continue;
            if (is_off(normal, triangle->vertices[0], &search->triangles[b],
                       fmax(size, largest(&search->boxes[b]))))
                continue;
            if (!overlap(&search->triangles[a], &search->triangles[b])) continue;
            *search->overlap = (BpOverlap){true, a < b ? a : b, a < b ? b : a};
            return;
        }
    }
}

static bool has_mark(const Search *search, const uint32_t *list, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (search->marks[list[i]]) return true;
    return false;
}

/* The axis along which halves of the space have the fewest triangles together, or -1: halving is of no use.
 */
static int axis_to_halve(const Search *search, const uint32_t *list, size_t count, const Box *space) {
    size_t fewest = count + count / 2 + 1;
    int best = -1;
    for (int a = 0; a < 3; a++) {
        const double middle = space->low[a] + (space->high[a] - space->low[a]) / 2;
        size_t below = 0, above = 0;
        for (size_t i = 0; i < count; i++) {
            below += search->boxes[list[i]].low[a] <= middle;
            above += search->boxes[list[i]].high[a] >= middle;
        }
        if (below + above >= fewest || 10 * (below > above ? below : above) > 9 * count) continue;
        fewest = below + above;
        best = a;
    }
    return best;
}

static BpStatus search_space(const Search *search, const uint32_t *list, size_t count, const Box *space,
                             BpError *err) {
    if (search->overlap->found || !has_mark(search, list, count)) return BP_OK;
    const int axis = count > FEW ? axis_to_halve(search, list, count, space) : -1;
    if (axis < 0) {
        compare_all(search, list, count);
        return BP_OK;
    }
    uint32_t *const half = malloc(count * sizeof *half);
    if (half == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory while comparing triangles");
    const double middle = space->low[axis] + (space->high[axis] - space->low[axis]) / 2;
    BpStatus status = BP_OK;
    for (int side = 0; side < 2 && status == BP_OK; side++) {
        Box part = *space;
        size_t inside = 0;
        (side == 0 ? part.high : part.low)[axis] = middle;
        for (size_t i = 0; i < count; i++) {
            const Box *box = &search->boxes[list[i]];
            if (side == 0 ? box->low[axis] <= middle : box->high[axis] >= middle) half[inside++] = list[i];
        }
        status = search_space(search, half, inside, &part, err);
    }
    free(half);
    return status;
}

BpStatus bp_find_overlap(const BpTriangle *triangles, const bool *marks, size_t count, BpOverlap *overlap,
                         BpError *err) {
    uint32_t *const list = malloc((count + 1) * sizeof *list);
    Box *const boxes = malloc((count + 1) * sizeof *boxes);
    const Search search = {triangles, marks, boxes, overlap};
    Box space = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    BpStatus status = list != NULL && boxes != NULL
                          ? BP_OK
                          : bp_fail(err, BP_ERR_MEMORY, "out of memory while comparing %zu triangles", count);
    overlap->found = false;
    for (size_t i = 0; i < count && status == BP_OK; i++) {
        list[i] = (uint32_t)i;
        boxes[i] = box_of(&triangles[i]);
        for (int a = 0; a < 3; a++) {
            space.low[a] = fmin(space.low[a], boxes[i].low[a]);
            space.high[a] = fmax(space.high[a], boxes[i].high[a]);
        }
    }
    if (status == BP_OK) status = search_space(&search, list, count, &space, err);
    free(boxes);
    free(list);
    return status;
}
