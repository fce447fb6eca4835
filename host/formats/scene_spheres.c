/* scene_spheres.c: see scene_spheres.h. */
#include "scene_spheres.h"

#include "scene_medium.h"

#include <stdlib.h>
#include <string.h>

static BpStatus parse_sphere(const BpNode *node, const BpMaterialIndex *index, BpSphere *sphere,
                             BpError *err) {
    static const char *const names[] = {"center", "radius", "material", "center_end", "interior"};
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(node, "center", "\"center\": [x, y, z]", err));
    BP_TRY(bp_node_require(node, "radius", "a number such as \"radius\": 0.5", err));
    BP_TRY(bp_node_require(node, "material", "a name from \"materials\"", err));
    const BpNode center = bp_node_member(node, "center");
    const BpNode radius = bp_node_member(node, "radius");
    const BpNode material = bp_node_member(node, "material");
    BP_TRY(bp_node_vector(&center, sphere->center, err));
    BP_TRY(bp_node_number(&radius, &sphere->radius, err));
    sphere->albedo = BP_NO_ALBEDO;
    return bp_parse_material_name(&material, index, &sphere->material, err);
}

/* Where the sphere `index`, of `count` that are listed, is when the shutter closes. */
static BpStatus parse_motion(const BpNode *node, size_t index, size_t count, BpScene *scene, BpError *err) {
    const BpNode end = bp_node_member(node, "center_end");
    if (end.value == NULL && scene->center_ends == NULL) return BP_OK;
    if (scene->center_ends == NULL) {
        scene->center_ends = malloc(count * sizeof *scene->center_ends);
        if (scene->center_ends == NULL)
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu motions", count);
        for (size_t i = 0; i < index; i++)
            memcpy(scene->center_ends[i], scene->spheres[i].center, sizeof scene->center_ends[i]);
    }
    memcpy(scene->center_ends[index], scene->spheres[index].center, sizeof scene->center_ends[index]);
    return bp_node_vector(&end, scene->center_ends[index], err);
}

BpStatus bp_parse_spheres(const BpNode *node, const BpMaterialIndex *index, BpScene *scene, BpError *err) {
    BP_TRY(bp_node_list(
        node, "a list of spheres: [ { \"center\": [0, 0, -1], \"radius\": 0.5, \"material\": ... } ]", err));
    const size_t count = json_array_size(node->value);
    if (count == 0) return BP_OK;
    if (count > BP_SPHERES_MAX)
        return bp_node_fail(node, BP_PART_VALUE, err, "found %zu spheres, expected at most %u", count,
                            BP_SPHERES_MAX);
    scene->spheres = malloc(count * sizeof *scene->spheres);
    if (scene->spheres == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu spheres", count);
    for (size_t i = 0; i < count; i++) {
        const BpNode element = bp_node_element(node, i);
        if (!json_is_object(element.value))
            return bp_node_wrong(&element,
                                 "an object: { \"center\": ..., \"radius\": ..., \"material\": ... }", err);
        BP_TRY(parse_sphere(&element, index, &scene->spheres[i], err));
        BP_TRY(parse_motion(&element, i, count, scene, err));
        BP_TRY(bp_parse_interior(&element, scene, i, count, &scene->interiors, &scene->interior_count, err));
    }
    scene->sphere_count = count;
    if (scene->center_ends != NULL) scene->moving_count = count;
    return BP_OK;
}
