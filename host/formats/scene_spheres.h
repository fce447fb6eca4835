/* scene_spheres.h: the spheres that a scene document lists.
 *
 * In:    the node of "spheres".   Out: spheres, their motions and interiors; ranges are checked by
 * scene_validate.c. Knows: the members of a sphere.   Does not know: what comes from files and arrays
 * (scene_points.h, scene_sets.h). */
#ifndef BP_FORMATS_SCENE_SPHERES_H
#define BP_FORMATS_SCENE_SPHERES_H

#include "material_index.h"

/* Into the scene, which has its media and no spheres yet. */
BpStatus bp_parse_spheres(const BpNode *node, const BpMaterialIndex *index, BpScene *scene, BpError *err);

#endif
