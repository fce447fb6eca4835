/* light.h: light by name, which stands in the camera's frame: it moves along as the camera does.
 *
 * In:    a scene with a light and a camera.   Out: its background.
 * Knows: the arrangements.   Does not know: where the names are written. */
#ifndef BP_SCENE_LIGHT_H
#define BP_SCENE_LIGHT_H

#include "scene.h"

/* "sky" for BP_LIGHT_SKY, "soft", "studio", ... */
extern const char *const bp_light_names[BP_LIGHT_COUNT];

/* Makes the scene's background from its light and where its camera stands now; leaves it as it is with
 * BP_LIGHT_SKY. */
void bp_light_place(BpScene *scene);

#endif
