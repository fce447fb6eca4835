/* gsd_shapes.c: see gsd_shapes.h. */
#include "gsd_shapes.h"

#include "convex_hull.h"
#include "reader.h"
#include "scene/vector.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define RADIUS_MAX 1.0e12 /* that of a scene */

/* A number of at least 0 by its name. */
static BpStatus read_length(const json_t *shape, const char *name, double *length, BpError *err) {
    const json_t *const value = json_object_get(shape, name);
    *length = json_number_value(value);
    if (json_is_number(value) && *length >= 0) return BP_OK;
    return bp_fail(err, BP_ERR_SCENE, "found no \"%s\", expected a number of at least 0", name);
}

/* Point `i` of a list of points in two or three dimensions. */
static BpStatus read_point(const json_t *list, size_t i, double point[3], BpError *err) {
    const json_t *const value = json_array_get(list, i);
    const size_t count = json_array_size(value);
    bool good = count == 2 || count == 3;
    point[2] = 0;
    for (size_t c = 0; c < count && good; c++) {
        point[c] = json_number_value(json_array_get(value, c));
        good = json_is_number(json_array_get(value, c));
    }
    return good ? BP_OK
                : bp_fail(err, BP_ERR_SCENE, "found no point at %zu (from 0) of a list, expected numbers", i);
}

static BpStatus read_ellipsoid(const json_t *json, GsdShape *shape, BpError *err) {
    static const char *const names[3] = {"a", "b", "c"};
    for (int i = 0; i < 3; i++) BP_TRY(read_length(json, names[i], &shape->half_axes[i], err));
    shape->diameter = 2 * cbrt(shape->half_axes[0]) * cbrt(shape->half_axes[1]) * cbrt(shape->half_axes[2]);
    return BP_OK;
}

/* ---- bodies ------------------------------------------------------------------------------------------- */

/* The list of corners, how far the farthest lies from the centre, and the radius by which edges are rounded.
 */
static BpStatus read_corners(const json_t *json, BpParticleShape *body, BpError *err) {
    const json_t *const corners = json_object_get(json, "vertices");
    const size_t count = json_array_size(corners);
    if (json_object_get(json, "rounding_radius") != NULL)
        BP_TRY(read_length(json, "rounding_radius", &body->rounding, err));
    if (count == 0) return bp_fail(err, BP_ERR_SCENE, "found no \"vertices\", expected a list of points");
    body->vertices = calloc(2 * count, sizeof *body->vertices); /* prisms have each of them twice */
    if (body->vertices == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu corners", count);
    body->vertex_count = count;
    for (size_t i = 0; i < count; i++) {
        BP_TRY(read_point(corners, i, body->vertices[i], err));
        body->radius = fmax(body->radius, bp_length(body->vertices[i]));
    }
    if (!(body->radius <= RADIUS_MAX))
        return bp_fail(err, BP_ERR_SCENE, "found \"vertices\" farther away than 1e12, expected them nearer");
    return BP_OK;
}

/* Room for faces with so many corners in all. */
static BpStatus make_faces(BpParticleShape *body, size_t faces, size_t corners, BpError *err) {
    body->ends = calloc(faces + 1, sizeof *body->ends);
    body->corners = calloc(corners + 1, sizeof *body->corners);
    if (body->ends != NULL && body->corners != NULL) return BP_OK;
    return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu faces", faces);
}

static void put_corner(BpParticleShape *body, uint32_t corner) {
    body->corners[body->ends[body->face_count]++] = corner;
}

static void end_face(BpParticleShape *body) {
    body->face_count++;
    body->ends[body->face_count] = body->ends[body->face_count - 1];
}

/* One that is rounded may have one corner, and is a sphere, or two, and is a capsule. */
static BpStatus read_rounded(const BpParticleShape *body, GsdShape *shape, BpError *err) {
    if (body->vertex_count == 2) {
        shape->body.kind = "spherocylinder";
        shape->body.capsule_radius = body->rounding;
        shape->body.radius += body->rounding;
        shape->body.rounding = 0;
        return BP_OK;
    }
    shape->sphere = calloc(1, sizeof *shape->sphere);
    if (shape->sphere == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a sphere");
    memcpy(shape->sphere[0], body->vertices[0], sizeof body->vertices[0]);
    shape->sphere[0][3] = body->rounding;
    shape->sphere_count = 1;
    shape->body.radius += body->rounding;
    return BP_OK;
}

static BpStatus read_polyhedron(const json_t *json, GsdShape *shape, BpError *err) {
    BpParticleShape *const body = &shape->body;
    uint32_t(*faces)[3] = NULL;
    size_t count = 0;
    body->kind = "polyhedron";
    BP_TRY(read_corners(json, body, err));
    if (body->vertex_count <= 2 && body->rounding > 0) return read_rounded(body, shape, err);
    if (body->vertex_count > CONVEX_HULL_POINTS_MAX)
        return bp_fail(err, BP_ERR_SCENE, "found %zu \"vertices\", expected at most %d, or a \"Mesh\"",
                       body->vertex_count, CONVEX_HULL_POINTS_MAX);
    BP_TRY(convex_hull((const double(*)[3])body->vertices, body->vertex_count, &faces, &count, err));
    if (count == 0)
        return bp_fail(err, BP_ERR_SCENE,
                       "found %zu \"vertices\" in one plane, expected those of a body with a volume",
                       body->vertex_count);
    const BpStatus status = make_faces(body, count, 3 * count, err);
    for (size_t f = 0; f < count && status == BP_OK; f++) {
        for (int k = 0; k < 3; k++) put_corner(body, faces[f][k]);
        end_face(body);
    }
    free(faces);
    return status;
}

/* A prism over the polygon, which lies in the middle. */
static BpStatus read_polygon(const json_t *json, GsdShape *shape, BpError *err) {
    BpParticleShape *const body = &shape->body;
    double area = 0;
    body->kind = "polygon";
    BP_TRY(read_corners(json, body, err));
    const uint32_t count = (uint32_t)body->vertex_count;
    for (uint32_t i = 0; i < count; i++) {
        const double *const a = body->vertices[i], *const b = body->vertices[(i + 1) % count];
        area += a[0] * b[1] - a[1] * b[0];
    }
    if (count <= 2 && body->rounding > 0) return read_rounded(body, shape, err);
    if (count < 3 || !(fabs(area) > 0))
        return bp_fail(err, BP_ERR_SCENE,
                       "found %u \"vertices\" on one line, expected those of a polygon with an area",
                       (unsigned)count);
    const double half = GSD_POLYGON_THICKNESS * body->radius;
    for (uint32_t i = 0; i < count; i++) {
        memcpy(body->vertices[count + i], body->vertices[i], sizeof body->vertices[0]);
        body->vertices[i][2] = -half;
        body->vertices[count + i][2] = half;
    }
    body->vertex_count = 2 * (size_t)count;
    BP_TRY(make_faces(body, count + 2, 6 * (size_t)count, err));
    for (uint32_t i = 0; i < count; i++) put_corner(body, count + (area > 0 ? i : count - 1 - i));
    end_face(body);
    for (uint32_t i = 0; i < count; i++) put_corner(body, area > 0 ? count - 1 - i : i);
    end_face(body);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t next = (i + 1) % count, a = area > 0 ? i : next, b = area > 0 ? next : i;
        put_corner(body, a);
        put_corner(body, b);
        put_corner(body, count + b);
        put_corner(body, count + a);
        end_face(body);
    }
    return BP_OK;
}

static BpStatus read_mesh(const json_t *json, GsdShape *shape, BpError *err) {
    BpParticleShape *const body = &shape->body;
    const json_t *const faces = json_object_get(json, "indices");
    const size_t count = json_array_size(faces);
    size_t corners = 0;
    body->kind = "mesh";
    BP_TRY(read_corners(json, body, err));
    if (count == 0) return bp_fail(err, BP_ERR_SCENE, "found no \"indices\", expected a list of faces");
    for (size_t f = 0; f < count; f++) corners += json_array_size(json_array_get(faces, f));
    BP_TRY(make_faces(body, count, corners, err));
    for (size_t f = 0; f < count; f++) {
        const json_t *const face = json_array_get(faces, f);
        const size_t size = json_array_size(face);
        if (size < 3)
            return bp_fail(err, BP_ERR_SCENE,
                           "found %zu \"indices\" at face %zu (from 0), expected 3 or more", size, f);
        for (size_t k = 0; k < size; k++) {
            const json_t *const corner = json_array_get(face, k);
            const json_int_t number = json_integer_value(corner);
            if (!json_is_integer(corner) || number < 0 || (size_t)number >= body->vertex_count)
                return bp_fail(err, BP_ERR_SCENE,
                               "found no vertex at corner %zu of face %zu (both from 0), expected whole "
                               "numbers below %zu",
                               k, f, body->vertex_count);
            put_corner(body, (uint32_t)number);
        }
        end_face(body);
    }
    return BP_OK;
}

/* ---- unions ------------------------------------------------------------------------------------------- */

static BpStatus read_union(const json_t *json, GsdShape *shape, BpError *err) {
    const json_t *const centers = json_object_get(json, "centers"), *const diameters =
                                                                        json_object_get(json, "diameters");
    const size_t count = json_array_size(centers);
    if (count == 0 || json_array_size(diameters) != count)
        return bp_fail(err, BP_ERR_SCENE,
                       "found %zu \"centers\" and %zu \"diameters\", expected as many of both", count,
                       json_array_size(diameters));
    shape->sphere = malloc(count * sizeof *shape->sphere);
    if (shape->sphere == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a union of spheres");
    shape->diameter = 0;
    for (size_t i = 0; i < count; i++) {
        double *const sphere = shape->sphere[i];
        const json_t *const diameter = json_array_get(diameters, i);
        BP_TRY(read_point(centers, i, sphere, err));
        sphere[3] = json_number_value(diameter) / 2;
        if (!json_is_number(diameter) || sphere[3] < 0)
            return bp_fail(err, BP_ERR_SCENE, "found no number of at least 0 in \"diameters\", expected %zu",
                           count);
        shape->diameter = fmax(shape->diameter, 2 * (bp_length(sphere) + sphere[3]));
    }
    shape->sphere_count = count;
    if (count <= GSD_UNION_MAX) return BP_OK;
    shape->kind = "sphere union";
    shape->sphere_count = 0;
    return BP_OK;
}

/* ---- classes ------------------------------------------------------------------------------------------ */

static BpStatus read_class(const json_t *json, GsdShape *shape, BpError *err) {
    static const struct {
        const char *name;
        BpStatus (*read)(const json_t *json, GsdShape *shape, BpError *err);
    } bodies[] = {{"Polygon", read_polygon}, {"ConvexPolyhedron", read_polyhedron}, {"Mesh", read_mesh}};
    if (!json_is_object(json))
        return bp_fail(err, BP_ERR_SCENE, "found no object, expected { \"type\": ... }");
    const char *const class = json_string_value(json_object_get(json, "type"));
    if (class == NULL) return BP_OK;
    if (strcmp(class, "Sphere") == 0) return read_length(json, "diameter", &shape->diameter, err);
    if (strcmp(class, "Ellipsoid") == 0) return read_ellipsoid(json, shape, err);
    if (strcmp(class, "SphereUnion") == 0) return read_union(json, shape, err);
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
        if (strcmp(class, bodies[i].name) != 0) continue;
        BP_TRY(bodies[i].read(json, shape, err));
        shape->has_body = shape->sphere_count == 0;
        shape->diameter = 2 * shape->body.radius;
        return BP_OK;
    }
    shape->kind = "other shape";
    return BP_OK;
}

void gsd_shape_clear(GsdShape *shape) {
    free(shape->sphere);
    particle_shape_clear(&shape->body);
    *shape = (GsdShape){.diameter = NAN};
}

BpStatus gsd_shape_read(const char *text, size_t size, GsdShape *shape, BpError *err) {
    size_t length = 0;
    json_error_t error;
    *shape = (GsdShape){.diameter = NAN};
    while (length < size && text[length] != '\0') length++;
    if (length == 0) return BP_OK;
    json_t *const json = json_loadb(text, length, 0, &error);
    if (json == NULL) return bp_fail(err, BP_ERR_SCENE, "found text that is not JSON (%s)", error.text);
    const BpStatus status = read_class(json, shape, err);
    json_decref(json);
    if (status != BP_OK) gsd_shape_clear(shape);
    return status;
}
