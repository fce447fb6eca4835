/* scene_side.h: on which side of a sphere's surface a point lies.
 *
 * In:    a sphere, a point, in the scene's own doubles.   Out: inside, on the surface, outside.
 * Knows: how the numbers were rounded.                    Does not know: what the answer is for.
 *
 * A camera that stands on a sphere is a camera that leaves it: the sphere is met at the far end of its chord
 * by rays that go in, and not at all by rays that go out. The book's program, with its least distance, does
 * the same. */
#ifndef BP_SCENE_SCENE_SIDE_H
#define BP_SCENE_SCENE_SIDE_H

#include "scene.h"

typedef enum BpSide { BP_SIDE_INSIDE, BP_SIDE_ON, BP_SIDE_OUTSIDE } BpSide;

/* BP_SIDE_ON: the distance to the centre is the radius, within 2^-50 of |point| + |centre| + |radius|, which
 * covers the rounding of these numbers when they were read (2^-53 of each) and that of the difference. */
BpSide bp_sphere_side(const BpSphere *sphere, const double point[3]);

#endif
