/* triangle_rules.c: see triangle_rules.h. */
#include "triangle_rules.h"

#include "base/message_text.h"
#include "material.h"
#include "vector.h"

#include <math.h>
#include <stdlib.h>

#define LEAST_AREA 0x1p-48 /* over the square of the longest side: what rounding could make of none */
#define SAME_PLANE 1.0e-12 /* over the size */
#define TOUCHES 1.0e-9     /* over the longest side: sides and corners that meet are no overlap */
#define ON_CAMERA 1.0e-12  /* over the size */

static void way(const double from[3], const double to[3], double v[3]) {
    for (int a = 0; a < 3; a++) v[a] = to[a] - from[a];
}

/* Twice the area, along the outward normal; returns the longest side. */
static double area_of(const BpTriangle *triangle, double area[3]) {
    double b[3], c[3], d[3];
    way(triangle->vertices[0], triangle->vertices[1], b);
    way(triangle->vertices[0], triangle->vertices[2], c);
    way(triangle->vertices[1], triangle->vertices[2], d);
    bp_cross(b, c, area);
    return fmax(fmax(bp_length(b), bp_length(c)), bp_length(d));
}

bool bp_triangle_has_area(const BpTriangle *triangle) {
    double area[3];
    const double longest = area_of(triangle, area);
    return bp_length(area) > LEAST_AREA * longest * longest && longest >= BP_TRIANGLE_SIDE_MIN;
}

static bool place_fault(const BpTriangle *triangle, BpFault *fault) {
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++)
            if (!(fabs(triangle->vertices[k][a]) <= BP_VERTEX_MAX)) {
                char text[BP_NUMBER_TEXT_SIZE];
                return bp_fault_set(fault, BP_FAULT_TRIANGLE, "vertices",
                                    "found %s, expected coordinates of vertices from -1e9 to 1e9; choose a "
                                    "larger unit of length",
                                    bp_number_text(triangle->vertices[k][a], text));
            }
    if (bp_triangle_has_area(triangle)) return false;
    return bp_fault_set(
        fault, BP_FAULT_TRIANGLE, "vertices",
        "found a triangle without an area, expected three points that are not in one line, at "
        "least 1e-9 apart");
}

/* A texture that lies on surfaces by longitude and latitude. */
static bool has_map(const BpScene *scene, const BpMaterial *material) {
    for (int m = 0; m < BP_MEMBER_COUNT; m++) {
        const uint32_t number = material->texture[m];
        if (number != 0 && scene->textures[number - 1].mapping == BP_MAPPING_SURFACE) return true;
    }
    return false;
}

static bool kind_fault(const BpScene *scene, size_t index, BpFault *fault) {
    const BpMaterial *material = &scene->materials[scene->triangles[index].material];
    if (material->kind == BP_MATERIAL_INTERFACE)
        return bp_fault_set(fault, BP_FAULT_TRIANGLE, "material",
                            "found the type \"interface\", expected another: media inside triangles are not "
                            "rendered yet; use a sphere as their boundary");
    if (bp_material_is(material->kind, BP_HAS_INSIDE) && scene->medium_count > 0)
        return bp_fault_set(fault, BP_FAULT_TRIANGLE, "material",
                            "found glass of triangles in a scene with media, expected one or the other: use "
                            "spheres of glass, or remove \"media\"");
    if (has_map(scene, material))
        return bp_fault_set(
            fault, BP_FAULT_TRIANGLE, "material",
            "found a texture that is laid around spheres, expected one that fills space: triangles have no "
            "longitude; change its mapping to \"solid\", or the material");
    return false;
}

/* ---- glass is closed ---- */

typedef struct Edge {
    double ends[2][3]; /* in order */
    int way;           /* 1: from the first to the second, or -1 */
    uint32_t triangle, material;
} Edge;

static int compare_points(const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++)
        if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
    return 0;
}

static int compare_edges(const void *a_pointer, const void *b_pointer) {
    const Edge *a = a_pointer, *b = b_pointer;
    if (a->material != b->material) return a->material < b->material ? -1 : 1;
    for (int i = 0; i < 2; i++) {
        const int order = compare_points(a->ends[i], b->ends[i]);
        if (order != 0) return order;
    }
    return a->triangle < b->triangle ? -1 : a->triangle > b->triangle;
}

static bool is_glass(const BpScene *scene, size_t triangle) {
    return bp_material_is(scene->materials[scene->triangles[triangle].material].kind, BP_HAS_INSIDE);
}

/* Each edge is there as often one way as the other. Meshes have been looked at when they were read. */
static BpStatus find_open_edge(const BpScene *scene, size_t glass, BpFault *fault, BpError *err) {
    Edge *edges = malloc(3 * glass * sizeof *edges);
    size_t count = 0;
    if (edges == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the edges of %zu triangles", glass);
    for (size_t i = 0; i < bp_scene_listed_triangles(scene); i++) {
        if (!is_glass(scene, i)) continue;
        for (int k = 0; k < 3; k++) {
            const double *from = scene->triangles[i].vertices[k],
                         *to = scene->triangles[i].vertices[(k + 1) % 3];
            const bool forward = compare_points(from, to) < 0;
            Edge *edge = &edges[count++];
            edge->way = forward ? 1 : -1;
            memcpy(edge->ends[0], forward ? from : to, sizeof edge->ends[0]);
            memcpy(edge->ends[1], forward ? to : from, sizeof edge->ends[1]);
            edge->triangle = (uint32_t)i;
            edge->material = scene->triangles[i].material;
        }
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t first = 0, end; first < count && fault->subject == BP_FAULT_NONE; first = end) {
        int sum = 0;
        for (end = first; end < count && edges[end].material == edges[first].material &&
                          compare_points(edges[end].ends[0], edges[first].ends[0]) == 0 &&
                          compare_points(edges[end].ends[1], edges[first].ends[1]) == 0;
             end++)
            sum += edges[end].way;
        if (sum == 0) continue;
        const double *a = edges[first].ends[0], *b = edges[first].ends[1];
        fault->index = edges[first].triangle;
        bp_fault_set(fault, BP_FAULT_TRIANGLE, "material",
                     "found glass with an open edge, from (%g, %g, %g) to (%g, %g, %g), expected triangles "
                     "of one material that enclose a body, each edge once one way and once the other; close "
                     "it, reverse its vertices, "
                     "or use a box",
                     a[0], a[1], a[2], b[0], b[1], b[2]);
    }
    free(edges);
    return BP_OK;
}

/* ---- nothing lies on glass ---- */

typedef struct Span {
    double low, high; /* along x */
    uint32_t triangle;
} Span;

static int compare_spans(const void *a_pointer, const void *b_pointer) {
    const Span *a = a_pointer, *b = b_pointer;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    return a->triangle < b->triangle ? -1 : a->triangle > b->triangle;
}

/* Whether some line along a side of `a`, whose plane both lie in, has all of `b` outside. */
static bool apart(const BpTriangle *a, const BpTriangle *b, const double normal[3], double slack) {
    for (int k = 0; k < 3; k++) {
        double side[3], across[3], nearest = INFINITY;
        way(a->vertices[k], a->vertices[(k + 1) % 3], side);
        bp_cross(side, normal, across); /* outward */
        bp_normalize(across);
        for (int j = 0; j < 3; j++) {
            double from[3];
            way(a->vertices[k], b->vertices[j], from);
            nearest = fmin(nearest, bp_dot(from, across));
        }
        if (nearest >= -slack) return true;
    }
    return false;
}

static bool overlap(const BpTriangle *a, const BpTriangle *b) {
    double normal[3], other[3], size = 0;
    for (int axis = 1; axis < 3; axis++) {
        const double low = fmin(fmin(a->vertices[0][axis], a->vertices[1][axis]), a->vertices[2][axis]);
        const double high = fmax(fmax(a->vertices[0][axis], a->vertices[1][axis]), a->vertices[2][axis]);
        int below = 0, above = 0;
        for (int k = 0; k < 3; k++) {
            below += b->vertices[k][axis] < low;
            above += b->vertices[k][axis] > high;
        }
        if (below == 3 || above == 3) return false;
    }
    const double longest = fmax(area_of(a, normal), area_of(b, other));
    bp_normalize(normal);
    bp_normalize(other);
    for (int k = 0; k < 3; k++) size = fmax(size, fmax(bp_length(a->vertices[k]), bp_length(b->vertices[k])));
    for (int k = 0; k < 3; k++) {
        double from[3];
        way(a->vertices[0], b->vertices[k], from);
        if (fabs(bp_dot(from, normal)) > SAME_PLANE * (size + longest)) return false;
    }
    return !apart(a, b, normal, TOUCHES * longest) && !apart(b, a, other, TOUCHES * longest);
}

static BpStatus find_overlap(const BpScene *scene, BpFault *fault, BpError *err) {
    const size_t count = scene->triangle_count;
    Span *spans = malloc(count * sizeof *spans);
    if (spans == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory while comparing %zu triangles", count);
    for (size_t i = 0; i < count; i++) {
        const double(*v)[3] = (const double(*)[3])scene->triangles[i].vertices;
        spans[i] =
            (Span){fmin(fmin(v[0][0], v[1][0]), v[2][0]), fmax(fmax(v[0][0], v[1][0]), v[2][0]), (uint32_t)i};
    }
    qsort(spans, count, sizeof *spans, compare_spans);
    for (size_t i = 0; i < count && fault->subject == BP_FAULT_NONE; i++)
        for (size_t j = i + 1; j < count && spans[j].low <= spans[i].high; j++) {
            const size_t one = spans[i].triangle, two = spans[j].triangle;
            if (!is_glass(scene, one) && !is_glass(scene, two)) continue;
            if (!overlap(&scene->triangles[one], &scene->triangles[two])) continue;
            char a[BP_SPHERE_NAME_SIZE], b[BP_SPHERE_NAME_SIZE];
            const size_t later = one > two ? one : two;
            fault->index = later;
            bp_fault_set(fault, BP_FAULT_TRIANGLE, "",
                         "found %s and %s in one plane, one on the other, and light passes through one of "
                         "them; expected a gap: move one by a millionth of its size",
                         bp_triangle_name(scene, one + two - later, a), bp_triangle_name(scene, later, b));
            break;
        }
    free(spans);
    return BP_OK;
}

/* Whether a point lies on a triangle, by the areas of the three that it makes with the sides. */
static bool holds_point(const BpTriangle *triangle, const double point[3]) {
    double area[3], from[3], size = bp_length(point);
    const double longest = area_of(triangle, area), whole = bp_normalize(area);
    way(triangle->vertices[0], point, from);
    if (fabs(bp_dot(from, area)) > ON_CAMERA * (size + longest)) return false;
    for (int k = 0; k < 3; k++) {
        double a[3], b[3], part[3];
        way(point, triangle->vertices[k], a);
        way(point, triangle->vertices[(k + 1) % 3], b);
        bp_cross(a, b, part);
        if (bp_dot(part, area) < -ON_CAMERA * whole) return false;
    }
    return true;
}

BpStatus bp_scene_find_triangle_fault(const BpScene *scene, BpFault *fault, BpError *err) {
    const BpCamera *camera = &scene->camera;
    const bool pinhole = camera->lens_radius == 0 && camera->projection == BP_PERSPECTIVE;
    const size_t listed = bp_scene_listed_triangles(scene);
    size_t glass = 0, listed_glass = 0;
    for (size_t i = 0; i < scene->triangle_count; i++) {
        fault->index = i;
        if (scene->triangles[i].material >= scene->material_count) {
            bp_fault_set(fault, BP_FAULT_TRIANGLE, "material",
                         "found number %u, expected one of %zu materials",
                         (unsigned)scene->triangles[i].material, scene->material_count);
            return BP_OK;
        }
        if (place_fault(&scene->triangles[i], fault) || kind_fault(scene, i, fault)) return BP_OK;
        glass += is_glass(scene, i);
        listed_glass += is_glass(scene, i) && i < listed;
        if (pinhole && holds_point(&scene->triangles[i], camera->lookfrom)) {
            char name[BP_SPHERE_NAME_SIZE];
            bp_fault_set(fault, BP_FAULT_TRIANGLE, "",
                         "found lookfrom of the camera on %s, expected it beside: move one of them slightly",
                         bp_triangle_name(scene, i, name));
            return BP_OK;
        }
    }
    if (glass == 0) return BP_OK;
    if (listed_glass > 0) BP_TRY(find_open_edge(scene, listed_glass, fault, err));
    return fault->subject == BP_FAULT_NONE ? find_overlap(scene, fault, err) : BP_OK;
}
