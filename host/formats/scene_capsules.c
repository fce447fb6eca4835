/* scene_capsules.c: see scene_capsules.h. */
#include "scene_capsules.h"

#include "scene/material.h"
#include "scene_medium.h"

#include <stdlib.h>

/* What spheres have and capsules do not, by name. */
static BpStatus refuse_others(const BpNode *node, BpError *err) {
    static const struct {
        const char *name, *advice;
    } others[] = {{"center_end", "capsules stand still while the shutter is open; remove it"},
                  {"ends_end", "capsules stand still while the shutter is open; remove it"},
                  {"center", "a capsule has two ends; write \"ends\": [[0, 0, 0], [0, 1, 0]]"},
                  {"color", "a capsule has two halves; write \"colors\": [[0.8, 0.1, 0.1], [0.1, 0.1, 0.8]]"},
                  {"height", "a capsule is as long as its ends are apart; remove it"}};
    for (size_t i = 0; i < BP_COUNT(others); i++) {
        const BpNode other = bp_node_member(node, others[i].name);
        if (other.value != NULL)
            return bp_node_fail(&other, BP_PART_NAME, err, "unknown member; %s", others[i].advice);
    }
    return BP_OK;
}

/* Room for the capsules, and for the colours of those that have them. */
static BpStatus make_room(const BpNode *node, size_t count, BpScene *scene, BpError *err) {
    size_t colors = scene->albedo_count;
    for (size_t i = 0; i < count; i++)
        if (json_object_get(json_array_get(node->value, i), "colors") != NULL) colors += 2;
    scene->capsules = malloc(count * sizeof *scene->capsules);
    float(*const albedos)[3] = realloc(scene->albedos, (colors + 1) * sizeof *albedos);
    if (albedos != NULL) scene->albedos = albedos;
    if (scene->capsules == NULL || albedos == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu capsules", count);
    return BP_OK;
}

/* Those of its halves, in place of its material's albedo. */
static BpStatus parse_colors(const BpNode *node, BpScene *scene, BpCapsule *capsule, BpError *err) {
    static const char expected[] =
        "two colours, of the halves by its ends: \"colors\": [[0.8, 0.1, 0.1], [0.1, 0.1, 0.8]]";
    const BpMaterial *const material = &scene->materials[capsule->material];
    if (node->value == NULL) return BP_OK;
    if (!json_is_array(node->value) || json_array_size(node->value) != 2)
        return bp_node_wrong(node, expected, err);
    if (!bp_material_has(material->kind, BP_MEMBER_ALBEDO))
        return bp_node_fail(node, BP_PART_NAME, err,
                            "found colours for the material \"%.80s\", which has no albedo that they could "
                            "replace; remove them, or choose another material",
                            material->name);
    for (size_t k = 0; k < 2; k++) {
        const BpNode color = bp_node_element(node, k);
        double shares[3];
        if (!json_is_array(color.value) || json_array_size(color.value) != 3)
            return bp_node_wrong(&color, "a colour: [0.8, 0.1, 0.1]", err);
        BP_TRY(bp_node_vector(&color, shares, err));
        for (size_t c = 0; c < 3; c++) {
            const BpNode share = bp_node_element(&color, c);
            if (!(shares[c] >= 0 && shares[c] <= 1))
                return bp_node_wrong(&share, "a share of light from 0 to 1", err);
            scene->albedos[scene->albedo_count][c] = (float)shares[c];
        }
        capsule->albedo[k] = (uint32_t)scene->albedo_count++;
    }
    return BP_OK;
}

static BpStatus parse_capsule(const BpNode *node, const BpMaterialIndex *index, BpScene *scene,
                              BpCapsule *capsule, BpError *err) {
    static const char *const names[] = {"ends", "radius", "material", "colors", "interior"};
    static const char expected[] = "two points: \"ends\": [[0, 0, 0], [0, 1, 0]]";
    BP_TRY(refuse_others(node, err));
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(node, "ends", expected, err));
    BP_TRY(bp_node_require(node, "radius", "a number such as \"radius\": 0.1", err));
    BP_TRY(bp_node_require(node, "material", "a name from \"materials\"", err));
    const BpNode ends = bp_node_member(node, "ends"), radius = bp_node_member(node, "radius"),
                 material = bp_node_member(node, "material"), colors = bp_node_member(node, "colors");
    if (!json_is_array(ends.value) || json_array_size(ends.value) != 2)
        return bp_node_wrong(&ends, expected, err);
    for (size_t k = 0; k < 2; k++) {
        const BpNode end = bp_node_element(&ends, k);
        BP_TRY(bp_node_vector(&end, capsule->ends[k], err));
        capsule->albedo[k] = BP_NO_ALBEDO;
    }
    BP_TRY(bp_node_number(&radius, &capsule->radius, err));
    BP_TRY(bp_parse_material_name(&material, index, &capsule->material, err));
    return parse_colors(&colors, scene, capsule, err);
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
    BP_TRY(make_room(node, count, scene, err));
    for (size_t i = 0; i < count; i++) {
        const BpNode element = bp_node_element(node, i);
        if (!json_is_object(element.value))
            return bp_node_wrong(&element, "an object: { \"ends\": ..., \"radius\": ..., \"material\": ... }",
                                 err);
        BP_TRY(parse_capsule(&element, index, scene, &scene->capsules[i], err));
        BP_TRY(bp_parse_interior(&element, scene, i, count, &scene->capsule_interiors,
                                 &scene->capsule_interior_count, err));
        scene->capsule_count = scene->listed_capsules = i + 1;
    }
    return BP_OK;
}
