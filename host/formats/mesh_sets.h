/* mesh_sets.h: meshes that a caller hands over as arrays.
 *
 * In:    sets of arrays.   Out: their triangles and colours, behind all others of a scene.
 * Knows: how arrays lie in memory.   Does not know: who made them. */
#ifndef BP_FORMATS_MESH_SETS_H
#define BP_FORMATS_MESH_SETS_H

#include "material_index.h"

/* Adds the meshes to the scene, whose materials have room for one more. */
BpStatus bp_add_mesh_sets(const BpMaterialIndex *index, const BpShapeSets *shapes, BpScene *scene,
                          BpError *err);

#endif
