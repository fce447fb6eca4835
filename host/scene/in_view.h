/* in_view.h: whether any sphere can be in the picture.
 *
 * In:    a scene.   Out: whether nothing is before its camera.
 * Knows: the camera's field of view.   Does not know: pictures, what hides what. */
#ifndef BP_SCENE_IN_VIEW_H
#define BP_SCENE_IN_VIEW_H

#include "scene.h"

/* Whether some sphere reaches into the field of view, judged by planes along its edges and a cone around it:
 * false is certain. */
bool bp_scene_has_shape_in_view(const BpScene *scene);

/* Whether paths continue from every material of the scene, sooner or later: then a picture of which every
 * path ended at once shows no sphere. */
bool bp_scene_always_scatters(const BpScene *scene);

#endif
