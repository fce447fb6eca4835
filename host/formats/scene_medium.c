/* scene_medium.c: see scene_medium.h. */
#include "scene_medium.h"

#include <stdlib.h>
#include <string.h>

/* A number for each colour, or one for all three. */
static BpStatus parse_density(const BpNode *node, double density[3], BpError *err) {
    if (node->value == NULL) return BP_OK;
    if (!json_is_number(node->value) && json_array_size(node->value) != 3)
        return bp_node_wrong(node, "three densities [r, g, b] per unit of length, or one number for all",
                             err);
    if (json_is_array(node->value)) return bp_node_vector(node, density, err);
    BP_TRY(bp_node_number(node, &density[0], err));
    density[1] = density[2] = density[0];
    return BP_OK;
}

static BpStatus parse_medium(const BpNode *node, BpMedium *medium, BpError *err) {
    static const char *const names[] = {"absorption", "scattering", "anisotropy"};
    if (!json_is_object(node->value))
        return bp_node_wrong(node, "an object: { \"absorption\": [0, 0, 0], \"scattering\": [1, 1, 1] }",
                             err);
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    const BpNode absorption = bp_node_member(node, "absorption");
    const BpNode scattering = bp_node_member(node, "scattering");
    const BpNode anisotropy = bp_node_member(node, "anisotropy");
    BP_TRY(parse_density(&absorption, medium->absorption, err));
    BP_TRY(parse_density(&scattering, medium->scattering, err));
    return bp_node_number(&anisotropy, &medium->anisotropy, err);
}

BpStatus bp_parse_media(const BpNode *node, BpScene *scene, BpError *err) {
    if (node->value != NULL && !json_is_object(node->value))
        return bp_node_wrong(node, "an object of named media: { \"fog\": { \"scattering\": 0.1 } }", err);
    const size_t count = json_object_size(node->value);
    if (count == 0) return BP_OK;
    if (count > BP_MEDIA_MAX)
        return bp_node_fail(node, BP_PART_VALUE, err, "found %zu media, expected at most %u", count,
                            BP_MEDIA_MAX);
    scene->media = calloc(count, sizeof *scene->media);
    if (scene->media == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu media", count);
    const char *name;
    json_t *value;
    json_object_foreach(node->value, name, value) {
        const BpNode child = bp_node_member(node, name);
        BpMedium *medium = &scene->media[scene->medium_count++];
        BP_TRY(bp_copy_text(name, &medium->name, err));
        BP_TRY(parse_medium(&child, medium, err));
    }
    return BP_OK;
}

BpStatus bp_parse_medium_name(const BpNode *node, const BpScene *scene, uint32_t *number, BpError *err) {
    return node->value == NULL ? BP_OK
                               : bp_node_find(node, "medium", "media", scene->media, sizeof *scene->media,
                                              scene->medium_count, number, err);
}

BpStatus bp_medium_of_set(const char *interior, const char *set, const BpScene *scene, uint32_t *number,
                          BpError *err) {
    char missing[BP_MISSING_NAME_SIZE];
    *number = 0;
    if (interior == NULL) return BP_OK;
    BP_TRY(bp_find_name(interior, "medium", "media", scene->media, sizeof *scene->media, scene->medium_count,
                        number, missing, err));
    return *number > 0 ? BP_OK : bp_fail(err, BP_ERR_SCENE, "%s: interior: %s", set, missing);
}

BpStatus bp_fill_interiors(uint32_t interior, size_t first, size_t end, uint32_t **interiors,
                           size_t *interior_count, BpError *err) {
    if (interior == 0) return BP_OK;
    BP_TRY(bp_make_interiors(end, interiors, interior_count, err));
    for (size_t i = first; i < end; i++) (*interiors)[i] = interior;
    return BP_OK;
}

BpStatus bp_parse_interior(const BpNode *node, const BpScene *scene, size_t index, size_t count,
                           uint32_t **interiors, size_t *interior_count, BpError *err) {
    const BpNode interior = bp_node_member(node, "interior");
    if (interior.value == NULL) return BP_OK;
    BP_TRY(bp_make_interiors(count, interiors, interior_count, err));
    return bp_parse_medium_name(&interior, scene, &(*interiors)[index], err);
}
