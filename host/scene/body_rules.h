/* body_rules.h: what the bodies of triangles that surround media may not be.
 *
 * In:    a scene whose triangles and camera are in order.   Out: the first fault.
 * Knows: that a path has a bit for each body, and that all paths begin with the same ones.   Does not know:
 * where the scene was read from. */
#ifndef BP_SCENE_BODY_RULES_H
#define BP_SCENE_BODY_RULES_H

#include "scene_fault.h"

/* There are BP_BODIES_MAX at most, and the camera's lens, or the plane of an orthographic one, lies inside or
 * outside each. BP_ERR_MEMORY. */
BpStatus bp_scene_find_body_fault(const BpScene *scene, BpFault *fault, BpError *err);

#endif
