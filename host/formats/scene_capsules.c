/* scene_capsules.c: see scene_capsules.h. */
#include "scene_capsules.h"

#include <stdlib.h>

/* What spheres have and capsules do not, by name. */
static BpStatus refuse_others(const BpNode *node, BpError *err) {
    static const struct {
        const char *name, *advice;
    } others[] = {{"center_end", "capsules stand still while the shutter is open; remove it"},
                  {"ends_end", "capsules stand still while the shutter is open; remove it"},
                  {"interior", "capsules surround no media; use a sphere as the boundary"},
                  {"center", "a capsule has two ends; write \"ends\": [[0, 0, 0], [0, 1, 0]]"},
                  {"height", "a capsule is as long as its ends are apart; remove it"}};
    for (size_t i = 0; i < BP_COUNT(others); i++) {
        const BpNode other = bp_node_member(node, others[i].name);
        if (other.value != NULL)
            return bp_node_fail(&other, BP_PART_NAME, err, "unknown member; %s", others[i].advice);
    }
    return BP_OK;
}

static BpStatus parse_capsule(const BpNode *node, const BpMaterialIndex *index, BpCapsule *capsule,
                              BpError *err) {
    static const char *const names[] = {"ends", "radius", "material"};
    static const char expected[] = "two points: \"ends\": [[0, 0, 0], [0, 1, 0]]";
    BP_TRY(refuse_others(node, err));
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(node, "ends", expected, err));
    BP_TRY(bp_node_require(node, "radius", "a number such as \"radius\": 0.1", err));
    BP_TRY(bp_node_require(node, "material", "a name from \"materials\"", err));
    const BpNode ends = bp_node_member(node, "ends"), radius = bp_node_member(node, "radius"),
                 material = bp_node_member(node, "material");
    if (!json_is_array(ends.value) || json_array_size(ends.value) != 2)
        return bp_node_wrong(&ends, expected, err);
    for (size_t k = 0; k < 2; k++) {
        const BpNode end = bp_node_element(&ends, k);
        BP_TRY(bp_node_vector(&end, capsule->ends[k], err));
        capsule->albedo[k] = BP_NO_ALBEDO;
    }
    BP_TRY(bp_node_number(&radius, &capsule->radius, err));
    return bp_parse_material_name(&material, index, &capsule->material, err);
}

BpStatus bp_parse_capsules(const BpNode *node, const BpMaterialIndex *index, BpScene *scene, BpError *err) {
    BP_TRY(bp_node_list(
        node,
        "a list of capsules: [ { \"ends\": [[0, 0, 0], [0, 1, 0]], \"radius\": 0.1, \"material\": ... } ]",
        err));
    const size_t count = json_array_size(node->value);
    if (count == 0) return BP_OK;
    if (count > BP_SPHERES_MAX)
        return bp_node_fail(node, BP_PART_VALUE, err, "found %zu capsules, expected at most %u", count,
                            BP_SPHERES_MAX);
    scene->capsules = malloc(count * sizeof *scene->capsules);
    if (scene->capsules == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu capsules", count);
    for (size_t i = 0; i < count; i++) {
        const BpNode element = bp_node_element(node, i);
        if (!json_is_object(element.value))
            return bp_node_wrong(&element, "an object: { \"ends\": ..., \"radius\": ..., \"material\": ... }",
                                 err);
        BP_TRY(parse_capsule(&element, index, &scene->capsules[i], err));
        scene->capsule_count = scene->listed_capsules = i + 1;
    }
    return BP_OK;
}
