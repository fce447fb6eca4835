/* load_scene.h: a scene of the repository at another width.
 *
 * In:    its path in the repository, a width.   Out: the scene; a failed test where it cannot be had.
 * Knows: where the repository is.   Does not know: what is tested. */
#ifndef TESTS_SUPPORT_LOAD_SCENE_H
#define TESTS_SUPPORT_LOAD_SCENE_H

#include "scene/scene.h"
#include "support/unit_test.h"

#include <stdio.h>

/* The caller destroys it. */
static inline BpScene *load_scene(const char *name, uint32_t width) {
    char path[1024];
    BpScene *scene = NULL;
    BpError err = {0};
    snprintf(path, sizeof path, "%s/%s", SOURCE_DIR, name);
    if (bp_scene_load(path, &scene, &err) != BP_OK || bp_scene_set_width(scene, width, &err) != BP_OK)
        fail_msg("%s", err.message);
    return scene;
}

#endif
