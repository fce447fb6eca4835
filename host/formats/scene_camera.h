/* scene_camera.h: the camera object of a scene document.
 *
 * In:    its node.   Out: a BpCamera; ranges that need no other member are checked by scene_validate.c.
 * Knows: the names and defaults of the book's fourth-edition camera. */
#ifndef BP_FORMATS_SCENE_CAMERA_H
#define BP_FORMATS_SCENE_CAMERA_H

#include "document.h"
#include "scene/scene.h"

BpStatus bp_parse_camera(const BpNode *node, BpCamera *camera, BpError *err);

#endif
