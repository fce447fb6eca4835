/* acceleration.c: see acceleration.h. */
#include "acceleration.h"

#include "base/plural.h"

#include <stdio.h>

const char *bp_acceleration_name(BpAcceleration acceleration) {
    return acceleration == BP_ACCELERATION_TREE ? "tree" : "list";
}

BpAcceleration bp_acceleration_choose(const BpScene *scene, char reason[BP_ACCELERATION_REASON_SIZE]) {
    const size_t count = scene->sphere_count;
    char ignored[BP_ACCELERATION_REASON_SIZE];
    char *text = reason != NULL ? reason : ignored;
    if (count > BP_LIST_SPHERES_MAX) {
        snprintf(text, BP_ACCELERATION_REASON_SIZE, "%zu spheres, more than %u: a tree", count,
                 BP_LIST_SPHERES_MAX);
        return BP_ACCELERATION_TREE;
    }
    if (count == 0)
        snprintf(text, BP_ACCELERATION_REASON_SIZE, "no spheres: the picture is the sky");
    else
        snprintf(text, BP_ACCELERATION_REASON_SIZE, "%zu sphere%s: a list, no tree", count, bp_plural(count));
    return BP_ACCELERATION_LIST;
}
