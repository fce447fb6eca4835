/* scene_side.c: see scene_side.h. */
#include "scene_side.h"
#include "vector.h"

#include <math.h>

BpSide bp_sphere_side(const BpSphere *sphere, const double point[3]) {
    double offset[3];
    for (int a = 0; a < 3; ++a) offset[a] = sphere->center[a] - point[a];
    const double radius = fabs(sphere->radius), distance = bp_length(offset);
    const double rounding = 0x1p-50 * (bp_length(point) + bp_length(sphere->center) + radius);
    if (fabs(distance - radius) <= rounding) return BP_SIDE_ON;
    return distance < radius ? BP_SIDE_INSIDE : BP_SIDE_OUTSIDE;
}
