/* scene_capsules.h: the capsules that a scene document lists.
 *
 * In:    the node of "capsules".   Out: capsules.
 * Knows: their members.   Does not know: which capsules a scene may have (scene/capsule_rules.c). */
#ifndef BP_FORMATS_SCENE_CAPSULES_H
#define BP_FORMATS_SCENE_CAPSULES_H

#include "material_index.h"

/* Into the scene, which has no capsules yet. */
BpStatus bp_parse_capsules(const BpNode *node, const BpMaterialIndex *index, BpScene *scene, BpError *err);

#endif
