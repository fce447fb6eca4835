/* scene_background.c: see scene_background.h. */
#include "scene_background.h"

#include "scene/lighting.h"
#include "scene_image.h"

#include <math.h>
#include <string.h>

static BpStatus parse_disc(const BpNode *node, BpDisc *disc, BpError *err) {
    static const char *const names[] = {"direction", "half_angle", "radiance", "visible_to_camera"};
    if (!json_is_object(node->value))
        return bp_node_wrong(
            node, "an object: { \"direction\": [x, y, z], \"half_angle\": ..., \"radiance\": [r, g, b] }",
            err);
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(node, "direction", "\"direction\": [x, y, z], where the disc stands", err));
    BP_TRY(bp_node_require(node, "half_angle", "degrees such as \"half_angle\": 0.25", err));
    BP_TRY(bp_node_require(node, "radiance", "\"radiance\": [r, g, b]", err));
    const BpNode direction = bp_node_member(node, "direction");
    const BpNode half_angle = bp_node_member(node, "half_angle");
    const BpNode radiance = bp_node_member(node, "radiance");
    const BpNode visible = bp_node_member(node, "visible_to_camera");
    *disc = (BpDisc){.visible_to_camera = true};
    BP_TRY(bp_node_vector(&direction, disc->direction, err));
    BP_TRY(bp_node_number(&half_angle, &disc->half_angle_degrees, err));
    BP_TRY(bp_node_vector(&radiance, disc->radiance, err));
    return bp_node_boolean(&visible, &disc->visible_to_camera, err);
}

static BpStatus parse_discs(const BpNode *node, BpScene *scene, BpError *err) {
    BP_TRY(bp_node_list(
        node,
        "a list of discs: [ { \"direction\": [1, 2, 0], \"half_angle\": 0.25, \"radiance\": [9, 9, 8] } ]",
        err));
    const size_t count = json_array_size(node->value);
    if (count > BP_DISCS_MAX)
        return bp_node_fail(node, BP_PART_VALUE, err, "found %zu discs, expected at most %u", count,
                            BP_DISCS_MAX);
    for (size_t i = 0; i < count; i++) {
        const BpNode element = bp_node_element(node, i);
        BP_TRY(parse_disc(&element, &scene->discs[i], err));
    }
    scene->disc_count = count;
    return BP_OK;
}

/* An image in place of a gradient. */
static BpStatus parse_environment(const BpNode *node, unsigned flags, BpScene *scene, BpError *err) {
    static const char *const either[] = {"bottom", "top"}, *const only[] = {"turn", "scale", "encoding"};
    const BpNode image = bp_node_member(node, "image");
    for (size_t i = 0; i < BP_COUNT(only) && image.value == NULL; i++) {
        const BpNode member = bp_node_member(node, only[i]);
        if (member.value != NULL)
            return bp_node_fail(&member, BP_PART_NAME, err,
                                "found in a background without an image, expected only beside \"image\"; "
                                "remove it");
    }
    if (image.value == NULL) return BP_OK;
    for (size_t i = 0; i < BP_COUNT(either); i++) {
        const BpNode member = bp_node_member(node, either[i]);
        if (member.value != NULL)
            return bp_node_fail(&member, BP_PART_NAME, err,
                                "found beside \"image\", expected one of the two: remove one");
    }
    const BpNode turn = bp_node_member(node, "turn");
    const BpNode encoding = bp_node_member(node, "encoding");
    const BpNode scale = bp_node_member(node, "scale");
    for (int c = 0; c < 3; c++) scene->background_bottom[c] = scene->background_top[c] = 0;
    BP_TRY(bp_node_number(&turn, &scene->environment_turn, err));
    return bp_parse_image(&image, &encoding, &scale, 0, flags, scene, &scene->environment, err);
}

BpStatus bp_parse_background(const BpNode *node, unsigned flags, BpScene *scene, BpError *err) {
    static const char *const names[] = {"bottom", "top", "up", "discs", "image", "turn", "scale", "encoding"};
    if (json_is_array(node->value)) {
        BP_TRY(bp_node_vector(node, scene->background_bottom, err));
        memcpy(scene->background_top, scene->background_bottom, sizeof scene->background_top);
        return BP_OK;
    }
    if (node->value != NULL && !json_is_object(node->value))
        return bp_node_wrong(
            node,
            "{ \"bottom\": [r, g, b], \"top\": [r, g, b] }, { \"image\": \"sky.exr\" }, or one colour "
            "[r, g, b]",
            err);
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    const BpNode bottom = bp_node_member(node, "bottom");
    const BpNode top = bp_node_member(node, "top");
    const BpNode discs = bp_node_member(node, "discs");
    const BpNode up = bp_node_member(node, "up");
    BP_TRY(bp_node_vector(&bottom, scene->background_bottom, err));
    BP_TRY(bp_node_vector(&top, scene->background_top, err));
    BP_TRY(bp_node_vector(&up, scene->background_up, err));
    const double *const u = scene->background_up;
    if (up.value != NULL && u[0] == 0 && u[1] == 0 && u[2] == 0)
        return bp_node_wrong(&up, "the direction that is up, such as [0, 0, 1]", err);
    BP_TRY(parse_environment(node, flags, scene, err));
    return parse_discs(&discs, scene, err);
}

BpStatus bp_parse_backdrop(const BpNode *node, BpScene *scene, BpError *err) {
    static const char *const names[] = {"bottom", "top"};
    static const char expected[] =
        "\"none\", one colour [r, g, b], or { \"bottom\": [r, g, b], \"top\": [r, g, b] }";
    if (node->value == NULL) return BP_OK;
    if (json_is_string(node->value)) {
        if (strcmp(json_string_value(node->value), "none") != 0) return bp_node_wrong(node, expected, err);
        scene->backdrop = BP_BACKDROP_NONE;
        return BP_OK;
    }
    scene->backdrop = BP_BACKDROP_COLORS;
    if (json_is_array(node->value)) {
        BP_TRY(bp_node_vector(node, scene->backdrop_bottom, err));
        memcpy(scene->backdrop_top, scene->backdrop_bottom, sizeof scene->backdrop_top);
        return BP_OK;
    }
    if (!json_is_object(node->value)) return bp_node_wrong(node, expected, err);
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(node, "bottom", "a colour, such as \"bottom\": [1, 1, 1]", err));
    BP_TRY(bp_node_require(node, "top", "a colour, such as \"top\": [1, 1, 1]", err));
    const BpNode bottom = bp_node_member(node, "bottom");
    const BpNode top = bp_node_member(node, "top");
    BP_TRY(bp_node_vector(&bottom, scene->backdrop_bottom, err));
    return bp_node_vector(&top, scene->backdrop_top, err);
}

BpStatus bp_parse_shadow_catcher(const BpNode *node, BpScene *scene, BpError *err) {
    static const char *const names[] = {"up", "height"};
    BpShadowCatcher *const catcher = &scene->shadow_catcher;
    if (node->value == NULL) return BP_OK;
    if (json_is_boolean(node->value)) {
        BP_TRY(bp_node_boolean(node, &catcher->present, err));
    } else if (json_is_object(node->value)) {
        catcher->present = true;
        BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    } else {
        return bp_node_wrong(node, "true, false or { \"height\": 0, \"up\": [0, 1, 0] }", err);
    }
    const BpNode up = bp_node_member(node, "up"), height = bp_node_member(node, "height");
    BP_TRY(bp_node_vector(&up, catcher->up, err));
    BP_TRY(bp_node_number(&height, &catcher->height, err));
    catcher->has_height = height.value != NULL;
    double longest = 0;
    for (int c = 0; c < 3; c++) longest = fmax(longest, fabs(catcher->up[c]));
    if (up.value != NULL && !(longest >= 1e-12 && longest <= BP_COORDINATE_MAX))
        return bp_node_wrong(&up, "the direction that is up, such as [0, 0, 1]", err);
    if (!(fabs(catcher->height) <= BP_COORDINATE_MAX))
        return bp_node_wrong(&height, "a coordinate from -1e12 to 1e12", err);
    if (catcher->present && scene->environment != NULL)
        return bp_node_fail(node, BP_PART_NAME, err,
                            "found beside an image as background, expected colours and discs, whose light a "
                            "shadow catcher takes into account; remove one");
    return BP_OK;
}

BpStatus bp_parse_lighting(const BpNode *root, const char *name, BpScene *scene, BpError *err) {
    const BpNode node = bp_node_member(root, "lighting");
    const BpNode background = bp_node_member(root, "background");
    const BpNode backdrop = bp_node_member(root, "backdrop");
    int choice = BP_LIGHTING_SKY;
    BP_TRY(bp_node_choice(&node, bp_lighting_names, BP_LIGHTING_COUNT, &choice, err));
    if (choice != BP_LIGHTING_SKY && background.value != NULL && name == NULL)
        return bp_node_fail(
            &node, BP_PART_NAME, err,
            "found beside \"background\", which is light too; expected one of the two: remove one");
    for (int i = 0; i < BP_LIGHTING_COUNT && name != NULL; i++)
        if (strcmp(name, bp_lighting_names[i]) == 0) choice = i;
    scene->lighting = (BpLighting)choice;
    if (scene->lighting == BP_LIGHTING_SKY || backdrop.value != NULL) return BP_OK;
    scene->backdrop = BP_BACKDROP_COLORS;
    for (int c = 0; c < 3; c++) scene->backdrop_bottom[c] = scene->backdrop_top[c] = 1;
    return BP_OK;
}
