/* capsule_rules.c: see capsule_rules.h. */
#include "capsule_rules.h"

#include "base/message_text.h"
#include "material.h"
#include "vector.h"

#include <math.h>
#include <stdlib.h>

#define ON_CAMERA 1.0e-12 /* over the size */

static bool place_fault(const BpCapsule *capsule, BpFault *fault) {
    char text[BP_NUMBER_TEXT_SIZE];
    for (int k = 0; k < 2; k++)
        for (int a = 0; a < 3; a++)
            if (!(fabs(capsule->ends[k][a]) <= BP_VERTEX_MAX))
                return bp_fault_set(
                    fault, BP_FAULT_CAPSULE, "ends",
                    "found %s, expected coordinates from -1e9 to 1e9; choose a larger unit of length",
                    bp_number_text(capsule->ends[k][a], text));
    if (capsule->radius >= BP_CAPSULE_RADIUS_MIN && capsule->radius <= BP_VERTEX_MAX) return false;
    return bp_fault_set(fault, BP_FAULT_CAPSULE, "radius",
                        "found %s, expected a radius from 1e-12 to 1e9: capsules cannot be turned inside out",
                        bp_number_text(capsule->radius, text));
}

/* A texture that lies on surfaces by longitude and latitude. */
static bool has_map(const BpScene *scene, const BpMaterial *material) {
    for (int m = 0; m < BP_MEMBER_COUNT; m++) {
        const uint32_t number = material->texture[m];
        if (number != 0 && scene->textures[number - 1].mapping == BP_MAPPING_SURFACE) return true;
    }
    return false;
}

bool bp_capsule_material_fault(const BpScene *scene, uint32_t number, BpFault *fault) {
    const BpMaterial *material = &scene->materials[number];
    if (material->kind == BP_MATERIAL_INTERFACE)
        return bp_fault_set(
            fault, BP_FAULT_CAPSULE, "material",
            "found the type \"interface\", expected another: capsules surround no media; use a "
            "sphere as their boundary");
    if (bp_material_is(material->kind, BP_HAS_INSIDE) && scene->medium_count > 0)
        return bp_fault_set(fault, BP_FAULT_CAPSULE, "material",
                            "found glass of capsules in a scene with media, expected one or the other: use "
                            "spheres of glass, or remove \"media\"");
    if (material->emit[0] > 0 || material->emit[1] > 0 || material->emit[2] > 0)
        return bp_fault_set(
            fault, BP_FAULT_CAPSULE, "material",
            "found a material that emits, expected another: no rays are sent to capsules; let spheres "
            "or triangles emit");
    if (has_map(scene, material))
        return bp_fault_set(
            fault, BP_FAULT_CAPSULE, "material",
            "found a texture that is laid around spheres, expected one that fills space: capsules have no "
            "longitude; change its mapping to \"solid\", or the material");
    return false;
}

/* Whether a point lies on a capsule's surface, as far as can be told. */
static bool holds_point(const BpCapsule *capsule, const double point[3]) {
    double axis[3], way[3];
    for (int a = 0; a < 3; a++) {
        axis[a] = capsule->ends[1][a] - capsule->ends[0][a];
        way[a] = point[a] - capsule->ends[0][a];
    }
    const double square = bp_dot(axis, axis), size = bp_length(point) + capsule->radius + sqrt(square);
    const double place = square > 0 ? fmin(1, fmax(0, bp_dot(way, axis) / square)) : 0;
    for (int a = 0; a < 3; a++) way[a] -= place * axis[a];
    return fabs(bp_length(way) - capsule->radius) <= ON_CAMERA * size;
}

/* ---- glass has one surface ---- */

typedef struct Surface {
    double ends[2][3], radius; /* the ends in order */
    size_t capsule;
} Surface;

static int compare_points(const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++)
        if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
    return 0;
}

static int compare_surfaces(const void *a_pointer, const void *b_pointer) {
    const Surface *a = a_pointer, *b = b_pointer;
    for (int k = 0; k < 2; k++) {
        const int order = compare_points(a->ends[k], b->ends[k]);
        if (order != 0) return order;
    }
    return a->radius < b->radius ? -1 : a->radius > b->radius;
}

static BpStatus find_same(const BpScene *scene, size_t glass, BpFault *fault, BpError *err) {
    Surface *surfaces = malloc(glass * sizeof *surfaces);
    size_t count = 0;
    if (surfaces == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory while comparing %zu capsules", glass);
    for (size_t i = 0; i < scene->capsule_count; i++) {
        const BpCapsule *capsule = &scene->capsules[i];
        if (!bp_material_is(scene->materials[capsule->material].kind, BP_HAS_INSIDE)) continue;
        const bool forward = compare_points(capsule->ends[0], capsule->ends[1]) < 0;
        Surface *surface = &surfaces[count++];
        memcpy(surface->ends[0], capsule->ends[forward ? 0 : 1], sizeof surface->ends[0]);
        memcpy(surface->ends[1], capsule->ends[forward ? 1 : 0], sizeof surface->ends[1]);
        surface->radius = capsule->radius;
        surface->capsule = i;
    }
    qsort(surfaces, count, sizeof *surfaces, compare_surfaces);
    for (size_t i = 1; i < count && fault->subject == BP_FAULT_NONE; i++) {
        if (compare_surfaces(&surfaces[i - 1], &surfaces[i]) != 0) continue;
        char name[BP_SPHERE_NAME_SIZE];
        const size_t a = surfaces[i - 1].capsule, b = surfaces[i].capsule;
        fault->index = a > b ? a : b;
        bp_fault_set(
            fault, BP_FAULT_CAPSULE, "",
            "found the surface of %s, which is glass too, expected one of its own: remove one of them, or "
            "change a radius",
            bp_capsule_name(scene, a > b ? b : a, name));
    }
    free(surfaces);
    return BP_OK;
}

BpStatus bp_scene_find_capsule_fault(const BpScene *scene, BpFault *fault, BpError *err) {
    const BpCamera *camera = &scene->camera;
    const bool pinhole = camera->lens_radius == 0 && camera->projection == BP_PERSPECTIVE;
    size_t glass = 0;
    for (size_t i = 0; i < scene->capsule_count; i++) {
        const BpCapsule *capsule = &scene->capsules[i];
        fault->index = i;
        if (capsule->material >= scene->material_count) {
            bp_fault_set(fault, BP_FAULT_CAPSULE, "material",
                         "found number %u, expected one of %zu materials", (unsigned)capsule->material,
                         scene->material_count);
            return BP_OK;
        }
        if (place_fault(capsule, fault) || bp_capsule_material_fault(scene, capsule->material, fault))
            return BP_OK;
        glass += bp_material_is(scene->materials[capsule->material].kind, BP_HAS_INSIDE);
        if (pinhole && holds_point(capsule, camera->lookfrom)) {
            char name[BP_SPHERE_NAME_SIZE];
            bp_fault_set(fault, BP_FAULT_CAPSULE, "",
                         "found lookfrom of the camera on %s, expected it beside: move one of them slightly",
                         bp_capsule_name(scene, i, name));
            return BP_OK;
        }
    }
    return glass > 1 ? find_same(scene, glass, fault, err) : BP_OK;
}
