/* triangle_rules.h: what a scene's triangles may not be.
 *
 * In:    a scene whose materials, textures and media are in order.   Out: the first fault.
 * Knows: what the kernels cannot do with triangles yet.   Does not know: where the scene was read from. */
#ifndef BP_SCENE_TRIANGLE_RULES_H
#define BP_SCENE_TRIANGLE_RULES_H

#include "scene_fault.h"

/* Whether it is one: neither without an area nor too small. */
bool bp_triangle_has_area(const BpTriangle *triangle);

/* Vertices are finite and near enough, areas are not 0, and materials are ones that triangles may have; glass
 * is closed, and no other triangle lies on it; no pinhole camera stands on one. BP_ERR_MEMORY. */
BpStatus bp_scene_find_triangle_fault(const BpScene *scene, BpFault *fault, BpError *err);

#endif
