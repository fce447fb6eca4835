/* triangle_rules.c: see triangle_rules.h. */
#include "triangle_rules.h"

#include "base/message_text.h"
#include "material.h"
#include "shape_rules.h"
#include "triangle_area.h"
#include "triangle_edges.h"
#include "triangle_overlap.h"
#include "vector.h"

#include <math.h>
#include <stdlib.h>

#define LEAST_AREA 0x1p-48 /* over the square of the longest side: what rounding could make of none */
#define ON_CAMERA 1.0e-12  /* over the size */

bool bp_triangle_has_area(const BpTriangle *triangle) {
    double area[3];
    const double longest = bp_triangle_area(triangle, area);
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

/* Textures that lie on surfaces lie on triangles by texture coordinates. */
static bool map_fault(const BpScene *scene, size_t index, const BpMaterial *material, BpFault *fault) {
    const float *const at = bp_triangle_coordinates(scene, index);
    for (int k = 0; k < 6 && at != NULL; k++)
        if (!(fabs((double)at[k]) <= BP_UV_MAX))
            return bp_fault_set(fault, BP_FAULT_TRIANGLE, "uvs",
                                "found texture coordinates beyond a million, expected numbers from -1e6 to "
                                "1e6: whole numbers change nothing where textures repeat");
    if (at != NULL || !bp_material_is_mapped(scene, material)) return false;
    return bp_fault_set(
        fault, BP_FAULT_TRIANGLE, "material",
        "found a texture that lies on surfaces, but no texture coordinates, expected u and v at each vertex: "
        "give \"uvs\", or write them to the file of the mesh (vt of OBJ, s and t of PLY, TEXCOORD_0 of "
        "glTF); "
        "or choose a texture that fills space (\"mapping\": \"solid\")");
}

static bool kind_fault(const BpScene *scene, size_t index, BpFault *fault) {
    const BpMaterial *material = &scene->materials[scene->triangles[index].material];
    return bp_interior_fault(scene, scene->sphere_count + index, BP_FAULT_TRIANGLE, "triangle", fault) ||
           map_fault(scene, index, material, fault);
}

/* ---- glass is closed ---- */

static bool is_glass(const BpScene *scene, size_t triangle) {
    return bp_material_is(scene->materials[scene->triangles[triangle].material].kind, BP_HAS_INSIDE);
}

/* Each edge is there as often one way as the other. Meshes have been looked at when they were read. */
static BpStatus find_open_edge(const BpScene *scene, BpFault *fault, BpError *err) {
    BpTriangleEdges edges;
    BP_TRY(bp_triangle_edges(scene, &edges, err));
    for (size_t first = 0, end; first < edges.count && fault->subject == BP_FAULT_NONE; first = end) {
        int sum = 0;
        for (end = first; end < edges.count && bp_same_edge(&edges.list[first], &edges.list[end]); end++)
            sum += edges.list[end].way;
        if (sum == 0) continue;
        const double *a = edges.list[first].ends[0], *b = edges.list[first].ends[1];
        fault->index = edges.list[first].triangle;
        bp_fault_set(fault, BP_FAULT_TRIANGLE, "material",
                     "found a material that lets light in, and an open edge, from (%g, %g, %g) to (%g, %g, "
                     "%g), expected triangles "
                     "of one material and one interior that enclose a body, each edge once one way and once "
                     "the other; close "
                     "it, reverse its vertices, "
                     "or use a box",
                     a[0], a[1], a[2], b[0], b[1], b[2]);
    }
    bp_triangle_edges_clear(&edges);
    return BP_OK;
}

/* ---- nothing lies on glass ---- */

static BpStatus find_overlap(const BpScene *scene, BpFault *fault, BpError *err) {
    bool *const glass = malloc(scene->triangle_count * sizeof *glass);
    BpOverlap overlap = {0};
    if (glass == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory while comparing %zu triangles",
                       scene->triangle_count);
    for (size_t i = 0; i < scene->triangle_count; i++) glass[i] = is_glass(scene, i);
    const BpStatus status = bp_find_overlap(scene->triangles, glass, scene->triangle_count, &overlap, err);
    free(glass);
    if (status != BP_OK || !overlap.found) return status;
    char a[BP_SPHERE_NAME_SIZE], b[BP_SPHERE_NAME_SIZE];
    fault->index = overlap.other;
    bp_fault_set(fault, BP_FAULT_TRIANGLE, "",
                 "found %s and %s in one plane, one on the other, and light passes through one of "
                 "them; expected a gap: move one by a millionth of its size",
                 bp_triangle_name(scene, overlap.one, a), bp_triangle_name(scene, overlap.other, b));
    return BP_OK;
}

/* Whether a point lies on a triangle, by the areas of the three that it makes with the sides. */
static bool holds_point(const BpTriangle *triangle, const double point[3]) {
    double area[3], from[3], size = bp_length(point);
    const double longest = bp_triangle_area(triangle, area), whole = bp_normalize(area);
    bp_way(triangle->vertices[0], point, from);
    if (fabs(bp_dot(from, area)) > ON_CAMERA * (size + longest)) return false;
    for (int k = 0; k < 3; k++) {
        double a[3], b[3], part[3];
        bp_way(point, triangle->vertices[k], a);
        bp_way(point, triangle->vertices[(k + 1) % 3], b);
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
    if (listed_glass > 0) BP_TRY(find_open_edge(scene, fault, err));
    return fault->subject == BP_FAULT_NONE ? find_overlap(scene, fault, err) : BP_OK;
}
