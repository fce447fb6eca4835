/* shadow_catcher.c: see shadow_catcher.h. */
#include "shadow_catcher.h"
#include "vector.h"

#include <math.h>
#include <string.h>

/* Where particles stand on the plane, those of them that are meshes do so too, and meshes that a caller
 * handed over beside them. */
static size_t first_triangle(const BpScene *scene) {
    size_t mesh = 0;
    if (!scene->has_particles) return 0;
    while (mesh < scene->mesh_file_count && !scene->mesh_files[mesh].in_memory &&
           !scene->mesh_files[mesh].of_particles)
        mesh++;
    return mesh < scene->mesh_file_count ? scene->mesh_files[mesh].first : scene->triangle_count;
}

void bp_shadow_catcher_place(BpScene *scene) {
    BpShadowCatcher *const catcher = &scene->shadow_catcher;
    double *const normal = catcher->normal;
    if (!catcher->present) return;
    memcpy(normal, catcher->up, sizeof catcher->up);
    if (bp_dot(normal, normal) == 0 && !scene->has_particles && scene->lighting == BP_LIGHTING_SKY)
        bp_background_up(scene, normal);
    else if (bp_dot(normal, normal) == 0)
        normal[scene->has_particles ? scene->up : 1] = 1;
    const double length = sqrt(bp_dot(normal, normal));
    for (int c = 0; c < 3; c++) normal[c] /= length;
    catcher->distance = catcher->height;
    if (catcher->has_height) return;
    double lowest = INFINITY;
    for (size_t i = scene->has_particles ? scene->particle_first : 0; i < scene->sphere_count; i++) {
        const BpSphere *const sphere = &scene->spheres[i];
        double middle = bp_dot(normal, sphere->center);
        if (bp_sphere_moves(scene, i)) middle = fmin(middle, bp_dot(normal, bp_sphere_end(scene, i)));
        lowest = fmin(lowest, middle - fabs(sphere->radius));
    }
    for (size_t i = first_triangle(scene); i < scene->triangle_count; i++)
        for (int k = 0; k < 3; k++) lowest = fmin(lowest, bp_dot(normal, scene->triangles[i].vertices[k]));
    for (size_t i = scene->has_particles ? scene->listed_capsules : 0; i < scene->capsule_count; i++)
        for (int k = 0; k < 2; k++)
            lowest = fmin(lowest, bp_dot(normal, scene->capsules[i].ends[k]) - scene->capsules[i].radius);
    catcher->distance = isfinite(lowest) ? lowest : 0;
}
