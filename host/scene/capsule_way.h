/* capsule_way.h: where a point lies from a capsule's axis.
 *
 * In:    a capsule, a point.   Out: the way to it from the point of the axis that is closest.
 * Does not know: effects, devices. */
#ifndef BP_SCENE_CAPSULE_WAY_H
#define BP_SCENE_CAPSULE_WAY_H

#include "scene.h"
#include "vector.h"

#include <math.h>

static inline void bp_capsule_way(const BpCapsule *capsule, const double point[3], double way[3]) {
    double axis[3];
    bp_way(capsule->ends[0], capsule->ends[1], axis);
    bp_way(capsule->ends[0], point, way);
    const double square = bp_dot(axis, axis);
    const double place = square > 0 ? fmin(1, fmax(0, bp_dot(way, axis) / square)) : 0;
    for (int a = 0; a < 3; a++) way[a] -= place * axis[a];
}

#endif
