/* pilot_shapes.h: what a pilot asks of a scene's shapes, be they spheres, triangles or capsules.
 *
 * In:    a shape, as the scene counts them: spheres first, then triangles, then capsules, which do not emit.
 * Out:   its material, its normal, a ball around it.
 * Knows: geometry, which materials scatter into few directions.   Does not know: how paths are traced. */
#ifndef BP_RENDER_PILOT_SHAPES_H
#define BP_RENDER_PILOT_SHAPES_H

#include "scene/scene.h"

static inline bool bp_pilot_is_sphere(const BpScene *scene, size_t shape) {
    return shape < scene->sphere_count;
}
static inline bool bp_pilot_is_triangle(const BpScene *scene, size_t shape) {
    return !bp_pilot_is_sphere(scene, shape) && bp_shape_capsule(scene, shape) == NULL;
}
/* NULL: it is another shape. */
static inline const BpTriangle *bp_pilot_triangle(const BpScene *scene, size_t shape) {
    return bp_pilot_is_triangle(scene, shape) ? &scene->triangles[shape - scene->sphere_count] : NULL;
}

static inline const BpMaterial *bp_pilot_material(const BpScene *scene, size_t shape) {
    return &scene->materials[bp_shape_material(scene, shape)];
}

/* The area of a triangle; `normal` gets its unit normal, on the side from which it is counter-clockwise. */
double bp_pilot_area(const BpTriangle *triangle, double normal[3]);

/* The ball that a shape fills while the shutter is open; returns its radius. */
double bp_pilot_ball(const BpScene *scene, size_t shape, double center[3]);

/* The unit normal at a point of the shape, outward. `time`: 0 where the shutter opens, 1 where it closes. */
void bp_pilot_outward(const BpScene *scene, size_t shape, const double point[3], double time,
                      double normal[3]);

/* The refraction index of what lies on the side away from that normal; for materials of glass. */
double bp_pilot_index_inside(const BpScene *scene, size_t shape);

/* The shape scatters into few directions only, so that no ray to a lamp lights it. */
bool bp_pilot_is_specular(const BpScene *scene, size_t shape);

/* Lobes of this half angle, in radians, and more send light to so many places that samples soon find it; and
 * so does any lobe with the light of lights that fill more than BP_PILOT_SMALL. */
#define BP_PILOT_NARROW 0.75
#define BP_PILOT_SMALL 0.125

/* About the half angle, in radians, into which a material sends most of what it reflects, if rays to lamps
 * light it; 0: it has no such lobe, or it is BP_PILOT_NARROW or wider. */
double bp_pilot_lobe_width(const BpMaterial *material);

/* Whose points count as neighbours: a sphere is its own, and all other shapes are one. */
static inline uint32_t bp_pilot_object(const BpScene *scene, uint32_t shape) {
    return bp_pilot_is_sphere(scene, shape) ? shape : (uint32_t)scene->sphere_count;
}

/* By way of what light comes, as a place in a table: each sphere, then nothing at all, then the other shapes
 * of each material. */
static inline size_t bp_pilot_ways(const BpScene *scene) {
    return scene->sphere_count + 1 + scene->material_count;
}
static inline size_t bp_pilot_way_direct(const BpScene *scene) {
    return scene->sphere_count;
}
static inline size_t bp_pilot_way(const BpScene *scene, size_t shape) {
    return bp_pilot_is_sphere(scene, shape) ? shape
                                            : scene->sphere_count + 1 + bp_shape_material(scene, shape);
}

#endif
