/* effects_scenes.h: a small scene for every set of effects that can occur, with a list and with a tree.
 *
 * In:    a set of bits, list or tree.   Out: a scene that calls for exactly these effects, with every
 * sub-kind of each (lobes, fuzz shapes, Fresnel, total reflection), for tests of specialised kernels.
 * Knows: BpScene, the effects.   Does not know: kernels. */
#ifndef TESTS_DEVICE_EFFECTS_SCENES_H
#define TESTS_DEVICE_EFFECTS_SCENES_H

#include "packed/acceleration.h"
#include "packed/effects.h"
#include "support/covering.h"

#include <string.h>

#define EFFECT_BIT(effect) (1u << BP_EFFECT_##effect)
#define MATERIAL_EFFECTS                                                                                     \
    (EFFECT_BIT(LAMBERTIAN) | EFFECT_BIT(METAL) | EFFECT_BIT(DIELECTRIC) | EFFECT_BIT(EMISSION) |            \
     EFFECT_BIT(NORMALS) | EFFECT_BIT(MEDIA) | EFFECT_BIT(OREN_NAYAR) | EFFECT_BIT(ROUGH_METAL) |            \
     EFFECT_BIT(GLOSSY) | EFFECT_BIT(ROUGH_DIELECTRIC))

typedef struct EffectsScene {
    BpScene scene; /* points into the arrays below: pass it on by address, do not copy it */
    BpMaterial materials[29];
    BpSphere spheres[48];
    BpTriangle triangles[8];
    float normals[3][3][3], coordinates[8][6];
    BpCapsule capsules[4];
    BpTexture textures[10];
    BpImage image, sky, light, *images[3];
    float image_texels[5 * 3 * 3], sky_texels[8 * 4 * 3], light_texels[2 * 3];
    double ends[48][3];
    BpMedium media[2];
    uint32_t interiors[48], triangle_interiors[8], capsule_interiors[4];
    BpBody body;
    uint32_t body_of[8];
} EffectsScene;

/* A tree is a choice like an effect. */
#define EFFECTS_TREE (1u << BP_EFFECT_COUNT)

/* What lights, and what is lit by rays to lamps. */
#define EFFECTS_LIGHTS (EFFECT_BIT(EMISSION) | EFFECT_BIT(DISCS) | EFFECT_BIT(ENVIRONMENT))
#define EFFECTS_LIT                                                                                          \
    (EFFECT_BIT(LAMBERTIAN) | EFFECT_BIT(METAL) | EFFECT_BIT(MEDIA) | EFFECT_BIT(OREN_NAYAR) |               \
     EFFECT_BIT(ROUGH_METAL) | EFFECT_BIT(GLOSSY) | EFFECT_BIT(ROUGH_DIELECTRIC))

/* No scene has all of the first and nothing of the second. */
static const CoveringRule effects_rules[] = {
    {EFFECT_BIT(LAMPS), EFFECTS_LIGHTS},
    {EFFECT_BIT(LAMPS), EFFECTS_LIT},
    {EFFECT_BIT(CAUSTICS), 0}, /* only where it is asked for: tests/lamps */
    /* Something keeps light; what is matte or metal does here. */
    {EFFECT_BIT(ROULETTE), EFFECTS_LIT},
    /* A tree needs spheres, and spheres need a material. Textures are of spheres, and spheres move. */
    {EFFECTS_TREE, MATERIAL_EFFECTS},
    {EFFECT_BIT(TEXTURES), MATERIAL_EFFECTS},
    {EFFECT_BIT(MOTION), MATERIAL_EFFECTS},
    {EFFECT_BIT(NOISE), EFFECT_BIT(TEXTURES)},
    {EFFECT_BIT(IMAGES), EFFECT_BIT(TEXTURES)},
    /* In these scenes they have the first two materials, which are matte or metal. */
    {EFFECT_BIT(TRIANGLES), EFFECT_BIT(LAMBERTIAN) | EFFECT_BIT(METAL)},
    {EFFECT_BIT(CAPSULES), EFFECT_BIT(LAMBERTIAN) | EFFECT_BIT(METAL)},
    /* Rays are sent to them where they are sent to others, and there are some. */
    {EFFECT_BIT(TRIANGLE_LAMPS), EFFECT_BIT(TRIANGLES)},
    {EFFECT_BIT(TRIANGLE_LAMPS), EFFECT_BIT(LAMPS)},
    {EFFECT_BIT(TRIANGLE_LAMPS), EFFECT_BIT(EMISSION)},
    {EFFECT_BIT(SMOOTH_NORMALS), EFFECT_BIT(TRIANGLES)},
    {EFFECT_BIT(TEXTURE_COORDINATES), EFFECT_BIT(TRIANGLES)},
    {EFFECT_BIT(TEXTURE_COORDINATES), EFFECT_BIT(TEXTURES)},
    /* Boundaries of media. */
    {EFFECT_BIT(BODY_MEDIA), EFFECT_BIT(MEDIA)},
    {EFFECT_BIT(BODY_MEDIA), EFFECT_BIT(TRIANGLES) | EFFECT_BIT(CAPSULES)},
    /* Glass has it where no media do. */
    {EFFECT_BIT(OPACITY),
     MATERIAL_EFFECTS & ~(EFFECT_BIT(DIELECTRIC) | EFFECT_BIT(MEDIA) | EFFECT_BIT(ROUGH_DIELECTRIC))},
    /* Of an image around it knows no light. */
    {EFFECT_BIT(SHADOW_CATCHER) | EFFECT_BIT(ENVIRONMENT), 0},
};
static const CoveringRules effects_all_rules = {effects_rules, sizeof effects_rules / sizeof *effects_rules};

static inline BpMaterial *effects_material(EffectsScene *made, BpMaterialKind kind, double r, double g,
                                           double b) {
    BpMaterial *material = &made->materials[made->scene.material_count++];
    *material = (BpMaterial){.name = (char *)"m", .kind = kind, .albedo = {r, g, b}, .refraction_index = 1.5};
    return material;
}

static inline void effects_materials(EffectsScene *made, uint32_t bits) {
    if (bp_effects_has(bits, BP_EFFECT_LAMBERTIAN)) {
        effects_material(made, BP_MATERIAL_LAMBERTIAN, 0.8, 0.3, 0.3)->scatter = BP_SCATTER_COSINE_CUBED;
        effects_material(made, BP_MATERIAL_LAMBERTIAN, 0.3, 0.8, 0.3)->scatter = BP_SCATTER_HEMISPHERE;
        BpMaterial *ember = effects_material(made, BP_MATERIAL_LAMBERTIAN, 0.5, 0.5, 0.5);
        if (bp_effects_has(bits, BP_EFFECT_EMISSION)) ember->emit[0] = 0.25;
    }
    if (bp_effects_has(bits, BP_EFFECT_METAL)) {
        effects_material(made, BP_MATERIAL_METAL, 0.9, 0.8, 0.7);
        effects_material(made, BP_MATERIAL_METAL, 0.7, 0.8, 0.9)->fuzz = 0.4;
        BpMaterial *ball = effects_material(made, BP_MATERIAL_METAL, 0.8, 0.8, 0.8);
        ball->fuzz = 1;
        ball->fuzz_shape = BP_FUZZ_BALL;
    }
    if (bp_effects_has(bits, BP_EFFECT_DIELECTRIC)) {
        effects_material(made, BP_MATERIAL_DIELECTRIC, 1, 1, 1);
        BpMaterial *exact = effects_material(made, BP_MATERIAL_DIELECTRIC, 1, 1, 1);
        exact->fresnel = BP_FRESNEL_EXACT;
        exact->total_reflection = BP_TOTAL_ABSORB;
        BpMaterial *none = effects_material(made, BP_MATERIAL_DIELECTRIC, 1, 1, 1);
        none->refraction_index = 1 / 1.3;
        none->fresnel = BP_FRESNEL_NONE;
        none->total_reflection = BP_TOTAL_REFRACT;
        effects_material(made, BP_MATERIAL_DIELECTRIC, 1, 1, 1)->refraction_index = 1;
    }
    if (bp_effects_has(bits, BP_EFFECT_EMISSION)) {
        BpMaterial *lamp = effects_material(made, BP_MATERIAL_DIFFUSE_LIGHT, 0, 0, 0);
        lamp->emit[0] = 4, lamp->emit[1] = 3, lamp->emit[2] = 0.5;
        effects_material(made, BP_MATERIAL_DIFFUSE_LIGHT, 0, 0, 0); /* black */
    }
    const int shown = bp_effects_has(bits, BP_EFFECT_IMAGES) ? 2 : 1;
    for (int i = 0; i < shown && bp_effects_has(bits, BP_EFFECT_OREN_NAYAR); ++i)
        effects_material(made, BP_MATERIAL_OREN_NAYAR, 0.8, 0.6, 0.4)->roughness = 0.9;
    for (int i = 0; i < shown && bp_effects_has(bits, BP_EFFECT_ROUGH_METAL); ++i)
        effects_material(made, BP_MATERIAL_ROUGH_METAL, 0.9, 0.8, 0.5)->roughness = 0.6;
    if (bp_effects_has(bits, BP_EFFECT_GLOSSY)) {
        effects_material(made, BP_MATERIAL_GLOSSY, 0.8, 0.3, 0.3);
        effects_material(made, BP_MATERIAL_GLOSSY, 0.3, 0.3, 0.8)->roughness = 0.5;
    }
    if (bp_effects_has(bits, BP_EFFECT_ROUGH_DIELECTRIC)) {
        effects_material(made, BP_MATERIAL_ROUGH_DIELECTRIC, 1, 1, 1)->roughness = 0.5;
        BpMaterial *thin = effects_material(made, BP_MATERIAL_ROUGH_DIELECTRIC, 1, 1, 1);
        thin->roughness = 0.3;
        thin->refraction_index = 1 / 1.3;
    }
    for (int i = 0; i < shown && bp_effects_has(bits, BP_EFFECT_NORMALS); ++i)
        effects_material(made, BP_MATERIAL_NORMALS, 0, 0, 0);
    if (bp_effects_has(bits, BP_EFFECT_MEDIA)) effects_material(made, BP_MATERIAL_INTERFACE, 1, 1, 1);
}

/* All but every third material let light straight on, except for boundaries of media. */
static inline void effects_opacity(EffectsScene *made, bool media) {
    for (size_t m = 0; m < made->scene.material_count; ++m) {
        BpMaterial *material = &made->materials[m];
        if (bp_material_is(material->kind, BP_HAS_INSIDE) && media) continue;
        if (m % 3 != 2 && bp_material_has(material->kind, BP_MEMBER_OPACITY))
            material->opacity = m % 3 == 0 ? 0.4 : 0.75;
    }
}

/* A member varies where there is one that does; without light there is always one that is black. */
static inline void effects_vary(EffectsScene *made, size_t material, BpMember member, uint32_t number) {
    BpMaterial *varied = &made->materials[material];
    if (bp_material_has(varied->kind, member))
        bp_member_vary(varied, member, number, &made->textures[number - 1]);
}

/* One of each pattern, and one of light. */
static inline void effects_noise(EffectsScene *made, double light) {
    for (int i = 0; i < 5; ++i) {
        BpTexture *noise = &made->textures[3 + i];
        bp_texture_defaults(noise);
        noise->type = BP_TEXTURE_NOISE;
        noise->pattern = i < 4 ? (BpPattern)i : BP_PATTERN_PERLIN;
        noise->size = 0.2;
        bp_texture_pattern_defaults(noise);
        noise->octaves = 1 + (uint32_t)i;
        noise->axis = i % 3;
        noise->colors[1][i % 3] = i < 4 ? 0.9 : light;
        noise->colors[0][2] = i < 4 ? 0.4 : 0;
    }
}

/* An image of colours, one of a sky with a sun, and one of light. A failure shows in the pictures: they have
 * no texels. */
static inline void effects_images(EffectsScene *made, float light) {
    for (int i = 0; i < 5 * 3 * 3; ++i) made->image_texels[i] = (float)(i * 7 % 11) / 10;
    for (int i = 0; i < 8 * 4 * 3; ++i) made->sky_texels[i] = 0.1f + (float)(i * 5 % 7) / 20;
    for (int c = 0; c < 3; ++c) made->sky_texels[3 * 13 + c] = (float)(60 - 10 * c);
    made->light_texels[1] = made->light_texels[3] = light;
    made->image = (BpImage){.width = 5, .height = 3, .texels = made->image_texels};
    made->sky = (BpImage){.width = 8, .height = 4, .texels = made->sky_texels};
    made->light = (BpImage){.width = 2, .height = 1, .texels = made->light_texels};
    made->images[0] = &made->image;
    made->images[1] = &made->sky;
    made->images[2] = &made->light;
    made->scene.images = made->images;
    if (bp_texels_finish(&made->image, 1, "", NULL) == BP_OK &&
        bp_texels_finish(&made->sky, 1, "", NULL) == BP_OK &&
        bp_texels_finish(&made->light, 1, "", NULL) == BP_OK)
        made->scene.image_count = 3;
}

/* Colours, repeated, and light, clamped, as textures 9 and 10. */
static inline void effects_image_textures(EffectsScene *made) {
    for (int i = 8; i < 10; ++i) {
        BpTexture *texture = &made->textures[i];
        bp_texture_defaults(texture);
        texture->type = BP_TEXTURE_IMAGE;
        texture->mapping = BP_MAPPING_SURFACE;
        texture->image = i == 8 ? &made->image : &made->light;
        texture->repeat[0] = 2;
        texture->wrap = i == 8 ? BP_WRAP_REPEAT : BP_WRAP_CLAMP;
        texture->up[2] = i;
    }
    made->scene.texture_count = 10;
}

static inline void effects_textures(EffectsScene *made, uint32_t bits) {
    const bool emits = bp_effects_has(bits, BP_EFFECT_EMISSION),
               noise = bp_effects_has(bits, BP_EFFECT_NOISE);
    const double light = emits ? 3 : 0;
    for (int i = 0; i < 3; ++i) bp_texture_defaults(&made->textures[i]);
    made->textures[0].colors[0][0] = 0.9, made->textures[0].colors[1][2] = 0.7;
    made->textures[0].size = 0.17;
    made->textures[1].colors[1][0] = made->textures[1].colors[1][1] = made->textures[1].colors[1][2] = 0.6;
    made->textures[1].mapping = BP_MAPPING_SURFACE;
    made->textures[1].up[0] = 1;
    made->textures[1].repeat[0] = 9;
    made->textures[2].colors[0][1] = light;
    made->textures[2].mapping = BP_MAPPING_SURFACE;
    made->textures[2].repeat[1] = 2;
    made->scene.textures = made->textures;
    effects_noise(made, light);
    made->scene.texture_count = 8;
    const bool images = bp_effects_has(bits, BP_EFFECT_IMAGES);
    if (images) effects_image_textures(made);
    for (size_t m = 0; m < made->scene.material_count; ++m) {
        effects_vary(made, m, BP_MEMBER_ALBEDO,
                     images && m % 2 == 1  ? 9
                     : noise && m % 2 == 0 ? 4 + (uint32_t)(m / 2 % 4)
                                           : 1 + (uint32_t)(m % 2));
        if (m % 2 == 1) effects_vary(made, m, BP_MEMBER_FUZZ, 2);
        /* Of glass, of what shows its normal, of black lamps and, if nothing emits, without light. */
        const BpMaterialKind kind = made->materials[m].kind;
        if (kind != BP_MATERIAL_LAMBERTIAN && kind != BP_MATERIAL_METAL)
            effects_vary(made, m, BP_MEMBER_EMIT, images && m % 2 == 1 ? 10 : noise ? 8 : 3);
    }
}

/* A ground, a row of spheres that overlap and repeat (of equal ones the first must be met), bubbles, and with
 * a tree two more rows. */
static inline void effects_spheres(EffectsScene *made, bool tree) {
    const size_t others = made->scene.triangle_count + made->scene.capsule_count;
    const size_t count = tree ? 48 : BP_LIST_SPHERES_MAX - others;
    const size_t materials = made->scene.material_count;
    if (materials == 0) return;
    for (size_t i = 0; i < count; ++i) {
        BpSphere *sphere = &made->spheres[i];
        const double column = (double)(i % 8), row = (double)(i / 8);
        *sphere = (BpSphere){.center = {column - 3.5, 0.1 * row, -2 - 0.9 * row},
                             .radius = 0.5,
                             .material = (uint32_t)(i % materials),
                             .albedo = BP_NO_ALBEDO};
        const bool glass = bp_material_is(made->materials[sphere->material].kind, BP_HAS_INSIDE);
        if (glass && i % 3 == 0) sphere->radius = -0.4; /* inside out */
        if (!glass && i % 5 == 4) {                     /* again where one stands, in another material */
            const BpSphere *before = &made->spheres[i - 1];
            memcpy(sphere->center, before->center, sizeof sphere->center);
            if (!bp_material_is(made->materials[before->material].kind, BP_HAS_INSIDE))
                sphere->radius = before->radius;
        }
    }
    made->spheres[0] = (BpSphere){.center = {0, -100.5, -2}, .radius = 100, .albedo = BP_NO_ALBEDO};
    made->scene.sphere_count = count;
}

/* A folded wall of two triangles that share an edge and lie partly behind spheres, and two that cross each
 * other. The last one emits where one does. Where textures lie on triangles they do on one of each pair and
 * on what emits, beyond their first tile too; else all have materials whose textures fill space. */
static inline void effects_triangles(EffectsScene *made, uint32_t bits) {
    static const double at[4][3][3] = {{{-4, -0.5, -6}, {0.5, -0.5, -5}, {0.5, 3, -5}},
                                       {{-4, -0.5, -6}, {0.5, 3, -5}, {-4, 3, -6}},
                                       {{1, -0.4, -3}, {3, -0.4, -3}, {2, 1.5, -2}},
                                       {{2, -0.4, -4}, {2, -0.4, -2}, {2.5, 1.2, -3}}};
    made->scene.triangles = made->triangles;
    made->scene.triangle_count = 4;
    for (int i = 0; i < 4; ++i) {
        memcpy(made->triangles[i].vertices, at[i], sizeof at[i]);
        made->triangles[i].albedo = BP_NO_ALBEDO;
    }
    /* Of one wall, bulging and on either side of the plane, and of one triangle that crosses another. */
    static const float normals[3][3][3] = {{{-0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}, {0, -0.8f, -0.6f}},
                                           {{0}},
                                           {{-0.8f, 0, 0.6f}, {0.8f, 0, 0.6f}, {0, 1, 0}}};
    if (bp_effects_has(bits, BP_EFFECT_SMOOTH_NORMALS)) {
        memcpy(made->normals, normals, sizeof normals);
        made->scene.normals = made->normals;
        made->scene.normal_count = 3;
    }
    static const float coordinates[4][6] = {
        {0}, {-1.25f, 0.5f, 2.5f, 3.25f, -1, 2}, {0, 0, 1, 0, 0.5f, 1}, {0, -0.25f, 1.5f, 0, 0.5f, 1}};
    const bool mapped = bp_effects_has(bits, BP_EFFECT_TEXTURE_COORDINATES);
    if (mapped) {
        memcpy(made->coordinates, coordinates, sizeof coordinates);
        made->scene.coordinates = made->coordinates;
        made->scene.coordinate_count = 4;
        made->triangles[1].material = made->triangles[2].material = 1;
    }
    if (!bp_effects_has(bits, BP_EFFECT_TRIANGLE_LAMPS)) return;
    made->triangles[3].material = (uint32_t)made->scene.material_count;
    BpMaterial *lamp = effects_material(made, BP_MATERIAL_DIFFUSE_LIGHT, 0, 0, 0);
    lamp->emit[0] = 4, lamp->emit[1] = 3, lamp->emit[2] = 0.5;
    if (mapped)
        effects_vary(made, made->triangles[3].material, BP_MEMBER_EMIT,
                     bp_effects_has(bits, BP_EFFECT_IMAGES) ? 10 : 3);
}

/* One has no length, one crosses another, and one lies behind spheres. */
static inline void effects_capsules(EffectsScene *made) {
    static const double at[4][2][3] = {{{-2, 1.5, -4}, {1, 0.5, -3}},
                                       {{-1, 0.2, -3.5}, {0, 1.8, -3.5}},
                                       {{1.5, 1.5, -4}, {1.5, 1.5, -4}},
                                       {{-1.5, -0.3, -1.2}, {1.5, -0.2, -1.8}}};
    made->scene.capsules = made->capsules;
    made->scene.capsule_count = 4;
    for (int i = 0; i < 4; ++i) {
        memcpy(made->capsules[i].ends, at[i], sizeof at[i]);
        made->capsules[i].radius = 0.1 + 0.05 * i;
        made->capsules[i].albedo[0] = made->capsules[i].albedo[1] = BP_NO_ALBEDO;
    }
}

/* A pyramid in front of the wall and among spheres, of a material that lets light in: the last four
 * triangles. */
static inline void effects_body(EffectsScene *made, uint32_t material) {
    static const double at[4][3] = {
        {-1.2, -0.4, -2.5}, {0.8, -0.4, -2.2}, {-0.1, -0.3, -3.6}, {-0.2, 1.1, -2.8}};
    static const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    BpScene *scene = &made->scene;
    for (int i = 0; i < 4; ++i) {
        BpTriangle *triangle = &made->triangles[scene->triangle_count++];
        for (int k = 0; k < 3; ++k) memcpy(triangle->vertices[k], at[faces[i][k]], sizeof at[0]);
        triangle->material = material;
        triangle->albedo = BP_NO_ALBEDO;
    }
    for (int i = 4; i < 8; ++i) made->triangle_interiors[i] = 1;
    scene->triangle_interiors = made->triangle_interiors;
    scene->triangle_interior_count = 8;
    made->body = (BpBody){.first = 4, .material = material, .interior = 1, .volume = 0.6};
    for (uint32_t i = 0; i < 8; ++i) made->body_of[i] = i < 4 ? BP_NO_BODY : 0;
    scene->bodies = (BpBodies){&made->body, 1, made->body_of};
}

/* It, and the last capsule, in sets where they are boundaries. */
static inline void effects_bodies(EffectsScene *made) {
    /* One without textures, which lie around spheres. */
    const uint32_t edge = (uint32_t)made->scene.material_count;
    effects_material(made, BP_MATERIAL_INTERFACE, 1, 1, 1);
    if (made->scene.triangle_count > 0) effects_body(made, edge);
    if (made->scene.capsule_count == 0) return;
    made->capsules[3].material = edge;
    made->capsule_interiors[3] = 2;
    made->scene.capsule_interiors = made->capsule_interiors;
    made->scene.capsule_interior_count = 4;
}

/* Media in most of what light passes through, and around all in every fifth set where something emits:
 * without an end they hide the sky. */
static inline void effects_media(EffectsScene *made, uint32_t bits) {
    made->media[0] = (BpMedium){
        .name = (char *)"grey", .absorption = {0.5, 0.5, 0.5}, .scattering = {2, 2, 2}, .anisotropy = 0.4};
    made->media[1] = (BpMedium){.name = (char *)"ink", .absorption = {0, 1, 2}, .scattering = {0.5, 0, 3}};
    made->scene.media = made->media;
    made->scene.medium_count = 2;
    made->scene.medium = bits % 5 == 0 && bp_effects_has(bits, BP_EFFECT_EMISSION) ? 1 : 0;
    made->scene.interiors = made->interiors;
    made->scene.interior_count = made->scene.sphere_count;
    for (size_t i = 0; i < made->scene.sphere_count; ++i)
        if (bp_material_is(made->materials[made->spheres[i].material].kind, BP_HAS_INSIDE))
            made->interiors[i] = (uint32_t)(i / 2 % 3);
}

/* Every third sphere moves, if it is not the ground; those that share a place with one at rest leave it. */
static inline void effects_motion(EffectsScene *made) {
    made->scene.center_ends = made->ends;
    made->scene.moving_count = made->scene.sphere_count;
    for (size_t i = 0; i < made->scene.sphere_count; ++i) {
        memcpy(made->ends[i], made->spheres[i].center, sizeof made->ends[i]);
        if (i % 3 == 1) made->ends[i][i % 2] += 0.3;
    }
}

/* Odd sides, so that a pixel's centre can lie exactly on the axis; sets with an even number of effects are
 * sampled in the centre only. */
static inline void effects_scene(EffectsScene *made, uint32_t bits, bool tree) {
    memset(made, 0, sizeof *made);
    BpScene *scene = &made->scene;
    scene->materials = made->materials;
    scene->spheres = made->spheres;
    unsigned effects = 0;
    for (int e = 0; e < BP_EFFECT_COUNT; ++e) effects += bp_effects_has(bits, (BpEffect)e);
    scene->camera = (BpCamera){.width = 33,
                               .height = 17,
                               .aspect_ratio = 33.0 / 17.0,
                               .samples_per_pixel = 6,
                               .max_depth = bp_effects_has(bits, BP_EFFECT_ROULETTE) ? 30 : 8,
                               .vfov_degrees = 60,
                               .lookat = {0, 0, -1},
                               .vup = {0, 1, 0},
                               .lens_radius = bp_effects_has(bits, BP_EFFECT_LENS) ? 0.1 : 0,
                               .focus_dist = 2,
                               .pixel_sampling = effects % 2 == 0 ? BP_PIXEL_CENTER : BP_PIXEL_SQUARE};
    for (int c = 0; c < 3; ++c) {
        scene->background_bottom[c] = 0.9 - 0.2 * c;
        scene->background_top[c] =
            scene->background_bottom[c] - (bits % 3 != 0 ? 0.4 : 0); /* most are gradients */
    }
    /* They overlap, and the camera sees the second, or would. */
    scene->disc_count = bp_effects_has(bits, BP_EFFECT_DISCS) ? 3 : 0;
    scene->discs[0] = (BpDisc){{1, 2, 0.5}, 3, {40, 30, 20}, true};
    scene->discs[1] = (BpDisc){{0.1, 0.2, -1}, 12, {0.5, 1, 2}, bits % 2 == 0};
    scene->discs[2] = (BpDisc){{0, 1, -0.5}, 60, {0.1, 0.3, 0.2}, true};
    effects_images(made, bp_effects_has(bits, BP_EFFECT_EMISSION) ? 3 : 0);
    if (bp_effects_has(bits, BP_EFFECT_ENVIRONMENT)) {
        scene->environment = &made->sky;
        scene->environment_turn = 20;
    }
    if (bp_effects_has(bits, BP_EFFECT_SHADOW_CATCHER))
        scene->shadow_catcher =
            (BpShadowCatcher){.present = true, .normal = {0.28, 0.96, 0}, .distance = -0.25};
    effects_materials(made, bits);
    if (bp_effects_has(bits, BP_EFFECT_OPACITY)) effects_opacity(made, bp_effects_has(bits, BP_EFFECT_MEDIA));
    if (bp_effects_has(bits, BP_EFFECT_TEXTURES)) effects_textures(made, bits);
    if (bp_effects_has(bits, BP_EFFECT_TRIANGLES)) effects_triangles(made, bits);
    if (bp_effects_has(bits, BP_EFFECT_CAPSULES)) effects_capsules(made);
    if (bp_effects_has(bits, BP_EFFECT_BODY_MEDIA)) effects_bodies(made);
    effects_spheres(made, tree);
    if (bp_effects_has(bits, BP_EFFECT_MOTION)) effects_motion(made);
    if (bp_effects_has(bits, BP_EFFECT_MEDIA)) effects_media(made, bits);
}

#endif
