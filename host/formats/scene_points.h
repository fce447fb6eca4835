/* scene_points.h: the clouds of a scene document.
 *
 * In:    the node of "clouds".   Out: the points of the files that it names, as spheres.
 * Knows: the members of a cloud, where relative paths begin. Does not know: how PLY files are read (ply.c).
 */
#ifndef BP_FORMATS_SCENE_POINTS_H
#define BP_FORMATS_SCENE_POINTS_H

#include "material_index.h"
#include "scene_changes.h"

/* Adds the points of the clouds' files to the scene's spheres; `flags` as in BpSceneChanges. */
BpStatus bp_parse_clouds(const BpNode *node, const BpMaterialIndex *index, unsigned flags, BpScene *scene,
                         BpError *err);

#endif
