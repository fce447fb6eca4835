/* acceleration.c: see acceleration.h. */
#include "acceleration.h"

#include "base/plural.h"

#include <stdio.h>

const char *bp_acceleration_name(BpAcceleration acceleration) {
    return acceleration == BP_ACCELERATION_TREE ? "tree" : "list";
}

BpAcceleration bp_acceleration_choose(const BpScene *scene, char reason[BP_ACCELERATION_REASON_SIZE]) {
    const size_t count = bp_scene_shapes(scene);
    const char *noun = bp_scene_noun(scene);
    char ignored[BP_ACCELERATION_REASON_SIZE];
    char *text = reason != NULL ? reason : ignored;
    if (count > BP_LIST_SPHERES_MAX) {
        snprintf(text, BP_ACCELERATION_REASON_SIZE, "%zu %ss, more than %u: a tree", count, noun,
                 BP_LIST_SPHERES_MAX);
        return BP_ACCELERATION_TREE;
    }
    if (count == 0)
        snprintf(text, BP_ACCELERATION_REASON_SIZE, "no spheres: the picture is the sky");
    else
        snprintf(text, BP_ACCELERATION_REASON_SIZE, "%zu %s%s: a list, no tree", count, noun,
                 bp_plural(count));
    return BP_ACCELERATION_LIST;
}
