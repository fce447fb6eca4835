/* lighting.h: lighting by name, which stands in the camera's frame: it moves along as the camera does.
 *
 * In:    a scene with a lighting and a camera.   Out: its background.
 * Knows: the arrangements.   Does not know: where the names are written. */
#ifndef BP_SCENE_LIGHTING_H
#define BP_SCENE_LIGHTING_H

#include "scene.h"

/* "sky" for BP_LIGHTING_SKY, "soft", "studio", ... */
extern const char *const bp_lighting_names[BP_LIGHTING_COUNT];

/* Makes the scene's background from its lighting and where its camera stands now; leaves it as it is with
 * BP_LIGHTING_SKY. */
void bp_lighting_place(BpScene *scene);

#endif
