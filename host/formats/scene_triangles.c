/* scene_triangles.c: see scene_triangles.h. */
#include "scene_triangles.h"

#include "scene/placement.h"
#include "scene/vertex_normals.h"
#include "scene_medium.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* `count` points. */
static BpStatus parse_points(const BpNode *node, size_t count, const char *expected, double (*points)[3],
                             BpError *err) {
    if (!json_is_array(node->value) || json_array_size(node->value) != count)
        return bp_node_wrong(node, expected, err);
    for (size_t i = 0; i < count; i++) {
        const BpNode point = bp_node_element(node, i);
        BP_TRY(bp_node_vector(&point, points[i], err));
    }
    return BP_OK;
}

static BpStatus parse_material(const BpNode *node, const BpMaterialIndex *index, uint32_t *material,
                               BpError *err) {
    BP_TRY(bp_node_require(node, "material", "a name from \"materials\"", err));
    const BpNode name = bp_node_member(node, "material");
    return bp_parse_material_name(&name, index, material, err);
}

static void put(BpTriangle *triangle, const double *a, const double *b, const double *c, uint32_t material) {
    memcpy(triangle->vertices[0], a, sizeof triangle->vertices[0]);
    memcpy(triangle->vertices[1], b, sizeof triangle->vertices[1]);
    memcpy(triangle->vertices[2], c, sizeof triangle->vertices[2]);
    triangle->material = material;
    triangle->albedo = BP_NO_ALBEDO;
}

static BpStatus parse_triangle(const BpNode *node, const BpMaterialIndex *index, BpTriangle *triangle,
                               BpError *err) {
    static const char *const names[] = {"vertices", "normals", "uvs", "material", "interior"};
    static const char vertices[] = "three points: \"vertices\": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]";
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(node, "vertices", vertices, err));
    const BpNode points = bp_node_member(node, "vertices");
    BP_TRY(parse_points(&points, 3, vertices, triangle->vertices, err));
    triangle->albedo = BP_NO_ALBEDO;
    return parse_material(node, index, &triangle->material, err);
}

static BpStatus parse_quad(const BpNode *node, const BpMaterialIndex *index, BpTriangle *triangles,
                           BpError *err) {
    static const char *const names[] = {"corner", "u", "v", "material", "interior"};
    double at[4][3], u[3], v[3];
    uint32_t material;
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(node, "corner", "\"corner\": [x, y, z]", err));
    BP_TRY(bp_node_require(node, "u", "the side from there: \"u\": [x, y, z]", err));
    BP_TRY(bp_node_require(node, "v", "the other side from there: \"v\": [x, y, z]", err));
    const BpNode corner = bp_node_member(node, "corner"), side = bp_node_member(node, "u"),
                 other = bp_node_member(node, "v");
    BP_TRY(bp_node_vector(&corner, at[0], err));
    BP_TRY(bp_node_vector(&side, u, err));
    BP_TRY(bp_node_vector(&other, v, err));
    BP_TRY(parse_material(node, index, &material, err));
    for (int a = 0; a < 3; a++) {
        at[1][a] = at[0][a] + u[a];
        at[2][a] = at[0][a] + u[a] + v[a];
        at[3][a] = at[0][a] + v[a];
    }
    put(&triangles[0], at[0], at[1], at[2], material);
    put(&triangles[1], at[0], at[2], at[3], material);
    return BP_OK;
}

static BpStatus parse_box(const BpNode *node, const BpMaterialIndex *index, BpTriangle *triangles,
                          BpError *err) {
    static const char *const names[] = {"corners", "rotate", "translate", "material", "interior"};
    static const char expected[] = "two opposite points: \"corners\": [[0, 0, 0], [1, 1, 1]]";
    /* The corners of each side by their bits, x in the lowest, counter-clockwise seen from outside. */
    static const int sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    double ends[2][3], degrees[3] = {0, 0, 0}, way[3] = {0, 0, 0}, at[8][3];
    uint32_t material;
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(node, "corners", expected, err));
    const BpNode corners = bp_node_member(node, "corners"), turned = bp_node_member(node, "rotate"),
                 moved = bp_node_member(node, "translate");
    BP_TRY(parse_points(&corners, 2, expected, ends, err));
    BP_TRY(bp_node_vector(&turned, degrees, err));
    BP_TRY(bp_node_vector(&moved, way, err));
    BP_TRY(parse_material(node, index, &material, err));
    const BpPlacement placement = bp_placement((const double[3]){1, 1, 1}, degrees, way);
    for (int corner = 0; corner < 8; corner++) {
        for (int a = 0; a < 3; a++)
            at[corner][a] =
                (corner >> a & 1) != 0 ? fmax(ends[0][a], ends[1][a]) : fmin(ends[0][a], ends[1][a]);
        bp_place_point(&placement, at[corner]);
    }
    for (int side = 0; side < 6; side++) {
        const int *c = sides[side];
        put(&triangles[2 * side], at[c[0]], at[c[1]], at[c[2]], material);
        put(&triangles[2 * side + 1], at[c[0]], at[c[2]], at[c[3]], material);
    }
    return BP_OK;
}

/* What fills the body that the last `each` triangles are a part of. */
static BpStatus parse_interior(const BpNode *node, size_t each, BpScene *scene, BpError *err) {
    const BpNode interior = bp_node_member(node, "interior");
    uint32_t number = 0;
    if (interior.value == NULL) return BP_OK;
    BP_TRY(bp_parse_medium_name(&interior, scene, &number, err));
    BP_TRY(bp_make_interiors(scene->triangle_count, &scene->triangle_interiors,
                             &scene->triangle_interior_count, err));
    for (size_t i = scene->triangle_count - each; i < scene->triangle_count; i++)
        scene->triangle_interiors[i] = number;
    return BP_OK;
}

typedef BpStatus Parse(const BpNode *node, const BpMaterialIndex *index, BpTriangle *triangles, BpError *err);

/* One of the three lists, of which each entry is `each` triangles. */
static BpStatus parse_list(const BpNode *node, const char *expected, const char *entry, size_t each,
                           Parse *parse, const BpMaterialIndex *index, BpScene *scene, size_t *count,
                           BpError *err) {
    if (node->value == NULL) return BP_OK;
    BP_TRY(bp_node_list(node, expected, err));
    *count = json_array_size(node->value);
    if (*count == 0) return BP_OK;
    const size_t most = (BP_SPHERES_MAX - scene->triangle_count) / each;
    if (*count > most)
        return bp_node_fail(node, BP_PART_VALUE, err, "found %zu entries, expected at most %zu", *count,
                            most);
    BpTriangle *grown = realloc(scene->triangles, (scene->triangle_count + *count * each) * sizeof *grown);
    if (grown == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu triangles", *count * each);
    scene->triangles = grown;
    for (size_t i = 0; i < *count; i++) {
        const BpNode element = bp_node_element(node, i);
        if (!json_is_object(element.value)) return bp_node_wrong(&element, entry, err);
        BP_TRY(parse(&element, index, &scene->triangles[scene->triangle_count], err));
        scene->triangle_count += each;
        BP_TRY(parse_interior(&element, each, scene, err));
    }
    return BP_OK;
}

/* Of the triangles that are listed, which are the scene's first. */
static BpStatus parse_normals(const BpNode *list, BpScene *scene, BpError *err) {
    for (size_t i = 0; i < scene->triangle_count; i++) {
        const BpNode element = bp_node_element(list, i), normals = bp_node_member(&element, "normals");
        double directions[3][3];
        if (normals.value == NULL) continue;
        BP_TRY(parse_points(&normals, 3,
                            "three directions: \"normals\": [[0, 0, 1], [0, 0.1, 1], [0.1, 0, 1]]",
                            directions, err));
        BP_TRY(bp_scene_make_normals(scene, scene->triangle_count, err));
        for (size_t k = 0; k < 3; k++) {
            const BpNode normal = bp_node_element(&normals, k);
            if (!bp_unit_normal(directions[k], scene->normals[i][k]))
                return bp_node_wrong(&normal, "a direction, other than [0, 0, 0]", err);
        }
    }
    return BP_OK;
}

/* ---- texture coordinates ---- */

/* The same. */
static BpStatus parse_coordinates(const BpNode *list, BpScene *scene, BpError *err) {
    static const char expected[] = "three pairs of numbers: \"uvs\": [[0, 0], [1, 0], [0, 1]]";
    for (size_t i = 0; i < scene->triangle_count; i++) {
        const BpNode element = bp_node_element(list, i), uvs = bp_node_member(&element, "uvs");
        if (uvs.value == NULL) continue;
        if (json_array_size(uvs.value) != 3) return bp_node_wrong(&uvs, expected, err);
        BP_TRY(bp_scene_make_coordinates(scene, scene->triangle_count, err));
        for (size_t k = 0; k < 6; k++) {
            const BpNode pair = bp_node_element(&uvs, k / 2);
            if (json_array_size(pair.value) != 2) return bp_node_wrong(&uvs, expected, err);
            const BpNode number = bp_node_element(&pair, k % 2);
            double value = 0;
            BP_TRY(bp_node_number(&number, &value, err));
            if (!(fabs(value) <= BP_UV_MAX)) return bp_node_wrong(&number, "a number from -1e6 to 1e6", err);
            scene->coordinates[i][k] = (float)value;
        }
    }
    return BP_OK;
}

/* A square of two triangles, of which the first has corners 0, 1 and 2 and the second 0, 2 and 3; u and v are
 * 0 at the corner `first`, and u grows from there to the next. */
static BpStatus lay_square(BpScene *scene, size_t triangle, int first, BpError *err) {
    static const int corners[2][3] = {{0, 1, 2}, {0, 2, 3}};
    if (!bp_material_is_mapped(scene, &scene->materials[scene->triangles[triangle].material])) return BP_OK;
    BP_TRY(bp_scene_make_coordinates(scene, scene->triangle_count, err));
    for (size_t t = 0; t < 2; t++)
        for (int k = 0; k < 3; k++) {
            const int corner = (corners[t][k] - first + 4) % 4;
            scene->coordinates[triangle + t][2 * k] = corner == 1 || corner == 2;
            scene->coordinates[triangle + t][2 * k + 1] = corner >= 2;
        }
    return BP_OK;
}

/* Of quads, u runs along the side u and v along v. On a box they run so that each side shows the whole map,
 * seen from outside: upright, y upwards, and on top and bottom x to the right. */
static BpStatus lay_quads_and_boxes(BpScene *scene, size_t listed, BpError *err) {
    static const int first[BP_BOX_TRIANGLES / 2] = {0, 3, 0, 1, 3, 0};
    for (size_t i = 0; i < scene->quad_count; i++)
        BP_TRY(lay_square(scene, listed + BP_QUAD_TRIANGLES * i, 0, err));
    const size_t boxes = listed + BP_QUAD_TRIANGLES * scene->quad_count;
    for (size_t i = 0; i < 6 * scene->box_count; i++)
        BP_TRY(lay_square(scene, boxes + 2 * i, first[i % 6], err));
    return BP_OK;
}

BpStatus bp_parse_triangles(const BpNode *root, const BpMaterialIndex *index, BpScene *scene, BpError *err) {
    const BpNode triangles = bp_node_member(root, "triangles"), quads = bp_node_member(root, "quads"),
                 boxes = bp_node_member(root, "boxes");
    size_t listed = 0;
    BP_TRY(parse_list(
        &triangles,
        "a list of triangles: [ { \"vertices\": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], \"material\": ... } ]",
        "an object: { \"vertices\": ..., \"material\": ... }", 1, parse_triangle, index, scene, &listed,
        err));
    BP_TRY(parse_normals(&triangles, scene, err));
    BP_TRY(parse_coordinates(&triangles, scene, err));
    BP_TRY(parse_list(&quads,
                      "a list of quads: [ { \"corner\": [0, 0, 0], \"u\": [1, 0, 0], \"v\": [0, 1, 0], "
                      "\"material\": ... } ]",
                      "an object: { \"corner\": ..., \"u\": ..., \"v\": ..., \"material\": ... }",
                      BP_QUAD_TRIANGLES, parse_quad, index, scene, &scene->quad_count, err));
    BP_TRY(parse_list(&boxes,
                      "a list of boxes: [ { \"corners\": [[0, 0, 0], [1, 1, 1]], \"material\": ... } ]",
                      "an object: { \"corners\": ..., \"material\": ... }", BP_BOX_TRIANGLES, parse_box,
                      index, scene, &scene->box_count, err));
    return lay_quads_and_boxes(scene, listed, err);
}
