/* test_effects_analyse.c: the sets of effects of scenes made by hand, and what is said about them. */
#include "packed/acceleration.h"
#include "packed/effects.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define BIT(effect) (1u << BP_EFFECT_##effect)
#define GREY .albedo = {0.5, 0.5, 0.5}

static const BpMaterial grey = {.name = (char *)"grey", .kind = BP_MATERIAL_LAMBERTIAN, GREY};
static const BpMaterial steel = {.name = (char *)"steel", .kind = BP_MATERIAL_METAL, GREY};
static const BpMaterial glass = {
    .name = (char *)"glass", .kind = BP_MATERIAL_DIELECTRIC, .refraction_index = 1.5};
static const BpMaterial lamp = {.name = (char *)"lamp", .kind = BP_MATERIAL_DIFFUSE_LIGHT, .emit = {4, 4, 4}};
static const BpMaterial black = {.name = (char *)"black", .kind = BP_MATERIAL_DIFFUSE_LIGHT};
static const BpMaterial ember = {
    .name = (char *)"ember", .kind = BP_MATERIAL_LAMBERTIAN, GREY, .emit = {0, 0, 0.1}};
static const BpMaterial clay = {
    .name = (char *)"clay", .kind = BP_MATERIAL_OREN_NAYAR, GREY, .roughness = 0.5};
static const BpMaterial brass = {
    .name = (char *)"brass", .kind = BP_MATERIAL_ROUGH_METAL, GREY, .roughness = 0.06};
static const BpMaterial billiard = {
    .name = (char *)"billiard", .kind = BP_MATERIAL_GLOSSY, GREY, .refraction_index = 1.5};
static const BpMaterial frosted = {.name = (char *)"frosted",
                                   .kind = BP_MATERIAL_ROUGH_DIELECTRIC,
                                   .refraction_index = 1.5,
                                   .roughness = 0.06};
static const BpMaterial debug = {.name = (char *)"debug", .kind = BP_MATERIAL_NORMALS};

#define NO_LAMP "no sphere gives light, and no disc of the sky"

/* Effects that the materials of these tests never call for. */
#define OF_SCENES                                                                                            \
    (BIT(DISCS) | BIT(TEXTURES) | BIT(NOISE) | BIT(IMAGES) | BIT(ENVIRONMENT) | BIT(MOTION) | BIT(MEDIA) |   \
     BIT(BODY_MEDIA) | BIT(SHADOW_CATCHER) | BIT(CAUSTICS) | BIT(TRIANGLES) | BIT(TRIANGLE_LAMPS) |          \
     BIT(SMOOTH_NORMALS) | BIT(CAPSULES) | BIT(ROULETTE) | BIT(TEXTURE_COORDINATES) | BIT(OPACITY))

/* What materials name as textures 1 and 2. */
static BpTexture both[2] = {{.type = BP_TEXTURE_CHECKER, .colors = {{0, 0, 0}, {2, 2, 2}}},
                            {.type = BP_TEXTURE_NOISE, .colors = {{0, 0, 0}, {2, 2, 2}}}};

enum { MATERIALS_MAX = 32 };

/* The effects of a scene under a constant sky and a pinhole, with `spheres` spheres that have the first
 * `used` of the materials in turn. */
static BpEffects analyse(const BpMaterial *materials, size_t count, size_t used, size_t spheres, double lens,
                         double top_blue) {
    BpMaterial copy[MATERIALS_MAX];
    BpSphere *list = calloc(spheres + 1, sizeof *list);
    BpEffects effects;
    assert_non_null(list);
    assert_true(count <= MATERIALS_MAX);
    if (count > 0) memcpy(copy, materials, count * sizeof *copy);
    for (size_t i = 0; i < spheres; ++i)
        list[i] = (BpSphere){.radius = 1, .material = (uint32_t)(i % used), .albedo = BP_NO_ALBEDO};
    const BpScene scene = {.camera = {.lens_radius = lens, .focus_dist = 10},
                           .background_bottom = {1, 1, 1},
                           .background_top = {1, 1, top_blue},
                           .textures = both,
                           .texture_count = 2,
                           .materials = copy,
                           .material_count = count,
                           .spheres = list,
                           .sphere_count = spheres};
    bp_effects_analyse(&scene, &effects);
    free(list);
    for (int e = 0; e < BP_EFFECT_COUNT; ++e) {
        assert_true(effects.reason[e][0] != '\0');
        assert_true(strlen(effects.reason[e]) + 1 < sizeof effects.reason[e]); /* whole */
    }
    return effects;
}

static void material_effects(void **state) {
    (void)state;
    const struct {
        BpMaterial material;
        uint32_t bits;
    } cases[] = {
        {grey, BIT(LAMBERTIAN)},
        {steel, BIT(METAL)},
        {glass, BIT(DIELECTRIC)},
        {lamp, BIT(EMISSION)},
        {black, BIT(EMISSION)}, /* the code that ends a path stands with emission */
        {ember, BIT(LAMBERTIAN) | BIT(EMISSION)},
        {debug, BIT(NORMALS)},
        {clay, BIT(OREN_NAYAR)},
        {brass, BIT(ROUGH_METAL)},
        {billiard, BIT(GLOSSY)},
        {frosted, BIT(ROUGH_DIELECTRIC)},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i)
        assert_int_equal(analyse(&cases[i].material, 1, 1, 1, 0, 1).bits, cases[i].bits);
    /* Rays go to a lamp from another sphere only, and not from mirrors and glass. */
    assert_int_equal(analyse(&ember, 1, 1, 2, 0, 1).bits, BIT(LAMBERTIAN) | BIT(EMISSION) | BIT(LAMPS));
    const BpMaterial pairs[][2] = {{grey, lamp}, {steel, lamp}, {glass, lamp}};
    const uint32_t called_for[] = {BIT(LAMBERTIAN) | BIT(EMISSION) | BIT(LAMPS), BIT(METAL) | BIT(EMISSION),
                                   BIT(DIELECTRIC) | BIT(EMISSION)};
    for (size_t i = 0; i < 3; ++i) assert_int_equal(analyse(pairs[i], 2, 2, 2, 0, 1).bits, called_for[i]);
    BpMaterial brushed = steel;
    brushed.fuzz = 1.0 / 64;
    const BpMaterial pair[] = {brushed, lamp};
    assert_int_equal(analyse(pair, 2, 2, 2, 0, 1).bits, BIT(METAL) | BIT(EMISSION) | BIT(LAMPS));
    /* Rough glass is lit, unless it is nearly smooth, or of nearly the index of its outside. */
    BpMaterial lit[] = {frosted, lamp};
    for (int i = 0; i < 4; ++i) {
        lit[0].roughness = i == 0 ? 0.06 : 1.0 / 16;
        lit[0].refraction_index = i == 1 ? 1.06 : i == 2 ? 1 / 1.06 : 1.07;
        assert_int_equal(analyse(lit, 2, 2, 2, 0, 1).bits,
                         BIT(ROUGH_DIELECTRIC) | BIT(EMISSION) | (i == 3 ? BIT(LAMPS) : 0));
    }
    const BpMaterial all[] = {grey, steel, glass, ember, debug, clay, brass, billiard, frosted};
    const size_t count = sizeof all / sizeof all[0];
    assert_int_equal(analyse(all, count, count, BP_LIST_SPHERES_MAX + 1, 0.1, 0.5).bits,
                     BP_EFFECTS_ALL & ~OF_SCENES);
    assert_int_equal(analyse(all, count, count, count, 0, 1).bits, BP_EFFECTS_ALL & ~BIT(LENS) & ~OF_SCENES);
}

static void only_materials_in_use_count(void **state) {
    (void)state;
    const BpMaterial all[] = {grey, steel, glass, lamp, debug};
    assert_int_equal(analyse(all, 5, 1, 3, 0, 1).bits, BIT(LAMBERTIAN));
    assert_int_equal(analyse(all, 5, 3, 2, 0, 1).bits, BIT(LAMBERTIAN) | BIT(METAL));
    assert_int_equal(analyse(all, 5, 5, 0, 0, 1).bits, 0);
    assert_int_equal(analyse(NULL, 0, 1, 0, 0, 1).bits, 0);
}

/* More materials than are counted at a time, three of them in use: the first, one amid them and the
 * last. */
static void twenty_thousand_materials(void **state) {
    (void)state;
    enum { COUNT = 20000 };
    BpMaterial *materials = malloc(COUNT * sizeof *materials);
    assert_non_null(materials);
    for (size_t m = 0; m < COUNT; ++m) materials[m] = debug;
    materials[0] = grey;
    materials[9000] = steel;
    materials[COUNT - 1] = ember;
    BpSphere spheres[] = {{.center = {4, 0, 0}, .radius = 1, .material = COUNT - 1, .albedo = BP_NO_ALBEDO},
                          {.center = {8, 0, 0}, .radius = 1, .material = 9000, .albedo = BP_NO_ALBEDO},
                          {.center = {12, 0, 0}, .radius = 1, .material = 0, .albedo = BP_NO_ALBEDO},
                          {.center = {16, 0, 0}, .radius = 1, .material = 9000, .albedo = BP_NO_ALBEDO}};
    const BpScene scene = {
        .materials = materials, .material_count = COUNT, .spheres = spheres, .sphere_count = 4};
    BpEffects effects;
    bp_effects_analyse(&scene, &effects);
    assert_int_equal(effects.bits, BIT(LAMBERTIAN) | BIT(METAL) | BIT(EMISSION) | BIT(LAMPS));
    assert_string_equal(effects.reason[BP_EFFECT_METAL], "1 of the 3 materials in use, on 2 of 4 spheres");
    assert_non_null(strstr(effects.reason[BP_EFFECT_NORMALS], "19997 materials would"));
    free(materials);
}

static void camera_and_sky(void **state) {
    (void)state;
    assert_int_equal(analyse(&grey, 1, 1, 1, 1e-9, 1).bits, BIT(LAMBERTIAN) | BIT(LENS));
    assert_int_equal(analyse(&grey, 1, 1, 1, 0, 0.999).bits, BIT(LAMBERTIAN)); /* a sky is a value */
}

/* A matte floor and a lamp, under a sky whose top is the darker end. */
static bool samples_lamps(double emit, double top, double camera_x, BpEffects *effects) {
    BpMaterial materials[] = {grey, lamp};
    for (int c = 0; c < 3; ++c) materials[1].emit[c] = emit;
    BpSphere spheres[] = {{.center = {0, -10, 0}, .radius = -10, .material = 0, .albedo = BP_NO_ALBEDO},
                          {.center = {0, 2, 0}, .radius = 1, .material = 1, .albedo = BP_NO_ALBEDO}};
    const BpScene scene = {.camera = {.lookfrom = {camera_x, -5, 0}},
                           .background_bottom = {1, 1, 1},
                           .background_top = {top, top, top},
                           .materials = materials,
                           .material_count = 2,
                           .spheres = spheres,
                           .sphere_count = 2};
    bp_effects_analyse(&scene, effects);
    return bp_effects_has(effects->bits, BP_EFFECT_LAMPS);
}

static void no_rays_to_lamps_that_the_sky_outshines(void **state) {
    (void)state;
    BpEffects effects;
    assert_false(samples_lamps(0.5, 0.5, 12, &effects));
    assert_string_equal(effects.reason[BP_EFFECT_LAMPS], "1 lamp, not brighter than the sky");
    assert_true(samples_lamps(0.501, 0.5, 12, &effects));
    /* Inside a sphere the sky may be hidden, whatever the sign of the radius. */
    assert_true(samples_lamps(0.5, 0.5, 8, &effects));
}

static void a_tree_above_32_spheres(void **state) {
    (void)state;
    static const struct {
        size_t spheres;
        BpAcceleration expected;
        const char *reason;
    } cases[] = {
        {0, BP_ACCELERATION_LIST, "no spheres: the picture is the sky"},
        {1, BP_ACCELERATION_LIST, "1 sphere: a list, no tree"},
        {32, BP_ACCELERATION_LIST, "32 spheres: a list, no tree"},
        {33, BP_ACCELERATION_TREE, "33 spheres, more than 32: a tree"},
        {484, BP_ACCELERATION_TREE, "484 spheres, more than 32: a tree"},
        {SIZE_MAX, BP_ACCELERATION_TREE, NULL}, /* the longest number */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const BpScene scene = {.sphere_count = cases[i].spheres};
        char reason[BP_ACCELERATION_REASON_SIZE];
        assert_int_equal(bp_acceleration_choose(&scene, reason), cases[i].expected);
        if (cases[i].reason != NULL) assert_string_equal(reason, cases[i].reason);
        assert_true(strlen(reason) + 1 < sizeof reason); /* whole */
    }
    assert_string_equal(bp_acceleration_name(BP_ACCELERATION_LIST), "list");
    assert_string_equal(bp_acceleration_name(BP_ACCELERATION_TREE), "tree");
}

static void reasons_a_person_understands(void **state) {
    (void)state;
    const BpMaterial three[] = {grey, steel, steel, glass, lamp};
    BpEffects effects = analyse(three, 3, 3, 5, 0, 1);
    assert_string_equal(effects.reason[BP_EFFECT_LAMBERTIAN],
                        "1 of the 3 materials in use, on 2 of 5 spheres");
    assert_string_equal(effects.reason[BP_EFFECT_METAL], "2 of the 3 materials in use, on 3 of 5 spheres");
    assert_string_equal(
        effects.reason[BP_EFFECT_DIELECTRIC],
        "no dielectric among the 3 materials in use: refraction, Fresnel and the inside of spheres are "
        "left out");
    assert_string_equal(effects.reason[BP_EFFECT_EMISSION], "nothing emits: none of the 3 materials in use");
    assert_string_equal(effects.reason[BP_EFFECT_LENS], "defocus_angle 0: the lens is a pinhole");

    effects = analyse(three, 5, 3, 484, 0.05, 0.7);
    assert_string_equal(
        effects.reason[BP_EFFECT_DIELECTRIC],
        "1 material would, but no sphere has it: refraction, Fresnel and the inside of spheres are left "
        "out");
    assert_string_equal(effects.reason[BP_EFFECT_LENS], "a lens of radius 0.05, in focus at 10");

    effects = analyse(three, 1, 1, 2, 0, 1);
    assert_string_equal(effects.reason[BP_EFFECT_LAMBERTIAN],
                        "the only kind of material in use, on all 2 spheres: no switch between kinds");
    assert_string_equal(effects.reason[BP_EFFECT_METAL],
                        "the only material in use is not metal: mirror reflection and fuzz are left out");
    assert_string_equal(effects.reason[BP_EFFECT_EMISSION],
                        "nothing emits: the only material in use does not");
    assert_string_equal(effects.reason[BP_EFFECT_NORMALS],
                        "nothing shows normals: the only material in use does not");
    effects = analyse(three, 1, 1, 0, 0, 1);
    assert_string_equal(effects.reason[BP_EFFECT_LAMBERTIAN], "no spheres: the picture is the sky");
}

/* A scene of one sphere, and discs in the sky, of which the first `dark` bring nothing. */
static BpEffects analyse_discs(const BpMaterial *material, size_t discs, size_t dark) {
    BpMaterial copy = *material;
    BpSphere sphere = {.radius = 1, .albedo = BP_NO_ALBEDO};
    BpEffects effects;
    BpScene scene = {.camera = {.focus_dist = 10},
                     .materials = &copy,
                     .material_count = 1,
                     .spheres = &sphere,
                     .sphere_count = 1,
                     .disc_count = discs};
    for (size_t i = 0; i < discs; ++i)
        scene.discs[i] = (BpDisc){{0, 1, 0}, 1, {0, 0, i < dark ? 0 : 1}, true};
    bp_effects_analyse(&scene, &effects);
    return effects;
}

static void discs(void **state) {
    (void)state;
    BpEffects effects = analyse_discs(&grey, 0, 0);
    assert_int_equal(effects.bits, BIT(LAMBERTIAN));
    assert_string_equal(effects.reason[BP_EFFECT_DISCS], "the background has no discs");
    assert_string_equal(effects.reason[BP_EFFECT_LAMPS], NO_LAMP);
    effects = analyse_discs(&grey, 2, 1);
    assert_int_equal(effects.bits, BIT(LAMBERTIAN) | BIT(LAMPS) | BIT(DISCS));
    assert_string_equal(effects.reason[BP_EFFECT_DISCS], "2 discs in the background");
    assert_string_equal(effects.reason[BP_EFFECT_LAMPS], "1 disc that can light 1 sphere");
    effects = analyse_discs(&grey, 1, 1);
    assert_int_equal(effects.bits, BIT(LAMBERTIAN));
    assert_string_equal(effects.reason[BP_EFFECT_DISCS], "1 disc in the background, but without light");
    /* Mirrors and glass show it, but send no rays there. */
    effects = analyse_discs(&glass, 1, 0);
    assert_int_equal(effects.bits, BIT(DIELECTRIC) | BIT(DISCS));
    assert_string_equal(effects.reason[BP_EFFECT_LAMPS],
                        "1 disc, but nothing matte, nothing of fuzz 1/64 or roughness 1/16");
    /* The one lamp cannot light itself, but the disc can light it. */
    effects = analyse_discs(&ember, 3, 0);
    assert_int_equal(effects.bits, BIT(LAMBERTIAN) | BIT(EMISSION) | BIT(LAMPS) | BIT(DISCS));
    assert_string_equal(effects.reason[BP_EFFECT_LAMPS], "1 lamp and 3 discs that can light 1 sphere");
}

/* A sky of so many texels, 8 at most, one of them this bright and the others 1. */
static BpEffects analyse_image(const BpMaterial *material, uint32_t count, float bright) {
    float texels[24];
    for (int i = 0; i < 24; ++i) texels[i] = i < 3 ? bright : 1;
    BpImage sky = {.width = count, .height = 1, .texels = texels}, *images[1] = {&sky};
    BpMaterial copy = *material;
    BpSphere sphere = {.radius = 1, .albedo = BP_NO_ALBEDO};
    BpEffects effects;
    BpScene scene = {.camera = {.focus_dist = 10},
                     .images = images,
                     .image_count = 1,
                     .environment = &sky,
                     .materials = &copy,
                     .material_count = 1,
                     .spheres = &sphere,
                     .sphere_count = 1};
    assert_int_equal(bp_texels_finish(&sky, 1, "", NULL), BP_OK);
    assert_true(fabs(sky.mean - ((double)bright + count - 1) / count) < 1e-6 * sky.mean);
    bp_effects_analyse(&scene, &effects);
    return effects;
}

/* An image as background is sampled where its light varies by more than its mean. */
static void an_image_around(void **state) {
    (void)state;
    BpEffects effects = analyse_image(&grey, 2, 1000);
    assert_int_equal(effects.bits, BIT(LAMBERTIAN) | BIT(ENVIRONMENT));
    assert_string_equal(effects.reason[BP_EFFECT_ENVIRONMENT], "an image of 2 by 1 texels");
    assert_string_equal(effects.reason[BP_EFFECT_LAMPS], NO_LAMP);
    effects = analyse_image(&grey, 8, 1000);
    assert_int_equal(effects.bits, BIT(LAMBERTIAN) | BIT(ENVIRONMENT) | BIT(LAMPS));
    assert_string_equal(effects.reason[BP_EFFECT_LAMPS], "the image around that can light 1 sphere");
    effects = analyse_image(&ember, 8, 1000);
    assert_string_equal(effects.reason[BP_EFFECT_LAMPS],
                        "the image around and 1 lamp that can light 1 sphere");
    effects = analyse_image(&glass, 8, 1000);
    assert_int_equal(effects.bits, BIT(DIELECTRIC) | BIT(ENVIRONMENT));
    effects = analyse_image(&grey, 8, 1);
    assert_int_equal(effects.bits, BIT(LAMBERTIAN) | BIT(ENVIRONMENT));
}

static void textures(void **state) {
    (void)state;
    BpTexture checker = both[0];
    BpMaterial materials[3] = {grey, lamp, steel};
    BpEffects effects = analyse(materials, 3, 3, 4, 0, 1);
    assert_int_equal(effects.bits & BIT(TEXTURES), 0);
    assert_string_equal(effects.reason[BP_EFFECT_TEXTURES], "no material has a texture");
    bp_member_vary(&materials[2], BP_MEMBER_FUZZ, 1, &checker);
    effects = analyse(materials, 3, 2, 4, 0, 1);
    assert_int_equal(effects.bits & BIT(TEXTURES), 0);
    assert_string_equal(effects.reason[BP_EFFECT_TEXTURES], "1 material has textures, but no sphere has it");
    effects = analyse(materials, 3, 3, 4, 0, 1);
    assert_int_equal(effects.bits & BIT(TEXTURES), BIT(TEXTURES));
    assert_string_equal(effects.reason[BP_EFFECT_TEXTURES], "1 material with textures, on 1 of 4 spheres");
    bp_member_vary(&materials[0], BP_MEMBER_EMIT, 1, &checker);
    effects = analyse(materials, 1, 1, 4, 0, 1);
    assert_string_equal(effects.reason[BP_EFFECT_TEXTURES], "1 material with textures, on 4 of 4 spheres");
    assert_int_equal(effects.bits & BIT(NOISE), 0);
    assert_string_equal(effects.reason[BP_EFFECT_NOISE], "no material has a texture of noise");
    /* Whatever it gives light anywhere is a lamp. */
    assert_int_equal(effects.bits, BIT(TEXTURES) | BIT(LAMBERTIAN) | BIT(EMISSION) | BIT(LAMPS));
    bp_member_vary(&materials[2], BP_MEMBER_FUZZ, 2, &both[1]);
    effects = analyse(materials, 3, 3, 4, 0, 1);
    assert_int_equal(effects.bits & (BIT(TEXTURES) | BIT(NOISE)), BIT(TEXTURES) | BIT(NOISE));
    assert_string_equal(effects.reason[BP_EFFECT_TEXTURES], "2 materials with textures, on 3 of 4 spheres");
    assert_string_equal(effects.reason[BP_EFFECT_NOISE], "1 material with noise, on 1 of 4 spheres");
    effects = analyse(materials, 3, 2, 4, 0, 1);
    assert_int_equal(effects.bits & BIT(NOISE), 0);
    assert_string_equal(effects.reason[BP_EFFECT_NOISE], "1 material has noise, but no sphere has it");
    /* Nowhere: it is none. */
    checker.colors[1][0] = checker.colors[1][1] = checker.colors[1][2] = 0;
    bp_member_vary(&materials[0], BP_MEMBER_EMIT, 1, &checker);
    effects = analyse(materials, 1, 1, 4, 0, 1);
    assert_int_equal(effects.bits, BIT(TEXTURES) | BIT(LAMBERTIAN));
}

static void one_list_names_them(void **state) {
    (void)state;
    assert_string_equal(bp_effect_name(BP_EFFECT_DIELECTRIC), "dielectric");
    assert_string_equal(bp_effect_identifier(BP_EFFECT_DIELECTRIC), "DIELECTRIC");
    for (int a = 0; a < BP_EFFECT_COUNT; ++a)
        for (int b = 0; b < a; ++b)
            assert_string_not_equal(bp_effect_name((BpEffect)a), bp_effect_name((BpEffect)b));
    assert_int_equal(BP_EFFECTS_ALL, (1u << BP_EFFECT_COUNT) - 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(material_effects),
        cmocka_unit_test(only_materials_in_use_count),
        cmocka_unit_test(twenty_thousand_materials),
        cmocka_unit_test(camera_and_sky),
        cmocka_unit_test(a_tree_above_32_spheres),
        cmocka_unit_test(reasons_a_person_understands),
        cmocka_unit_test(discs),
        cmocka_unit_test(an_image_around),
        cmocka_unit_test(textures),
        cmocka_unit_test(no_rays_to_lamps_that_the_sky_outshines),
        cmocka_unit_test(one_list_names_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
