/* scene_meshes.h: the meshes that a scene document names.
 *
 * In:    the node "meshes".   Out: their triangles, after those that stand in the document itself.
 * Knows: the grammar of "meshes".   Does not know: how files are read, devices. */
#ifndef BP_FORMATS_SCENE_MESHES_H
#define BP_FORMATS_SCENE_MESHES_H

#include "material_index.h"
#include "scene_changes.h"

BpStatus bp_parse_meshes(const BpNode *node, const BpMaterialIndex *index, const BpSceneChanges *changes,
                         BpScene *scene, BpError *err);

#endif
