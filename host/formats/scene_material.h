/* scene_material.h: one material of a scene document.
 *
 * In:    its node, the scene's textures.   Out: a BpMaterial.
 * Knows: the lists of material.h, and how a document has them. Ranges are checked by scene_validate.c. */
#ifndef BP_FORMATS_SCENE_MATERIAL_H
#define BP_FORMATS_SCENE_MATERIAL_H

#include "document.h"
#include "scene/scene.h"

/* `material` is zeroed; its name is the caller's to set. The scene has its textures. */
BpStatus bp_parse_material(const BpNode *node, const BpScene *scene, BpMaterial *material, BpError *err);

#endif
