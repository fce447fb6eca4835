/* scene_sets.h: spheres that a caller hands over as arrays.
 *
 * In:    sets of arrays.   Out: their spheres and colours, behind all others of a scene.
 * Knows: how arrays lie in memory.   Does not know: who made them. */
#ifndef BP_FORMATS_SCENE_SETS_H
#define BP_FORMATS_SCENE_SETS_H

#include "material_index.h"

/* Adds the sets of spheres to the scene, whose materials have room for one more. */
BpStatus bp_add_sphere_sets(const BpMaterialIndex *index, const BpShapeSets *shapes, BpScene *scene,
                            BpError *err);

#endif
