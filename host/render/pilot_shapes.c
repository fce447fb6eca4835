/* pilot_shapes.c: see pilot_shapes.h. */
#include "pilot_shapes.h"

#include "scene/capsule_way.h"
#include "scene/triangle_area.h"

#include <math.h>
#include <string.h>

double bp_pilot_area(const BpTriangle *triangle, double normal[3]) {
    bp_triangle_area(triangle, normal);
    return 0.5 * bp_normalize(normal);
}

static double ball_of_triangle(const BpTriangle *triangle, double center[3]) {
    double radius2 = 0;
    for (int a = 0; a < 3; ++a)
        center[a] = (triangle->vertices[0][a] + triangle->vertices[1][a] + triangle->vertices[2][a]) / 3;
    for (int v = 0; v < 3; ++v) radius2 = fmax(radius2, bp_distance2(center, triangle->vertices[v]));
    return sqrt(radius2);
}

double bp_pilot_ball(const BpScene *scene, size_t shape, double center[3]) {
    const BpTriangle *const triangle = bp_pilot_triangle(scene, shape);
    if (triangle != NULL) return ball_of_triangle(triangle, center);
    const BpCapsule *const capsule = bp_shape_capsule(scene, shape);
    if (capsule != NULL) {
        for (int a = 0; a < 3; ++a) center[a] = 0.5 * (capsule->ends[0][a] + capsule->ends[1][a]);
        return capsule->radius + 0.5 * sqrt(bp_distance2(capsule->ends[0], capsule->ends[1]));
    }
    const double *from = scene->spheres[shape].center, *to = bp_sphere_end(scene, shape);
    double way = 0;
    for (int a = 0; a < 3; ++a) {
        center[a] = 0.5 * (from[a] + to[a]);
        way += (to[a] - from[a]) * (to[a] - from[a]);
    }
    return fabs(scene->spheres[shape].radius) + 0.5 * sqrt(way);
}

void bp_pilot_outward(const BpScene *scene, size_t shape, const double point[3], double time,
                      double normal[3]) {
    const BpTriangle *const triangle = bp_pilot_triangle(scene, shape);
    if (triangle != NULL) {
        bp_pilot_area(triangle, normal);
        return;
    }
    const BpCapsule *const capsule = bp_shape_capsule(scene, shape);
    if (capsule != NULL) {
        bp_capsule_way(capsule, point, normal);
        bp_normalize(normal);
        return;
    }
    const double *from = scene->spheres[shape].center, *to = bp_sphere_end(scene, shape);
    for (int a = 0; a < 3; ++a) normal[a] = point[a] - (from[a] + time * (to[a] - from[a]));
    bp_normalize(normal);
}

double bp_pilot_index_inside(const BpScene *scene, size_t shape) {
    const double index = bp_pilot_material(scene, shape)->refraction_index;
    const bool bubble = bp_pilot_is_sphere(scene, shape) && scene->spheres[shape].radius < 0;
    return bubble ? 1 / index : index;
}

bool bp_pilot_is_specular(const BpScene *scene, size_t shape) {
    const BpMaterial *const material = bp_pilot_material(scene, shape);
    return material->kind != BP_MATERIAL_INTERFACE &&
           (bp_material_types[material->kind].traits & BP_SCATTERS) != 0 && !bp_material_is_lit(material);
}

double bp_pilot_lobe_width(const BpMaterial *material) {
    double width = 0;
    if (!bp_material_is_lit(material)) return 0;
    if (material->kind == BP_MATERIAL_METAL) width = material->fuzz;
    if (material->kind == BP_MATERIAL_ROUGH_METAL || material->kind == BP_MATERIAL_ROUGH_DIELECTRIC)
        width = 2 * material->roughness * material->roughness;
    if (material->kind == BP_MATERIAL_GLOSSY)
        width = 2 * pow(fmax(material->roughness, BP_LIT_ROUGHNESS_MIN), 2);
    return width < BP_PILOT_NARROW ? width : 0;
}
