/* scene_texture.c: see scene_texture.h. */
#include "scene_texture.h"

#include "base/words.h"
#include "scene_image.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A colour, or a number for all three of its parts. */
static BpStatus parse_value(const BpNode *node, double value[3], BpError *err) {
    if (!json_is_number(node->value) && json_array_size(node->value) != 3)
        return bp_node_wrong(node, "a colour [r, g, b], or a number", err);
    if (json_is_array(node->value)) return bp_node_vector(node, value, err);
    BP_TRY(bp_node_number(node, &value[0], err));
    value[1] = value[2] = value[0];
    return BP_OK;
}

static BpStatus parse_colors(const BpNode *node, double colors[2][3], BpError *err) {
    if (json_array_size(node->value) != 2)
        return bp_node_wrong(node, "two colours, or two numbers: [[0.2, 0.3, 0.1], [0.9, 0.9, 0.9]]", err);
    for (size_t i = 0; i < 2; i++) {
        const BpNode element = bp_node_element(node, i);
        BP_TRY(parse_value(&element, colors[i], err));
    }
    return BP_OK;
}

static BpStatus parse_repeat(const BpNode *node, uint32_t repeat[2], BpError *err) {
    if (node->value == NULL) return BP_OK;
    if (json_array_size(node->value) != 2)
        return bp_node_wrong(node, "two whole numbers: [times around, times from pole to pole]", err);
    for (size_t i = 0; i < 2; i++) {
        const BpNode element = bp_node_element(node, i);
        BP_TRY(bp_node_integer(&element, 1, BP_TEXTURE_REPEAT_MAX, &repeat[i], err));
    }
    return BP_OK;
}

/* Which textures have a member: those of types that have what BP_TEXTURE_COLORS and its like name, or these.
 */
enum { OF_SOLID = BP_TEXTURE_TRAITS_END, OF_SURFACE = 2 * OF_SOLID, OF_WAVES = 4 * OF_SOLID };

static unsigned sorts_of(const BpTexture *texture) {
    const unsigned mapping = texture->mapping == BP_MAPPING_SOLID ? OF_SOLID : OF_SURFACE;
    return bp_texture_types[texture->type].has | mapping | (bp_texture_has_waves(texture) ? OF_WAVES : 0);
}

#define PI 3.14159265358979323846
#define TYPES_SIZE 128

/* "\"checker\" or \"noise\"": the types that have this; 0: all. */
static const char *list_types(unsigned what, char text[TYPES_SIZE]) {
    size_t left = 0, used = 0;
    for (size_t t = 0; t < bp_texture_type_count; t++)
        left += what == 0 || (bp_texture_types[t].has & what) != 0;
    for (size_t t = 0; t < bp_texture_type_count && used < TYPES_SIZE; t++)
        if (what == 0 || (bp_texture_types[t].has & what) != 0)
            used += (size_t)snprintf(text + used, TYPES_SIZE - used, "%s\"%s\"",
                                     used == 0   ? ""
                                     : left == 1 ? " or "
                                                 : ", ",
                                     bp_texture_type_names[t]),
                left--;
    return text;
}

/* The book's checker_texture and noise_texture have a scale; this says what becomes of it. */
static BpStatus refuse_scale(const BpNode *scale, const BpTexture *texture, BpError *err) {
    const double book = json_number_value(scale->value); /* 0 if it is no number */
    const bool checker = texture->type == BP_TEXTURE_CHECKER;
    const bool marble = texture->type == BP_TEXTURE_NOISE && texture->pattern == BP_PATTERN_MARBLE;
    char instead[128] = "remove it";
    if (isfinite(1 / book) && book > 0 && texture->mapping == BP_MAPPING_SOLID)
        snprintf(instead, sizeof instead, "the book's scale of %.6g is \"%s\": %.6g here", book,
                 marble ? "period" : "size", checker ? book : (marble ? 2 * PI : 1) / book);
    return bp_node_fail(scale, BP_PART_NAME, err,
                        "found in a texture that has no use for it, expected only in one of the type "
                        "\"image\"; %s",
                        instead);
}

static BpStatus refuse_foreign_members(const BpNode *node, const BpTexture *texture, BpError *err) {
    static const char surface[] = "an image, or one with \"mapping\": \"surface\"";
    static const struct {
        const char *name;
        unsigned sort;
        const char *owners; /* NULL: the types that have it */
    } members[] = {{"mapping", BP_TEXTURE_MAPPING, NULL},
                   {"colors", BP_TEXTURE_COLORS, NULL},
                   {"size", OF_SOLID, "one with \"mapping\": \"solid\""},
                   {"origin", OF_SOLID, "one with \"mapping\": \"solid\""},
                   {"up", OF_SURFACE, surface},
                   {"turn", OF_SURFACE, surface},
                   {"repeat", OF_SURFACE, surface},
                   {"file", BP_TEXTURE_FILE, NULL},
                   {"encoding", BP_TEXTURE_FILE, NULL},
                   {"scale", BP_TEXTURE_FILE, NULL},
                   {"image", BP_TEXTURE_FILE, NULL},
                   {"wrap", BP_TEXTURE_FILE, NULL},
                   {"pattern", BP_TEXTURE_PATTERN, NULL},
                   {"octaves", BP_TEXTURE_PATTERN, NULL},
                   {"seed", BP_TEXTURE_PATTERN, NULL},
                   {"axis", OF_WAVES, "noise of the pattern \"marble\" or \"wood\""},
                   {"period", OF_WAVES, "noise of the pattern \"marble\" or \"wood\""},
                   {"distortion", OF_WAVES, "noise of the pattern \"marble\" or \"wood\""}};
    const unsigned sorts = sorts_of(texture);
    for (size_t i = 0; i < BP_COUNT(members); i++) {
        const BpNode member = bp_node_member(node, members[i].name);
        if (member.value == NULL || (members[i].sort & sorts) != 0) continue;
        char types[TYPES_SIZE];
        if (strcmp(members[i].name, "scale") == 0) return refuse_scale(&member, texture, err);
        if (members[i].owners == NULL)
            return bp_node_fail(&member, BP_PART_NAME, err,
                                "found in a texture that has no use for it, expected only in one of the type "
                                "%s; remove it",
                                list_types(members[i].sort, types));
        return bp_node_fail(&member, BP_PART_NAME, err,
                            "found in a texture that has no use for it, expected only in %s; remove it",
                            members[i].owners);
    }
    return BP_OK;
}

static BpStatus parse_noise(const BpNode *node, BpTexture *texture, BpError *err) {
    const BpNode octaves = bp_node_member(node, "octaves");
    const BpNode seed = bp_node_member(node, "seed");
    const BpNode axis = bp_node_member(node, "axis");
    const BpNode period = bp_node_member(node, "period");
    const BpNode distortion = bp_node_member(node, "distortion");
    bp_texture_pattern_defaults(texture);
    BP_TRY(bp_node_integer(&octaves, 1, BP_OCTAVES_MAX, &texture->octaves, err));
    BP_TRY(bp_node_integer(&seed, 0, UINT32_MAX, &texture->seed, err));
    BP_TRY(bp_node_choice(&axis, bp_axis_names, bp_axis_count, &texture->axis, err));
    BP_TRY(bp_node_number(&period, &texture->period, err));
    return bp_node_number(&distortion, &texture->distortion, err);
}

static BpStatus parse_image(const BpNode *node, unsigned flags, BpScene *scene, BpTexture *texture,
                            BpError *err) {
    const BpNode file = bp_node_member(node, "file");
    const BpNode encoding = bp_node_member(node, "encoding");
    const BpNode scale = bp_node_member(node, "scale");
    const BpNode wrap = bp_node_member(node, "wrap");
    const BpNode number = bp_node_member(node, "image");
    uint32_t inside = 0;
    int choice = BP_WRAP_REPEAT;
    BP_TRY(bp_node_require(node, "file",
                           "the path of a PNG, JPEG, EXR, PFM or Radiance file, or with \"image\" of a glTF "
                           "file, relative to the scene",
                           err));
    BP_TRY(bp_node_choice(&wrap, bp_wrap_names, bp_wrap_count, &choice, err));
    texture->wrap = (BpWrap)choice;
    BP_TRY(bp_node_integer(&number, 0, BP_IMAGES_MAX, &inside, err));
    if (number.value != NULL) inside++;
    return bp_parse_image(&file, &encoding, &scale, inside, flags, scene, &texture->image, err);
}

static BpStatus parse_texture(const BpNode *node, unsigned flags, BpScene *scene, BpTexture *texture,
                              BpError *err) {
    static const char *const names[] = {"type",  "mapping",  "colors", "size",       "origin",
                                        "up",    "turn",     "repeat", "pattern",    "octaves",
                                        "seed",  "axis",     "period", "distortion", "file",
                                        "image", "encoding", "scale",  "wrap"};
    int type = 0, mapping = 0, pattern = 0;
    if (!json_is_object(node->value))
        return bp_node_wrong(node, "an object: { \"type\": \"checker\", \"colors\": ... }", err);
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    char types[TYPES_SIZE];
    BP_TRY(bp_node_require(node, "type", list_types(0, types), err));
    const BpNode type_node = bp_node_member(node, "type");
    const BpNode mapping_node = bp_node_member(node, "mapping");
    const BpNode pattern_node = bp_node_member(node, "pattern");
    const BpNode colors = bp_node_member(node, "colors");
    const BpNode size = bp_node_member(node, "size");
    const BpNode origin = bp_node_member(node, "origin");
    const BpNode up = bp_node_member(node, "up");
    const BpNode turn = bp_node_member(node, "turn");
    const BpNode repeat = bp_node_member(node, "repeat");
    BP_TRY(bp_node_choice(&type_node, bp_texture_type_names, bp_texture_type_count, &type, err));
    BP_TRY(bp_node_choice(&mapping_node, bp_mapping_names, bp_mapping_count, &mapping, err));
    BP_TRY(bp_node_choice(&pattern_node, bp_pattern_names, bp_pattern_count, &pattern, err));
    texture->type = (BpTextureType)type;
    texture->mapping = bp_texture_types[type].mapping;
    if (mapping_node.value != NULL) texture->mapping = (BpMapping)mapping;
    texture->pattern = (BpPattern)pattern;
    BP_TRY(refuse_foreign_members(node, texture, err));
    if (bp_texture_has(texture, BP_TEXTURE_COLORS)) {
        BP_TRY(bp_node_require(node, "colors", "two, such as \"colors\": [[0.2, 0.3, 0.1], [0.9, 0.9, 0.9]]",
                               err));
        BP_TRY(parse_colors(&colors, texture->colors, err));
    }
    BP_TRY(bp_node_number(&size, &texture->size, err));
    BP_TRY(bp_node_vector(&origin, texture->origin, err));
    if (bp_texture_has(texture, BP_TEXTURE_PATTERN)) return parse_noise(node, texture, err);
    BP_TRY(bp_node_vector(&up, texture->up, err));
    BP_TRY(bp_node_number(&turn, &texture->turn_degrees, err));
    BP_TRY(parse_repeat(&repeat, texture->repeat, err));
    if (bp_texture_has(texture, BP_TEXTURE_FILE)) return parse_image(node, flags, scene, texture, err);
    return BP_OK;
}

BpStatus bp_parse_textures(const BpNode *node, unsigned flags, BpScene *scene, BpError *err) {
    if (node->value != NULL && !json_is_object(node->value))
        return bp_node_wrong(
            node, "an object of named textures: { \"squares\": { \"type\": \"checker\", ... } }", err);
    const size_t count = json_object_size(node->value);
    if (count == 0) return BP_OK;
    if (count > BP_TEXTURES_MAX)
        return bp_node_fail(node, BP_PART_VALUE, err, "found %zu textures, expected at most %u", count,
                            BP_TEXTURES_MAX);
    scene->textures = calloc(count, sizeof *scene->textures);
    if (scene->textures == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu textures", count);
    const char *name;
    json_t *value;
    json_object_foreach(node->value, name, value) {
        const BpNode child = bp_node_member(node, name);
        BpTexture *texture = &scene->textures[scene->texture_count++];
        bp_texture_defaults(texture);
        BP_TRY(bp_copy_text(name, &texture->name, err));
        BP_TRY(parse_texture(&child, flags, scene, texture, err));
    }
    return BP_OK;
}

BpStatus bp_parse_texture_name(const BpNode *node, const BpScene *scene, uint32_t *number, BpError *err) {
    static const char *const names[] = {"texture"};
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(node, "texture", "a name from \"textures\"", err));
    const BpNode texture = bp_node_member(node, "texture");
    return bp_node_find(&texture, "texture", "textures", scene->textures, sizeof *scene->textures,
                        scene->texture_count, number, err);
}
