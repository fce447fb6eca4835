/* capsule_rules.h: what a scene's capsules may not be.
 *
 * In:    a scene whose materials, textures and media are in order.   Out: the first fault.
 * Knows: what the kernels cannot do with capsules.   Does not know: where the scene was read from. */
#ifndef BP_SCENE_CAPSULE_RULES_H
#define BP_SCENE_CAPSULE_RULES_H

#include "scene_fault.h"

/* Ends are finite and near enough, radii above 0, and materials are ones that capsules may have: they neither
 * emit. No two of glass are the same, and no pinhole camera stands on one.
 * BP_ERR_MEMORY. */
BpStatus bp_scene_find_capsule_fault(const BpScene *scene, BpFault *fault, BpError *err);

/* Whether the ends and the radius of one are not as said above. */
bool bp_capsule_place_fault(const BpCapsule *capsule, BpFault *fault);

/* Whether capsules may not have this material. */
bool bp_capsule_material_fault(const BpScene *scene, uint32_t material, BpFault *fault);

#endif
