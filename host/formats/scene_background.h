/* scene_background.h: what rays see that meet nothing, of a scene document.
 *
 * In:    the nodes of "background", "backdrop", "shadow_catcher" and "lighting".   Out: these parts of a
 * BpScene; ranges are checked by scene_validate.c.   Knows: the grammar.   Does not know: where the camera
 * stands (scene_camera.c). */
#ifndef BP_FORMATS_SCENE_BACKGROUND_H
#define BP_FORMATS_SCENE_BACKGROUND_H

#include "document.h"
#include "scene/scene.h"

/* Reads what rays that hit nothing see; `flags` as in BpSceneChanges. */
BpStatus bp_parse_background(const BpNode *node, unsigned flags, BpScene *scene, BpError *err);
BpStatus bp_parse_backdrop(const BpNode *node, BpScene *scene, BpError *err);
/* After the background, since an image there is refused. */
BpStatus bp_parse_shadow_catcher(const BpNode *node, BpScene *scene, BpError *err);
/* `name`: Optional, stands for the node. After the backdrop, which is white where a light has none. */
BpStatus bp_parse_lighting(const BpNode *root, const char *name, BpScene *scene, BpError *err);

#endif
