/* shadow_catcher.h: where the shadow catcher of a scene lies.
 *
 * In:    a scene with all its spheres.   Out: the plane's normal and distance.
 * Knows: which way is up.   Does not know: what light falls on it. */
#ifndef BP_SCENE_SHADOW_CATCHER_H
#define BP_SCENE_SHADOW_CATCHER_H

#include "scene.h"

/* Where the document does not give it: up is that of the particles, or without any that of the background;
 * and the plane touches the lowest of the particles, or without any of all spheres, wherever it moves. */
void bp_shadow_catcher_place(BpScene *scene);

#endif
