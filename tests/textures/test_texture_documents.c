/* test_texture_documents.c: textures as documents have them, as films tell scenes apart by them, and as the
 * device is given them. */
#define BP_HOST
#include "base/status.h"
#include "film/film.h"
#include "packed/pack.h"
#include "packed/reals.h"
#include "scene/in_view.h"
#include "scene_types.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define SQUARES "\"squares\": { \"type\": \"checker\", \"colors\": [[1, 0.5, 0], 0.25] }"
#define MATTE "\"m\": { \"type\": \"lambertian\", \"albedo\": { \"texture\": \"squares\" } }"
#define SPHERES "\"spheres\": [ { \"center\": [0, 0, -2], \"radius\": 1, \"material\": \"m\" } ]"
#define SCENE(textures, materials)                                                                           \
    "{ \"camera\": {}, \"textures\": { " textures " }, \"materials\": { " materials " }, " SPHERES " }"

static BpScene *parse(const char *text) {
    BpScene *scene = NULL;
    BpError err = {0};
    if (bp_scene_parse(text, strlen(text), "x.json", &scene, &err) != BP_OK)
        fail_msg("%s at %d:%d in\n%s", err.message, err.line, err.column, text);
    return scene;
}

static BpScene *read_back(const BpScene *scene, char **text) {
    size_t size = 0;
    FILE *stream = open_memstream(text, &size);
    assert_non_null(stream);
    assert_int_equal(bp_scene_print(scene, stream, NULL), BP_OK);
    fclose(stream);
    return parse(*text);
}

#define FULL                                                                                                 \
    SCENE(SQUARES ", \"globe\": { \"type\": \"checker\", \"mapping\": \"surface\", \"colors\": [[0, 0, 0], " \
                  "[3, 2, 1]],"                                                                              \
                  " \"up\": [0, 0, -2.5], \"turn\": -40, \"repeat\": [7, 65536] },"                          \
                  " \"rough\": { \"type\": \"checker\", \"mapping\": \"solid\", \"colors\": [0.5, 2], "      \
                  "\"size\": 0.3 }",                                                                         \
          "\"m\": { \"type\": \"metal\", \"albedo\": { \"texture\": \"squares\" }, \"fuzz\": { "             \
          "\"texture\": \"rough\" },"                                                                        \
          " \"emit\": { \"texture\": \"globe\" } }")

#define NOISES                                                                                               \
    "\"p\": { \"type\": \"noise\", \"colors\": [0, 1] },"                                                    \
    "\"t\": { \"type\": \"noise\", \"pattern\": \"turbulence\", \"colors\": [1, 0], \"octaves\": 12, "       \
    "\"seed\": 4294967295 },"                                                                                \
    "\"w\": { \"type\": \"noise\", \"pattern\": \"wood\", \"colors\": [0, [1, 0.5, 0]], \"size\": 0.25 },"   \
    "\"m\": { \"type\": \"noise\", \"pattern\": \"marble\", \"colors\": [0, 1], \"size\": 3, \"origin\": "   \
    "[1, -2, 0.1],"                                                                                          \
    "  \"axis\": \"x\", \"period\": 0.7, \"distortion\": 0 }"

static void noise(void **state) {
    (void)state;
    BpScene *scene =
        parse(SCENE(NOISES, "\"m\": { \"type\": \"lambertian\", \"albedo\": { \"texture\": \"w\" } }"));
    char *text = NULL;
    BpScene *again = read_back(scene, &text);
    for (int pass = 0; pass < 2; pass++) {
        const BpScene *s = pass == 0 ? scene : again;
        const BpTexture *t = s->textures;
        assert_int_equal(s->texture_count, 4);
        for (int i = 0; i < 4; i++)
            assert_true(t[i].type == BP_TEXTURE_NOISE && t[i].mapping == BP_MAPPING_SOLID);
        assert_true(t[0].pattern == BP_PATTERN_PERLIN && t[0].octaves == 1 && t[0].seed == 0);
        assert_true(t[1].pattern == BP_PATTERN_TURBULENCE && t[1].octaves == 12 && t[1].seed == UINT32_MAX);
        assert_true(t[2].pattern == BP_PATTERN_WOOD && t[2].octaves == 2 && t[2].axis == 2);
        assert_true(t[2].period >= 0.25 && t[2].period <= 0.25); /* as long as a cell */
        assert_true(t[3].pattern == BP_PATTERN_MARBLE && t[3].octaves == 7 && t[3].axis == 0);
        assert_true(t[3].period >= 0.7 && t[3].period <= 0.7 && t[3].distortion <= 0 && t[3].distortion >= 0);
        assert_memory_equal(t[3].origin, ((double[3]){1, -2, 0.1}), sizeof t[3].origin);
        assert_memory_equal(s->materials->albedo, ((double[3]){1, 0.5, 0}), sizeof s->materials->albedo);
    }
    assert_true(bp_scene_hash(scene) == bp_scene_hash(again));
    free(text);
    bp_scene_destroy(&again);
    bp_scene_destroy(&scene);
}

static void every_member(void **state) {
    (void)state;
    BpScene *scene = parse(FULL);
    char *text = NULL;
    assert_int_equal(scene->texture_count, 3);
    BpScene *again = read_back(scene, &text);
    for (int pass = 0; pass < 2; pass++) {
        const BpScene *s = pass == 0 ? scene : again;
        const BpTexture *t = s->textures;
        const BpMaterial *m = s->materials;
        assert_int_equal(s->texture_count, 3);
        assert_string_equal(t[1].name, "globe");
        assert_true(t[0].mapping == BP_MAPPING_SOLID && t[1].mapping == BP_MAPPING_SURFACE);
        assert_true(t[0].size >= 1 && t[0].size <= 1 && t[2].size >= 0.3 && t[2].size <= 0.3);
        assert_memory_equal(t[0].colors, ((double[2][3]){{1, 0.5, 0}, {0.25, 0.25, 0.25}}),
                            sizeof t[0].colors);
        assert_memory_equal(t[1].colors, ((double[2][3]){{0, 0, 0}, {3, 2, 1}}), sizeof t[1].colors);
        assert_memory_equal(t[1].up, ((double[3]){0, 0, -2.5}), sizeof t[1].up);
        assert_true(t[1].turn_degrees >= -40 && t[1].turn_degrees <= -40);
        assert_true(t[1].repeat[0] == 7 && t[1].repeat[1] == 65536);
        assert_int_equal(m->texture[BP_MEMBER_ALBEDO], 1);
        assert_int_equal(m->texture[BP_MEMBER_FUZZ], 3);
        assert_int_equal(m->texture[BP_MEMBER_EMIT], 2);
        assert_int_equal(m->texture[BP_MEMBER_REFRACTION_INDEX], 0);
        /* The most that each can be; a fuzz above 1 counts as 1. */
        assert_memory_equal(m->albedo, ((double[3]){1, 0.5, 0.25}), sizeof m->albedo);
        assert_memory_equal(m->emit, ((double[3]){3, 2, 1}), sizeof m->emit);
        assert_true(m->fuzz >= 1 && m->fuzz <= 1);
    }
    assert_true(bp_scene_hash(scene) == bp_scene_hash(again));
    free(text);
    bp_scene_destroy(&again);
    bp_scene_destroy(&scene);
}

typedef struct Case {
    const char *text;
    const char *says[2]; /* parts of the message */
} Case;

static void refused_with_place_and_remedy(void **state) {
    (void)state;
#define ONE(members) SCENE("\"squares\": { " members " }", MATTE)
#define CHECKER "\"type\": \"checker\", \"colors\": [0, 1]"
#define NOISE "\"type\": \"noise\", \"colors\": [0, 1]"
#define IMAGE "\"type\": \"image\""
#define OVER CHECKER ", \"mapping\": \"surface\""
    static const Case cases[] = {
        {"{ \"camera\": {}, \"textures\": [] }", {"textures: found a list", "\"squares\""}},
        {SCENE("\"squares\": 3", MATTE), {"textures.squares: found 3", "an object"}},
        {ONE(""), {"textures.squares: found no \"type\"", "\"checker\", \"noise\" or \"image\""}},
        {ONE("\"type\": \"cheker\", \"colors\": [0, 1]"),
         {"textures.squares.type", "did you mean \"checker\""}},
        {ONE("\"type\": \"checker\""), {"textures.squares: found no \"colors\"", "two"}},
        {ONE("\"type\": \"checker\", \"colors\": [1]"),
         {"textures.squares.colors: found a list of 1", "two colours"}},
        {ONE("\"type\": \"checker\", \"colors\": [[1, 1], 0]"), {"textures.squares.colors[0]", "[r, g, b]"}},
        {ONE("\"type\": \"checker\", \"colors\": [0, -1]"), {"textures.squares.colors: found -1", "from 0"}},
        {ONE("\"type\": \"checker\", \"colors\": [0, 2]"), {"materials.m.albedo: found 2", "from 0 to 1"}},
        {ONE("\"type\": \"checker\", \"color\": [0, 1]"),
         {"textures.squares.color", "did you mean \"colors\""}},
        {ONE(CHECKER ", \"mapping\": \"sphere\""),
         {"textures.squares.mapping: found the text \"sphere\"", "\"surface\""}},
        {ONE(CHECKER ", \"size\": 0"), {"textures.squares.size: found 0", "1e-12"}},
        {ONE(CHECKER ", \"size\": -1"), {"textures.squares.size: found -1", "1e-12"}},
        {ONE(CHECKER ", \"repeat\": [1, 1]"),
         {"textures.squares.repeat: found in a texture that has no use for it", "\"surface\""}},
        {ONE(CHECKER ", \"up\": [0, 1, 0]"),
         {"textures.squares.up: found in a texture", "\"surface\"; remove it"}},
        {ONE(CHECKER ", \"turn\": 3"),
         {"textures.squares.turn: found in a texture", "\"surface\"; remove it"}},
        {ONE(OVER ", \"size\": 1"),
         {"textures.squares.size: found in a texture that has no use for it", "\"solid\""}},
        {ONE(OVER ", \"up\": [0, 0, 0]"), {"textures.squares.up: found no direction", "[0, 1, 0]"}},
        {ONE(OVER ", \"up\": [0, 2e12, 0]"), {"textures.squares.up: found 2000000000000", "1e12"}},
        {ONE(OVER ", \"turn\": 1e7"), {"textures.squares.turn: found 10000000", "1e6"}},
        {ONE(OVER ", \"repeat\": 3"), {"textures.squares.repeat: found 3", "two whole numbers"}},
        {ONE(OVER ", \"repeat\": [0, 1]"), {"textures.squares.repeat[0]: found 0", "from 1 to 65536"}},
        {ONE(OVER ", \"repeat\": [1, 1.5]"), {"textures.squares.repeat[1]: found 1.5", "whole number"}},
        {ONE(CHECKER ", \"origin\": [0, 0, 2e12]"), {"textures.squares.origin: found 2000000000000", "1e12"}},
        /* The book's textures have a scale: that of a checker is a size, that of noise a frequency, of marble
           in radians. */
        {ONE(CHECKER ", \"scale\": 0.32"),
         {"textures.squares.scale: found in a texture", "the book's scale of 0.32 is \"size\": 0.32 here"}},
        {ONE(NOISE ", \"scale\": 4"), {"textures.squares.scale: found", "scale of 4 is \"size\": 0.25 here"}},
        {ONE(NOISE ", \"pattern\": \"turbulence\", \"scale\": 4"),
         {"textures.squares.scale: found", "scale of 4 is \"size\": 0.25 here"}},
        {ONE(NOISE ", \"pattern\": \"marble\", \"scale\": 4"),
         {"textures.squares.scale: found", "scale of 4 is \"period\": 1.5708 here"}},
        {ONE(NOISE ", \"scale\": 0"), {"textures.squares.scale: found", "of the type \"image\"; remove it"}},
        {ONE(OVER ", \"scale\": 2"), {"textures.squares.scale: found", "of the type \"image\"; remove it"}},
        {ONE(CHECKER ", \"octaves\": 2"),
         {"textures.squares.octaves: found in a texture", "of the type \"noise\""}},
        {ONE(NOISE ", \"mapping\": \"solid\""),
         {"textures.squares.mapping: found in a texture", "of the type \"checker\"; remove it"}},
        {ONE(NOISE ", \"repeat\": [1, 1]"),
         {"textures.squares.repeat: found in a texture", "an image, or one with"}},
        {ONE(NOISE ", \"period\": 1"),
         {"textures.squares.period: found in a texture", "\"marble\" or \"wood\""}},
        {ONE(NOISE ", \"octaves\": 0"), {"textures.squares.octaves: found 0", "from 1 to 12"}},
        {ONE(NOISE ", \"octaves\": 13"), {"textures.squares.octaves: found 13", "from 1 to 12"}},
        {ONE(NOISE ", \"seed\": -1"), {"textures.squares.seed: found -1", "from 0 to 4294967295"}},
        {ONE(NOISE ", \"size\": 0"), {"textures.squares.size: found 0", "1e-12"}},
        {ONE(NOISE ", \"pattern\": \"marbel\""), {"textures.squares.pattern", "did you mean \"marble\""}},
        {ONE(NOISE ", \"pattern\": \"wood\", \"axis\": \"w\""),
         {"textures.squares.axis", "\"x\", \"y\" or \"z\""}},
        {ONE(NOISE ", \"pattern\": \"wood\", \"period\": 0"),
         {"textures.squares.period: found 0", "length of a wave"}},
        {ONE(NOISE ", \"pattern\": \"marble\", \"distortion\": -1"),
         {"textures.squares.distortion: found -1", "0 to 1000"}},
        {ONE(IMAGE), {"textures.squares: found no \"file\"", "PNG, JPEG, EXR, PFM or Radiance"}},
        {ONE(IMAGE ", \"file\": 1"), {"textures.squares.file: found 1", "text"}},
        {ONE(IMAGE ", \"file\": \"none.png\""), {"textures.squares.file: \"none.png\"", "cannot open"}},
        {ONE(IMAGE ", \"file\": \".\""), {"textures.squares.file: \".\"", "found a directory"}},
        {ONE(IMAGE ", \"file\": \"a\", \"colors\": [0, 1]"),
         {"textures.squares.colors: found in a texture", "of the type \"checker\" or \"noise\"; remove it"}},
        {ONE(IMAGE ", \"file\": \"a\", \"mapping\": \"surface\""),
         {"textures.squares.mapping: found in a texture", "\"checker\""}},
        {ONE(IMAGE ", \"file\": \"a\", \"encoding\": \"rgb\""),
         {"textures.squares.encoding: found the text \"rgb\"", "\"srgb\" or \"linear\""}},
        {ONE(IMAGE ", \"file\": \"a\", \"scale\": -1"), {"textures.squares.scale: found -1", "0 to 1e12"}},
        {ONE(IMAGE ", \"file\": \"a\", \"wrap\": \"mirror\""),
         {"textures.squares.wrap: found the text \"mirror\"", "\"repeat\" or \"clamp\""}},
        {ONE(OVER ", \"file\": \"a\""),
         {"textures.squares.file: found in a texture", "of the type \"image\""}},
        {"{ \"camera\": {}, \"background\": { \"turn\": 1 } }",
         {"background.turn: found in a background without an image", "\"image\""}},
        {"{ \"camera\": {}, \"background\": { \"image\": \"a\", \"top\": [1, 1, 1] } }",
         {"background.top: found beside \"image\"", "remove one"}},
        {"{ \"camera\": {}, \"background\": { \"image\": \"none.exr\" } }",
         {"background.image: \"none.exr\"", "cannot open"}},
        {SCENE(SQUARES, "\"m\": { \"type\": \"lambertian\", \"albedo\": { \"texture\": \"square\" } }"),
         {"materials.m.albedo.texture: found the texture \"square\"", "did you mean \"squares\""}},
        {SCENE("", MATTE), {"materials.m.albedo.texture: found the texture \"squares\"", "add it there"}},
        {SCENE(SQUARES, "\"m\": { \"type\": \"lambertian\", \"albedo\": {} }"),
         {"materials.m.albedo: found no \"texture\"", "a name from \"textures\""}},
        {SCENE(SQUARES, "\"m\": { \"type\": \"lambertian\", \"albedo\": { \"txture\": \"squares\" } }"),
         {"materials.m.albedo.txture", "did you mean \"texture\""}},
        {SCENE(SQUARES, "\"m\": { \"type\": \"lambertian\", \"albedo\": { \"texture\": 1 } }"),
         {"materials.m.albedo.texture: found 1", "text"}},
        {SCENE(
             SQUARES,
             "\"m\": { \"type\": \"metal\", \"albedo\": [1, 1, 1], \"fuzz\": { \"texture\": \"squares\" } }"),
         {"materials.m.fuzz: found a texture of colours", "numbers"}},
        {SCENE(SQUARES,
               "\"m\": { \"type\": \"dielectric\", \"refraction_index\": { \"texture\": \"squares\" } }"),
         {"materials.m.refraction_index: found an object", "a number"}},
        {"{ \"camera\": {}, \"background\": { \"texture\": \"squares\" } }",
         {"background.texture", "unknown member"}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        BpScene *scene = NULL;
        BpError err = {0};
        const char *text = cases[i].text;
        if (bp_scene_parse(text, strlen(text), "x.json", &scene, &err) != BP_ERR_SCENE)
            fail_msg("not refused as a scene: \"%s\"\n%s", err.message != NULL ? err.message : "", text);
        for (int k = 0; k < 2; k++)
            if (strstr(err.message, cases[i].says[k]) == NULL)
                fail_msg("expected \"%s\" in \"%s\"\n%s", cases[i].says[k], err.message, text);
        assert_string_equal(err.file, "x.json");
        assert_true(err.line == 1 && err.column > 1);
        bp_error_clear(&err);
    }
}

/* A scene that was not read is held to the same rules. */
static void validated_without_a_document(void **state) {
    (void)state;
    BpScene *scene = parse(FULL);
    BpError err = {0};
    scene->materials[0].texture[BP_MEMBER_FUZZ] = 4;
    assert_int_equal(bp_scene_validate(scene, &err), BP_ERR_SCENE);
    assert_non_null(
        strstr(err.message, "materials.m.fuzz: found texture number 4, expected one of 3 textures"));
    bp_error_clear(&err);
    scene->textures[1].repeat[1] = 0;
    assert_int_equal(bp_scene_validate(scene, &err), BP_ERR_SCENE);
    assert_non_null(strstr(err.message, "textures.globe.repeat: found 0, expected 1 to 65536 times"));
    bp_error_clear(&err);
    bp_scene_destroy(&scene);
}

/* A film of one is not taken for a film of the other, unless pictures cannot tell. */
static void films_tell_textures_apart(void **state) {
    (void)state;
    BpScene *scene = parse(FULL);
    uint64_t seen[32];
    size_t count = 0;
    seen[count++] = bp_scene_hash(scene);
#define SEEN(field, other)                                                                                   \
    do {                                                                                                     \
        const __typeof__(field) before = field;                                                              \
        field = (other);                                                                                     \
        seen[count++] = bp_scene_hash(scene);                                                                \
        field = before;                                                                                      \
    } while (0)
    SEEN(scene->textures[0].colors[0][2], 0.1);
    SEEN(scene->textures[0].colors[1][0], 0.1);
    SEEN(scene->textures[0].size, 2);
    SEEN(scene->textures[1].up[0], 2);
    SEEN(scene->textures[1].turn_degrees, 2);
    SEEN(scene->textures[1].repeat[0], 2);
    SEEN(scene->textures[1].repeat[1], 2);
    SEEN(scene->textures[2].mapping, BP_MAPPING_SURFACE);
    SEEN(scene->textures[0].origin[1], 2);
    scene->textures[0].type = BP_TEXTURE_NOISE;
    seen[count++] = bp_scene_hash(scene);
    SEEN(scene->textures[0].octaves, 3);
    SEEN(scene->textures[0].seed, 3);
    SEEN(scene->textures[0].pattern, BP_PATTERN_TURBULENCE);
    scene->textures[0].pattern = BP_PATTERN_WOOD;
    seen[count++] = bp_scene_hash(scene);
    SEEN(scene->textures[0].pattern, BP_PATTERN_MARBLE);
    SEEN(scene->textures[0].axis, 0);
    SEEN(scene->textures[0].period, 3);
    SEEN(scene->textures[0].distortion, 3);
    scene->textures[0].type = BP_TEXTURE_CHECKER;
    scene->textures[0].pattern = BP_PATTERN_PERLIN;
    SEEN(scene->materials[0].texture[BP_MEMBER_FUZZ], 0);
    SEEN(scene->materials[0].texture[BP_MEMBER_ALBEDO], 0);
    for (size_t a = 0; a < count; a++)
        for (size_t b = 0; b < a; b++)
            if (seen[a] == seen[b]) fail_msg("changes %zu and %zu have the same hash", a, b);
    SEEN(scene->textures[0].turn_degrees, 2); /* solid: it has no poles */
    SEEN(scene->textures[1].size, 2);
    assert_true(seen[count - 1] == seen[0] && seen[count - 2] == seen[0]);
    /* A texture without a sphere changes nothing. */
    BpScene *plain = parse(SCENE("", "\"m\": { \"type\": \"normals\" }"));
    BpScene *unused = parse(SCENE(SQUARES, "\"m\": { \"type\": \"normals\" }"));
    assert_true(bp_scene_hash(plain) == bp_scene_hash(unused));
    /* A texture may be black in places. */
    BpScene *matte = parse(SCENE(SQUARES, MATTE));
    assert_false(bp_scene_always_scatters(matte));
    bp_scene_destroy(&plain);
    bp_scene_destroy(&unused);
    bp_scene_destroy(&matte);
    bp_scene_destroy(&scene);
}

static void pack(const BpScene *scene, bool single, BpPacked *packed) {
    const BpTreeOptions options = {.width = 8, .single_precision = single, .threads = 1};
    BpError err = {0};
    if (bp_scene_pack(scene, &options, true, true, packed, &err) != BP_OK) fail_msg("%s", err.message);
}

/* The corner of the lattice, seen from the camera: 1e6 cells and a third away, at 2^53 still modulo the
 * period. */
static void lattice_seen_from_the_camera(void **state) {
    (void)state;
    BpScene *scene = parse(SCENE(SQUARES, MATTE));
    scene->textures[0].size = 0.3;
    scene->camera.lookfrom[0] = 0.3 * 1000000 + 0.1;
    scene->camera.lookfrom[1] = -0.1;
    scene->camera.lookfrom[2] = 1e12;
    for (int single = 0; single < 2; ++single) {
        BpPacked packed;
        pack(scene, single, &packed);
        const double scale = bp_reals_load(packed.textures, single, TEXTURE_SCALE);
        const double low = bp_reals_load(packed.textures, single, TEXTURE_SCALE_LOW);
        const double rest[3] = {bp_reals_load(packed.textures, single, TEXTURE_REST),
                                bp_reals_load(packed.textures, single, TEXTURE_REST + 1),
                                bp_reals_load(packed.textures, single, TEXTURE_REST + 2)};
        assert_int_equal(packed.texture_count, 1);
        assert_true(fabs(scale - 1 / 0.3) < 1e-6 && fabs(scale + low - 1 / 0.3) < 1e-14);
        assert_int_equal(packed.texture_kinds[TEXTURE_MAPPING], MAPPING_SOLID);
        assert_int_equal(packed.texture_kinds[TEXTURE_CELL], 1000000);
        assert_int_equal(packed.texture_kinds[TEXTURE_CELL + 1], LATTICE_PERIOD - 1);
        assert_true(packed.texture_kinds[TEXTURE_CELL + 2] < LATTICE_PERIOD);
        assert_true(fabs(rest[0] - 1.0 / 3) < 1e-6 && fabs(rest[1] - 2.0 / 3) < 1e-6);
        assert_true(rest[2] >= 0 && rest[2] <= 1);
        bp_packed_clear(&packed);
    }
    bp_scene_destroy(&scene);
}

/* Points with colours of their own show these, and not the texture of their material. */
static void own_colours_replace_the_texture(void **state) {
    (void)state;
    BpScene *scene = parse(FULL);
    float colour[1][3] = {{0.125f, 0.5f, 0.75f}};
    BpSphere spheres[2] = {scene->spheres[0], scene->spheres[0]};
    spheres[1].albedo = 0;
    spheres[1].center[0] = 5;
    BpSphere *const own = scene->spheres;
    scene->spheres = spheres;
    scene->sphere_count = 2;
    scene->albedos = colour;
    scene->albedo_count = 1;
    BpPacked packed;
    pack(scene, false, &packed);
    assert_int_equal(packed.material_count, 2);
    for (uint32_t slot = 0; slot < packed.tree.leaf_count * packed.tree.width; ++slot) {
        const uint32_t sphere = packed.tree.slot_sphere[slot];
        if (sphere == NO_SPHERE) continue;
        const uint32_t *variation = packed.variations + packed.slot_material[slot] * VARIATION_UINTS;
        assert_int_equal(variation[VARIATION_ALBEDO], sphere == 0 ? 1 : 0);
        assert_int_equal(variation[VARIATION_FUZZ], 3);
        assert_int_equal(variation[VARIATION_EMIT], 2);
        const double red = bp_reals_load(packed.slot_albedo, false, (size_t)slot * ALBEDO_REALS);
        if (sphere == 1) assert_true(red >= 0.125 && red <= 0.125);
    }
    bp_packed_clear(&packed);
    scene->spheres = own;
    scene->sphere_count = 1;
    scene->albedos = NULL;
    scene->albedo_count = 0;
    bp_scene_destroy(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise),
        cmocka_unit_test(every_member),
        cmocka_unit_test(refused_with_place_and_remedy),
        cmocka_unit_test(validated_without_a_document),
        cmocka_unit_test(films_tell_textures_apart),
        cmocka_unit_test(lattice_seen_from_the_camera),
        cmocka_unit_test(own_colours_replace_the_texture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
