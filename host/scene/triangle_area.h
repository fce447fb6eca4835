/* triangle_area.h: the plane of a triangle.
 *
 * In:    a triangle.   Out: its normal, its longest side.
 * Does not know: effects, devices. */
#ifndef BP_SCENE_TRIANGLE_AREA_H
#define BP_SCENE_TRIANGLE_AREA_H

#include "scene.h"
#include "vector.h"

#include <math.h>

/* Twice the area, along the outward normal; returns the longest side. */
static inline double bp_triangle_area(const BpTriangle *triangle, double area[3]) {
    double b[3], c[3], d[3];
    bp_way(triangle->vertices[0], triangle->vertices[1], b);
    bp_way(triangle->vertices[0], triangle->vertices[2], c);
    bp_way(triangle->vertices[1], triangle->vertices[2], d);
    bp_cross(b, c, area);
    return fmax(fmax(bp_length(b), bp_length(c)), bp_length(d));
}

#endif
