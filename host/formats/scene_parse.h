/* scene_parse.h: from the root of a scene document to a BpScene.
 *
 * In:    the root, changes.   Out: a scene that obeys the rules.
 * Knows: the grammar's top level. The rest is in a file for each member (scene_camera.h, scene_spheres.h,
 * ...). Does not know: effects, packed data, devices. */
#ifndef BP_FORMATS_SCENE_PARSE_H
#define BP_FORMATS_SCENE_PARSE_H

#include "scene_changes.h"

/* Into `scene`, which is empty. */
BpStatus bp_parse_scene(const BpNode *root, const BpSceneChanges *changes, BpScene *scene, BpError *err);

#endif
