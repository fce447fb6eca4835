/* gsd_shapes.c: see gsd_shapes.h. */
#include "gsd_shapes.h"
#include "scene/vector.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    double axes[3];
    for (int i = 0; i < 3; i++) BP_TRY(read_length(json, names[i], &axes[i], err));
    shape->diameter = 2 * cbrt(axes[0]) * cbrt(axes[1]) * cbrt(axes[2]);
    shape->kind = axes[0] == axes[1] && axes[1] == axes[2] ? NULL : "ellipsoid";
    return BP_OK;
}

static BpStatus read_corners(const json_t *json, GsdShape *shape, BpError *err) {
    const json_t *const corners = json_object_get(json, "vertices");
    double rounding = 0, point[3];
    if (json_object_get(json, "rounding_radius") != NULL)
        BP_TRY(read_length(json, "rounding_radius", &rounding, err));
    if (json_array_size(corners) == 0)
        return bp_fail(err, BP_ERR_SCENE, "found no \"vertices\", expected a list of points");
    shape->diameter = 0;
    for (size_t i = 0; i < json_array_size(corners); i++) {
        BP_TRY(read_point(corners, i, point, err));
        shape->diameter = fmax(shape->diameter, 2 * (bp_length(point) + rounding));
    }
    return BP_OK;
}

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

static BpStatus read_class(const json_t *json, GsdShape *shape, BpError *err) {
    static const char *const cornered[][2] = {
        {"Polygon", "polygon"}, {"ConvexPolyhedron", "polyhedron"}, {"Mesh", "polyhedron"}};
    if (!json_is_object(json))
        return bp_fail(err, BP_ERR_SCENE, "found no object, expected { \"type\": ... }");
    const char *const class = json_string_value(json_object_get(json, "type"));
    if (class == NULL) return BP_OK;
    if (strcmp(class, "Sphere") == 0) return read_length(json, "diameter", &shape->diameter, err);
    if (strcmp(class, "Ellipsoid") == 0) return read_ellipsoid(json, shape, err);
    if (strcmp(class, "SphereUnion") == 0) return read_union(json, shape, err);
    shape->kind = "other shape";
    for (size_t i = 0; i < sizeof cornered / sizeof *cornered; i++) {
        if (strcmp(class, cornered[i][0]) != 0) continue;
        shape->kind = cornered[i][1];
        return read_corners(json, shape, err);
    }
    return BP_OK;
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
    if (status == BP_OK && shape->sphere_count > 0) return BP_OK;
    free(shape->sphere);
    shape->sphere = NULL;
    return status;
}
