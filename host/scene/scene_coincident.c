/* scene_coincident.c: dielectrics that share one surface, where no order of inside and outside is defined.
 *
 * In:    a scene whose spheres are in order.   Out: the first such pair.
 * Knows: that the kernel sees centres relative to the camera and in float. Overlapping and concentric spheres
 * are no fault. */
#include "material.h"
#include "scene_fault.h"

#include <math.h>
#include <stdlib.h>

#define SAME_RADIUS 1.0e-12 /* relative */

typedef struct Shell {
    float center[6]; /* when the shutter opens and when it closes, relative to where the camera stands */
    double radius;   /* without its sign */
    size_t sphere;
} Shell;

static int compare_shells(const void *a_pointer, const void *b_pointer) {
    const Shell *a = a_pointer, *b = b_pointer;
    for (int i = 0; i < 6; i++) {
        if (a->center[i] != b->center[i]) return a->center[i] < b->center[i] ? -1 : 1;
    }
    if (a->radius != b->radius) return a->radius < b->radius ? -1 : 1;
    return a->sphere < b->sphere ? -1 : a->sphere > b->sphere;
}

static bool same_surface(const Shell *a, const Shell *b) {
    for (int i = 0; i < 6; i++) {
        if (a->center[i] != b->center[i]) return false;
    }
    return (float)a->radius == (float)b->radius || b->radius - a->radius <= SAME_RADIUS * b->radius;
}

BpStatus bp_scene_find_coincident(const BpScene *scene, BpFault *fault, BpError *err) {
    size_t count = 0;
    for (size_t i = 0; i < scene->sphere_count; i++)
        count += bp_material_is(scene->materials[scene->spheres[i].material].kind, BP_HAS_INSIDE);
    if (count < 2) return BP_OK;
    Shell *shells = malloc(count * sizeof *shells);
    double origin[3];
    bp_camera_origin(scene, origin);
    if (shells == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory while comparing %zu dielectrics", count);
    count = 0;
    for (size_t i = 0; i < scene->sphere_count; i++) {
        const BpSphere *sphere = &scene->spheres[i];
        if (!bp_material_is(scene->materials[sphere->material].kind, BP_HAS_INSIDE)) continue;
        Shell *shell = &shells[count++];
        for (int k = 0; k < 3; k++) shell->center[k] = (float)(sphere->center[k] - origin[k]);
        for (int k = 0; k < 3; k++) shell->center[3 + k] = (float)(bp_sphere_end(scene, i)[k] - origin[k]);
        shell->radius = fabs(sphere->radius);
        shell->sphere = i;
    }
    qsort(shells, count, sizeof *shells, compare_shells);
    for (size_t i = 1; i < count; i++) {
        if (!same_surface(&shells[i - 1], &shells[i])) continue;
        const size_t a = shells[i - 1].sphere, b = shells[i].sphere;
        fault->index = a > b ? a : b;
        fault->other = a > b ? b : a;
        bp_fault_set(fault, BP_FAULT_COINCIDENT, "",
                     "found the same centre and radius (in float, seen from the camera) for two dielectrics, "
                     "expected separate surfaces: remove one, or make one of them slightly smaller");
        break;
    }
    free(shells);
    return BP_OK;
}
