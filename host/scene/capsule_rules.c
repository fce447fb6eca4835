/* capsule_rules.c: see capsule_rules.h. */
#include "capsule_rules.h"

#include "base/message_text.h"
#include "capsule_way.h"
#include "material.h"
#include "shape_rules.h"

#include <math.h>
#include <stdlib.h>

#define ON_CAMERA 1.0e-12 /* over the size */

bool bp_capsule_place_fault(const BpCapsule *capsule, BpFault *fault) {
    char text[BP_NUMBER_TEXT_SIZE];
    for (int k = 0; k < 2; k++)
        for (int a = 0; a < 3; a++)
            if (!(fabs(capsule->ends[k][a]) <= BP_VERTEX_MAX))
                return bp_fault_set(
                    fault, BP_FAULT_CAPSULE, "ends",
                    "found %s, expected coordinates from -1e9 to 1e9; choose a larger unit of length",
                    bp_number_text(capsule->ends[k][a], text));
    if (capsule->radius >= BP_CAPSULE_RADIUS_MIN && capsule->radius <= BP_VERTEX_MAX) return false;
    return bp_fault_set(
        fault, BP_FAULT_CAPSULE, "radius",
        "found %s, expected a radius from 1e-12 to 1e9: only spheres can be turned inside out",
        bp_number_text(capsule->radius, text));
}

bool bp_capsule_material_fault(const BpScene *scene, uint32_t number, BpFault *fault) {
    const BpMaterial *material = &scene->materials[number];
    if (bp_material_emits(material))
        return bp_fault_set(
            fault, BP_FAULT_CAPSULE, "material",
            "found a material that emits, expected another: no rays are sent to capsules; let spheres "
            "or triangles emit");
    return bp_map_without_longitude(scene, material, BP_FAULT_CAPSULE, "capsules", fault);
}

/* Whether a point lies on a capsule's surface, as far as can be told. */
static bool holds_point(const BpCapsule *capsule, const double point[3]) {
    double way[3];
    bp_capsule_way(capsule, point, way);
    const double size =
        bp_length(point) + capsule->radius + sqrt(bp_distance2(capsule->ends[0], capsule->ends[1]));
    return fabs(bp_length(way) - capsule->radius) <= ON_CAMERA * size;
}

/* ---- glass has one surface ---- */

typedef struct Surface {
    double ends[2][3], radius; /* the ends in order */
    size_t capsule;
} Surface;

static int compare_surfaces(const void *a_pointer, const void *b_pointer) {
    const Surface *a = a_pointer, *b = b_pointer;
    for (int k = 0; k < 2; k++) {
        const int order = bp_compare_points(a->ends[k], b->ends[k]);
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
        const bool forward = bp_compare_points(capsule->ends[0], capsule->ends[1]) < 0;
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
        if (bp_capsule_place_fault(capsule, fault) ||
            bp_capsule_material_fault(scene, capsule->material, fault) ||
            bp_interior_fault(scene, scene->sphere_count + scene->triangle_count + i, BP_FAULT_CAPSULE,
                              "capsule", fault))
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
