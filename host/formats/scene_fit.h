/* scene_fit.h: the camera of a scene document, put where it sees what it is fitted to.
 *
 * In:    a scene that has its spheres.   Out: where its camera stands, and where it looks.
 * Knows: "fit", "view", turntables.   Does not know: how a camera is fitted to spheres (scene/fit.h). */
#ifndef BP_FORMATS_SCENE_FIT_H
#define BP_FORMATS_SCENE_FIT_H

#include "scene_changes.h"

/* The direction to the camera that "view" means, and the axis that is up, in camera->vup. */
void bp_scene_view(BpScene *scene, double direction[3]);

/* What the camera is fitted to: spheres of the scene, or in *made, which the caller frees. BP_ERR_MEMORY. */
BpStatus bp_scene_fitted(const BpScene *scene, const BpSphere **balls, size_t *count, BpSphere **made,
                         BpError *err);

/* Places the camera as `changes`, or else the "fit" of the node, the "camera", has it. BP_ERR_SCENE where
 * there is nothing to fit it to. */
BpStatus bp_scene_fit_camera(const BpNode *node, const BpSceneChanges *changes, BpScene *scene, BpError *err);

#endif
