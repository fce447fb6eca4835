/* rounding.c: see rounding.h. */
#include "rounding.h"

#include "base/message_text.h"
#include "base/status.h"
#include "scene/material.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* x as the kernel has it. It is stored in memory, since compilers have dropped a conversion to float and
 * back. */
static double as_float(double x) {
    volatile float rounded = (float)x;
    return (double)rounded;
}

/* How far rounding may move the surface of a sphere around `center`, in the scene's unit: by the centre and
 * by the radius. */
static double surface_shift(const double origin[3], const BpSphere *sphere, const double center[3]) {
    double square = 0;
    for (int a = 0; a < 3; ++a) {
        const double c = center[a] - origin[a], off = as_float(c) - c;
        square += off * off;
    }
    const double r = fabs(sphere->radius);
    return sqrt(square) + fabs(as_float(r) - r);
}

typedef struct Worst {
    size_t sphere, count; /* or triangle */
    double ratio;
} Worst;

static void note(Worst *worst, size_t sphere, double ratio, double limit) {
    if (!(ratio > limit)) return;
    ++worst->count;
    if (ratio <= worst->ratio) return;
    worst->ratio = ratio;
    worst->sphere = sphere;
}

static const char *others(const Worst *worst, char text[48]) {
    text[0] = '\0';
    if (worst->count > 1) snprintf(text, 48, " (and %zu more)", worst->count - 1);
    return text;
}

/* How far rounding may move a vertex of a triangle, as a part of its shortest edge. The vertices that two
 * triangles share move together, so a mesh has no cracks, but shapes change. */
static double vertex_shift(const double origin[3], const BpTriangle *triangle) {
    double farthest = 0, shortest = INFINITY;
    for (int k = 0; k < 3; ++k) {
        const double *from = triangle->vertices[k], *to = triangle->vertices[(k + 1) % 3];
        double off = 0, edge = 0;
        for (int a = 0; a < 3; ++a) {
            const double v = from[a] - origin[a];
            off += (as_float(v) - v) * (as_float(v) - v);
            edge += (to[a] - from[a]) * (to[a] - from[a]);
        }
        farthest = fmax(farthest, off);
        shortest = fmin(shortest, edge);
    }
    return sqrt(farthest / shortest);
}

static void add_vertices(const BpScene *scene, const double origin[3], BpRoundingWarnings *limits) {
    Worst moved = {0};
    char more[48], name[BP_SPHERE_NAME_SIZE];
    for (size_t i = 0; i < scene->triangle_count; ++i)
        note(&moved, i, vertex_shift(origin, &scene->triangles[i]), BP_ROUNDING_VERTEX);
    if (moved.count == 0) return;
    snprintf(limits->remedy[limits->count], sizeof limits->remedy[0], "a camera closer to it");
    snprintf(limits->text[limits->count++], sizeof limits->text[0],
             "a vertex of %s%s is displaced by %.2g of the shortest edge in single precision",
             bp_triangle_name(scene, moved.sphere, name), others(&moved, more), moved.ratio);
}

/* How far rounding may move an end of a capsule, as a part of its radius. */
static double axis_shift(const double origin[3], const BpCapsule *capsule) {
    double square = 0;
    for (int a = 0; a < 3; ++a) {
        const double c = capsule->ends[0][a] - origin[a], way = capsule->ends[1][a] - capsule->ends[0][a];
        const double off = fabs(as_float(c) - c) + fabs(as_float(way) - way);
        square += off * off;
    }
    return sqrt(square) / capsule->radius;
}

static void add_axes(const BpScene *scene, const double origin[3], BpRoundingWarnings *limits) {
    Worst moved = {0};
    char more[48], name[BP_SPHERE_NAME_SIZE];
    for (size_t i = 0; i < scene->capsule_count; ++i)
        note(&moved, i, axis_shift(origin, &scene->capsules[i]), BP_ROUNDING_SHIFT);
    if (moved.count == 0) return;
    snprintf(limits->remedy[limits->count], sizeof limits->remedy[0], "a camera closer to it");
    snprintf(limits->text[limits->count++], sizeof limits->text[0],
             "an end of %s%s is displaced by %.2g of its radius in single precision",
             bp_capsule_name(scene, moved.sphere, name), others(&moved, more), moved.ratio);
}

/* A shell's wall: two dielectrics around one centre, found by sorting on the rounded centre and the radius.
 */
typedef struct Shell {
    float center[6]; /* when the shutter opens and when it closes */
    double radius;
    size_t sphere;
} Shell;

static int compare_centers(const Shell *a, const Shell *b) {
    for (int i = 0; i < 6; ++i)
        if (a->center[i] != b->center[i]) return a->center[i] < b->center[i] ? -1 : 1;
    return 0;
}

static int compare_shells(const void *a_pointer, const void *b_pointer) {
    const Shell *a = a_pointer, *b = b_pointer;
    const int centers = compare_centers(a, b);
    if (centers != 0) return centers;
    if (a->radius != b->radius) return a->radius < b->radius ? -1 : 1;
    return a->sphere < b->sphere ? -1 : a->sphere > b->sphere;
}

/* A warning is not worth a failure: without memory there is none. */
static void find_walls(const BpScene *scene, const double origin[3], Worst *worst, double *wall) {
    Shell *shells = malloc((scene->sphere_count + 1) * sizeof *shells);
    size_t count = 0;
    if (shells == NULL) return;
    for (size_t i = 0; i < scene->sphere_count; ++i) {
        const BpSphere *sphere = &scene->spheres[i];
        if (!bp_material_is(scene->materials[sphere->material].kind, BP_HAS_INSIDE)) continue;
        Shell *shell = &shells[count++];
        for (int a = 0; a < 3; ++a) shell->center[a] = (float)(sphere->center[a] - origin[a]);
        for (int a = 0; a < 3; ++a) shell->center[3 + a] = (float)(bp_sphere_end(scene, i)[a] - origin[a]);
        shell->radius = fabs(sphere->radius);
        shell->sphere = i;
    }
    qsort(shells, count, sizeof *shells, compare_shells);
    for (size_t i = 1; i < count; ++i) {
        const Shell *in = &shells[i - 1], *out = &shells[i];
        if (compare_centers(in, out) != 0) continue;
        const double thick = out->radius - in->radius;
        if (!(thick > 0)) continue;
        const double ratio = fabs(as_float(out->radius) - as_float(in->radius) - thick) / thick;
        const double before = worst->ratio;
        note(worst, in->sphere, ratio, BP_ROUNDING_WALL);
        if (worst->ratio != before) *wall = thick;
    }
    free(shells);
}

/* A ray begins at a point of the lens. The rounding of that point moves the place where the ray meets the
 * plane in focus. */
static void add_lens(const BpCamera *camera, BpRoundingWarnings *limits) {
    const double pixel = bp_camera_plane_height(camera) / camera->height;
    const double shift = camera->lens_radius * 0x1p-24;
    if (!(shift > BP_ROUNDING_LENS * pixel)) return;
    snprintf(limits->remedy[limits->count], sizeof limits->remedy[0], "a smaller aperture");
    snprintf(limits->text[limits->count++], sizeof limits->text[0],
             "the lens (radius %g) is so large that rays meet the plane in focus up to %.2g pixels off their "
             "place in single precision",
             camera->lens_radius, shift / pixel);
}

void bp_rounding_warnings(const BpScene *scene, BpPrecision precision, BpRoundingWarnings *limits) {
    memset(limits, 0, sizeof *limits);
    if (precision == BP_PRECISION_DOUBLE || bp_scene_shapes(scene) == 0) return;
    Worst off_place = {0}, contact = {0}, thin = {0};
    double smallest = INFINITY, wall = 0;
    size_t smallest_sphere = 0;
    char more[48], name[BP_SPHERE_NAME_SIZE], other[BP_SPHERE_NAME_SIZE];
    double origin[3];
    bp_camera_origin(scene, origin);
    for (size_t i = 0; i < scene->sphere_count; ++i)
        if (fabs(scene->spheres[i].radius) < smallest) {
            smallest = fabs(scene->spheres[i].radius);
            smallest_sphere = i;
        }
    for (size_t i = 0; i < scene->sphere_count; ++i) {
        const BpSphere *sphere = &scene->spheres[i];
        const double radius = fabs(sphere->radius);
        double shift = surface_shift(origin, sphere, sphere->center);
        if (bp_sphere_moves(scene, i))
            shift = fmax(shift, surface_shift(origin, sphere, bp_sphere_end(scene, i)));
        note(&off_place, i, shift / radius, BP_ROUNDING_SHIFT);
        if (radius > 100 * smallest) note(&contact, i, shift / smallest, BP_ROUNDING_CONTACT);
    }
    find_walls(scene, origin, &thin, &wall);
    if (off_place.count > 0) {
        snprintf(limits->remedy[limits->count], sizeof limits->remedy[0], "a camera closer to it");
        snprintf(limits->text[limits->count++], sizeof limits->text[0],
                 "%s (radius %g)%s is displaced by %.2g of its radius in single precision",
                 bp_sphere_name(scene, off_place.sphere, name), fabs(scene->spheres[off_place.sphere].radius),
                 others(&off_place, more), off_place.ratio);
    }
    if (contact.count > 0) {
        snprintf(limits->remedy[limits->count], sizeof limits->remedy[0], "a radius below %.2g",
                 smallest * BP_ROUNDING_CONTACT * 0x1p23);
        snprintf(limits->text[limits->count++], sizeof limits->text[0],
                 "the surface of %s (radius %g)%s is displaced by %.2g of the radius of %s (%g) in single "
                 "precision",
                 bp_sphere_name(scene, contact.sphere, name), fabs(scene->spheres[contact.sphere].radius),
                 others(&contact, more), contact.ratio, bp_sphere_name(scene, smallest_sphere, other),
                 smallest);
    }
    if (thin.count > 0) {
        snprintf(limits->remedy[limits->count], sizeof limits->remedy[0], "a thicker wall");
        snprintf(limits->text[limits->count++], sizeof limits->text[0],
                 "the wall between %s and the dielectric around it%s, %.2g thick, is displaced by %.2g of "
                 "its thickness in single precision",
                 bp_sphere_name(scene, thin.sphere, name), others(&thin, more), wall, thin.ratio);
    }
    add_vertices(scene, origin, limits);
    add_axes(scene, origin, limits);
    add_lens(&scene->camera, limits);
}

BpStatus bp_rounding_check_indices(const BpScene *scene, BpPrecision precision, BpError *err) {
    for (size_t m = 0; m < scene->material_count && precision == BP_PRECISION_SINGLE; ++m) {
        const BpMaterial *material = &scene->materials[m];
        const double index = material->refraction_index;
        size_t i = 0;
        if (material->kind != BP_MATERIAL_DIELECTRIC ||
            (index >= 1 / BP_SINGLE_INDEX_MAX && index <= BP_SINGLE_INDEX_MAX))
            continue;
        while (i < bp_scene_shapes(scene) && bp_shape_material(scene, i) != m) ++i;
        if (i == bp_scene_shapes(scene)) continue;
        char name[BP_SPHERE_NAME_SIZE];
        bp_printable(material->name, name, sizeof name);
        return bp_fail_with(
            BP_REMEDY_DOUBLE_PRECISION, err, BP_ERR_SCENE,
            "materials.%s.refraction_index: found %g, expected 1e-4 to 1e4 in single precision, which "
            "cannot tell apart the rays that such a surface refracts",
            name, index);
    }
    return BP_OK;
}
