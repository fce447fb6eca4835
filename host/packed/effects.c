/* effects.c: see effects.h. */
#include "effects.h"

#include "base/color.h"
#include "base/plural.h"
#include "environment_table.h"
#include "focusers.h"
#include "lamp_tree.h"
#include "roulette_types.h"
#include "scene/material.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const struct {
    const char *identifier, *name, *text, *left_out, *absent;
} texts[BP_EFFECT_COUNT] = {
#define EFFECT_TEXTS(identifier, name, text, left_out, absent)                                               \
    [BP_EFFECT_##identifier] = {#identifier, name, text, left_out, absent},
    BP_EFFECT_LIST(EFFECT_TEXTS)
#undef EFFECT_TEXTS
};

const char *bp_effect_name(BpEffect effect) {
    return texts[effect].name;
}

const char *bp_effect_identifier(BpEffect effect) {
    return texts[effect].identifier;
}

/* How many materials, and how many spheres with them, call for one effect. */
typedef struct Use {
    size_t materials, spheres,
        unused; /* spheres: triangles too; unused: materials that would, but that none has */
} Use;

static bool is_bright(const double radiance[3]) {
    return radiance[0] > 0 || radiance[1] > 0 || radiance[2] > 0;
}

/* The effects that a material needs if a sphere has it. A lamp always needs EMISSION, even with radiance 0,
 * since that code ends the path there. */
static uint32_t material_bits(const BpMaterial *material) {
    static const BpEffect of_kind[] = {
#define EFFECT_OF(identifier, name, kernel_kind, effect, traits, weight, members, needed, outcome)           \
    [BP_MATERIAL_##identifier] = BP_EFFECT_##effect,
        BP_MATERIAL_LIST(EFFECT_OF)
#undef EFFECT_OF
    };
    uint32_t bits = 1u << of_kind[material->kind];
    if (is_bright(material->emit)) bits |= 1u << BP_EFFECT_EMISSION;
    return bits;
}

static void explain_material(BpEffect effect, const char *noun, const Use *use, const Use *all, bool one_kind,
                             size_t size, char *reason) {
    const char *name = bp_effect_name(effect);
    char in_use[64];
    snprintf(in_use, sizeof in_use, "none of the %zu materials in use", all->materials);
    char kinds[64] = "", spheres[48];
    snprintf(spheres, sizeof spheres, "the only %s", noun);
    if (all->spheres > 1) snprintf(spheres, sizeof spheres, "all %zu %ss", all->spheres, noun);
    if (all->materials > 1) snprintf(kinds, sizeof kinds, " (%zu of it)", all->materials);
    if (use->materials > 0 && one_kind)
        snprintf(reason, size, "the only kind of material in use%s, on %s: no switch between kinds", kinds,
                 spheres);
    else if (use->materials > 0)
        snprintf(reason, size, "%zu of the %zu material%s in use, on %zu of %zu %s%s", use->materials,
                 all->materials, bp_plural(all->materials), use->spheres, all->spheres, noun,
                 bp_plural(all->spheres));
    else if (all->spheres == 0)
        snprintf(reason, size, "no spheres: the picture is the sky");
    else if (use->unused > 0)
        snprintf(reason, size, "%zu material%s would, but no %s has %s: %s", use->unused,
                 bp_plural(use->unused), noun, use->unused == 1 ? "it" : "them", texts[effect].left_out);
    else if (texts[effect].absent[0] != '\0')
        snprintf(reason, size, "%s: %s", texts[effect].absent,
                 all->materials == 1 ? "the only material in use does not" : in_use);
    else if (all->materials == 1)
        snprintf(reason, size, "the only material in use is not %s: %s", name, texts[effect].left_out);
    else
        snprintf(reason, size, "no %s among the %zu materials in use: %s", name, all->materials,
                 texts[effect].left_out);
}

/* Materials whose spheres are counted in one pass over the spheres: on the stack, since what is found here
 * decides about the picture, and so must not depend on whether there is memory. */
#define MATERIALS_AT_ONCE 8192u

/* Fills `uses` (one an effect) and `all`, and returns the bits. */
static uint32_t count_uses(const BpScene *scene, Use uses[BP_EFFECT_COUNT], Use *all) {
    uint32_t spheres_with[MATERIALS_AT_ONCE], bits = 0;
    memset(uses, 0, BP_EFFECT_COUNT * sizeof *uses);
    *all = (Use){.spheres = bp_scene_shapes(scene)};
    for (size_t first = 0; first < scene->material_count; first += MATERIALS_AT_ONCE) {
        memset(spheres_with, 0, sizeof spheres_with);
        for (size_t i = 0; i < bp_scene_shapes(scene); ++i) {
            const size_t place = (size_t)bp_shape_material(scene, i) - first; /* huge for those before */
            if (place < MATERIALS_AT_ONCE) ++spheres_with[place];
        }
        for (size_t m = first; m < scene->material_count && m - first < MATERIALS_AT_ONCE; ++m) {
            const uint32_t called_for = material_bits(&scene->materials[m]);
            const uint32_t spheres = spheres_with[m - first];
            if (spheres > 0) {
                bits |= called_for;
                ++all->materials;
            }
            for (int e = 0; e < BP_EFFECT_COUNT; ++e) {
                if (!bp_effects_has(called_for, (BpEffect)e)) continue;
                uses[e].materials += spheres > 0 ? 1 : 0;
                uses[e].unused += spheres > 0 ? 0 : 1;
                uses[e].spheres += spheres;
            }
        }
    }
    return bits;
}

/* Whether a sphere moves. */
static bool explain_motion(const BpScene *scene, size_t size, char *reason) {
    size_t moving = 0;
    for (size_t i = 0; i < scene->moving_count; ++i) moving += bp_sphere_moves(scene, i);
    if (moving > 0)
        snprintf(reason, size, "%zu of %zu sphere%s move%s", moving, scene->sphere_count,
                 bp_plural(scene->sphere_count), moving == 1 ? "s" : "");
    else
        snprintf(reason, size, "no sphere moves");
    return moving > 0;
}

/* How many spheres, bodies of triangles and capsules have a medium inside. */
static size_t filled_boundaries(const BpScene *scene) {
    size_t filled = 0;
    for (size_t i = 0; i < scene->interior_count; ++i) filled += bp_shape_interior(scene, i) != 0;
    for (size_t b = 0; b < scene->bodies.count; ++b)
        filled += bp_shape_interior(scene, scene->sphere_count + scene->bodies.list[b].first) != 0;
    for (size_t i = 0; i < scene->capsule_interior_count; ++i)
        filled += bp_shape_interior(scene, scene->sphere_count + scene->triangle_count + i) != 0;
    return filled;
}

/* Whether a medium does anything to light, or a boundary lets it through. */
static bool explain_media(const BpScene *scene, size_t size, char *reason) {
    const bool around = bp_scene_medium(scene) != 0;
    const size_t interfaces = bp_scene_interfaces(scene), filled = filled_boundaries(scene);
    const bool spheres_alone = scene->triangle_count + scene->capsule_count == 0;
    if (filled > 0)
        snprintf(reason, size, "%zu %s%s with a medium inside%s", filled, spheres_alone ? "sphere" : "shape",
                 bp_plural(filled), around ? ", and the scene lies in one" : "");
    else if (around)
        snprintf(reason, size, "the scene lies in a medium");
    else if (interfaces > 0)
        snprintf(reason, size, "%zu interface%s, but all media are clear", interfaces, bp_plural(interfaces));
    else
        snprintf(reason, size, "no %s has a medium inside, and the scene has none around",
                 spheres_alone ? "sphere" : "shape");
    return bp_scene_has_media(scene);
}

/* Whether triangles or capsules are boundaries of media: light passes through them, and something fills a
 * part of space. */
static bool explain_body_media(const BpScene *scene, bool media, size_t size, char *reason) {
    size_t capsules = 0;
    for (size_t i = 0; i < scene->capsule_count && media; ++i)
        capsules += bp_material_is(scene->materials[scene->capsules[i].material].kind, BP_HAS_INSIDE);
    const size_t bodies = scene->bodies.count;
    if (bodies > 0 && capsules > 0)
        snprintf(reason, size, "light passes into %zu bod%s of triangles and %zu capsule%s", bodies,
                 bodies == 1 ? "y" : "ies", capsules, bp_plural(capsules));
    else if (bodies > 0)
        snprintf(reason, size, "light passes into %zu bod%s of triangles", bodies, bodies == 1 ? "y" : "ies");
    else if (capsules > 0)
        snprintf(reason, size, "light passes into %zu capsule%s", capsules, bp_plural(capsules));
    else if (media)
        snprintf(reason, size, "light passes into spheres alone");
    else
        snprintf(reason, size, "there are no media");
    return bodies + capsules > 0;
}

static void explain_no_lamp(const BpScene *scene, size_t size, char *reason) {
    snprintf(reason, size, "no %s gives light, and no disc of the sky", bp_scene_noun(scene));
}

static size_t bright_discs(const BpScene *scene) {
    size_t bright = 0;
    for (size_t i = 0; i < scene->disc_count; ++i) bright += is_bright(scene->discs[i].radiance);
    return bright;
}

static bool explain_discs(const BpScene *scene, size_t size, char *reason) {
    const size_t count = scene->disc_count;
    if (bright_discs(scene) > 0)
        snprintf(reason, size, "%zu disc%s in the background", count, bp_plural(count));
    else if (count > 0)
        snprintf(reason, size, "%zu disc%s in the background, but without light", count, bp_plural(count));
    else
        snprintf(reason, size, "the background has no discs");
    return bright_discs(scene) > 0;
}

/* Whether there is an image around the scene that rays are sent to, if to any lamps. */
static bool sampled_image(const BpScene *scene) {
    return scene->environment != NULL && bp_environment_varies(scene->environment);
}

/* "3 lamps", "a disc and 3 lamps", "the image around and 3 lamps". */
static void name_lamps(size_t lamps, size_t discs, bool image, size_t size, char *text) {
    const char *first = image ? "the image around" : "";
    const char *join = image && lamps + discs > 0 ? lamps > 0 && discs > 0 ? ", " : " and " : "";
    if (lamps + discs == 0)
        snprintf(text, size, "%s", first);
    else if (discs == 0)
        snprintf(text, size, "%s%s%zu lamp%s", first, join, lamps, bp_plural(lamps));
    else if (lamps == 0)
        snprintf(text, size, "%s%s%zu disc%s", first, join, discs, bp_plural(discs));
    else
        snprintf(text, size, "%s%s%zu lamp%s and %zu disc%s", first, join, lamps, bp_plural(lamps), discs,
                 bp_plural(discs));
}

/* Whether no part of the sky is darker than any lamp, and the camera stands in no sphere that could hide the
 * sky. A path that misses such a lamp finds as much light in the sky, so rays to lamps cost more than the
 * noise that they take away. */
static bool sky_outshines_lamps(const BpScene *scene) {
    const double sky =
        fmin(bp_luminance_of(scene->background_bottom), bp_luminance_of(scene->background_top));
    if (scene->triangle_count + scene->capsule_count > 0) return false; /* they may hide the sky, too */
    for (size_t i = 0; i < scene->sphere_count; ++i) {
        const BpSphere *sphere = &scene->spheres[i];
        if (bp_luminance_of(scene->materials[sphere->material].emit) > sky) return false;
        const double *from = scene->camera.lookfrom;
        const double x = from[0] - sphere->center[0], y = from[1] - sphere->center[1],
                     z = from[2] - sphere->center[2];
        if (hypot(hypot(x, y), z) < fabs(sphere->radius) || bp_sphere_moves(scene, i)) return false;
    }
    return true;
}

/* Whether a medium scatters, so that lamps light it. */
static bool scatters_in_media(const BpScene *scene) {
    const uint32_t around = bp_scene_medium(scene);
    if (around != 0 && bp_medium_scatters(&scene->media[around - 1])) return true;
    const size_t interiors =
        scene->interior_count + scene->triangle_interior_count + scene->capsule_interior_count;
    for (size_t i = 0; i < bp_scene_shapes(scene) && interiors > 0; ++i) {
        const uint32_t inside = bp_shape_interior(scene, i);
        if (inside != 0 && bp_medium_scatters(&scene->media[inside - 1])) return true;
    }
    return false;
}

/* Whether rays are sent to lamps: if there is a disc, an image around whose light varies, or a lamp and
 * another sphere that it can light, and no sky as bright as all lamps. */
static bool explain_lamps(const BpScene *scene, size_t size, char *reason) {
    const size_t discs = bright_discs(scene);
    const bool image = sampled_image(scene), sky = discs > 0 || image;
    const bool media = scatters_in_media(scene);
    char all[96];
    const size_t enclosing = bp_enclosing_lamp(scene);
    size_t lamps = 0, lit = 0, both = 0;
    for (size_t i = 0; i < scene->sphere_count; ++i) {
        const bool is_lamp = bp_sphere_is_sampled(scene, i, enclosing);
        const bool is_lit = bp_material_is_lit(&scene->materials[scene->spheres[i].material]);
        lamps += is_lamp;
        lit += is_lit;
        both += is_lamp && is_lit;
    }
    for (size_t t = 0; t < scene->triangle_count; ++t) {
        const bool is_lamp = bp_shape_emits(scene, scene->sphere_count + t);
        const bool is_lit = bp_material_is_lit(&scene->materials[scene->triangles[t].material]);
        lamps += is_lamp;
        lit += is_lit;
        both += is_lamp && is_lit;
    }
    for (size_t c = 0; c < scene->capsule_count; ++c)
        lit += bp_material_is_lit(&scene->materials[scene->capsules[c].material]);
    name_lamps(lamps, discs, image, sizeof all, all);
    if (lamps == 0 && !sky && enclosing != SIZE_MAX)
        snprintf(reason, size, "the only lamp surrounds everything: every path finds it");
    else if (lamps == 0 && !sky)
        explain_no_lamp(scene, size, reason);
    else if (lit == 0 && !media)
        snprintf(reason, size, "%s, but nothing matte, nothing of fuzz 1/64 or roughness 1/16", all);
    else if (!sky && lamps == 1 && lit == 1 && both == 1 && !media)
        snprintf(reason, size, "the only lamp is also the only surface that could be lit");
    else if (!sky && sky_outshines_lamps(scene))
        snprintf(reason, size, "%zu lamp%s, %s brighter than the sky", lamps, bp_plural(lamps),
                 lamps == 1 ? "not" : "none of them");
    else {
        snprintf(reason, size, "%s that can light %zu %s%s%s", all, lit, bp_scene_noun(scene), bp_plural(lit),
                 media ? " and media" : "");
        return true;
    }
    return false;
}

/* What a texture calls for beyond TEXTURES. */
static const BpEffect texture_effects[] = {
#define EFFECT(identifier, name, effect, has, mapping) BP_EFFECT_##effect,
    BP_TEXTURE_LIST(EFFECT)
#undef EFFECT
};

/* Whether a member varies by a texture that calls for the effect. */
static bool varies_by(const BpScene *scene, const BpMaterial *material, BpEffect effect) {
    if (effect == BP_EFFECT_TEXTURES) return bp_material_varies(material);
    for (int m = 0; m < BP_MEMBER_COUNT; m++) {
        const uint32_t number = material->texture[m];
        if (number != 0 && texture_effects[scene->textures[number - 1].type] == effect) return true;
    }
    return false;
}

/* Whether a sphere has a material of which a member varies, or one that does by noise or by images. A colour
 * of the sphere's own replaces the albedo's texture, but that is not looked at. */
static bool explain_textures(const BpScene *scene, BpEffect effect, size_t size, char *reason) {
    const char *what = bp_effect_name(effect);
    size_t spheres = 0, materials = 0;
    for (size_t m = 0; m < scene->material_count; ++m)
        materials += varies_by(scene, &scene->materials[m], effect);
    for (size_t i = 0; i < bp_scene_shapes(scene) && materials > 0; ++i)
        spheres += varies_by(scene, &scene->materials[bp_shape_material(scene, i)], effect);
    if (spheres > 0)
        snprintf(reason, size, "%zu material%s with %s, on %zu of %zu %s%s", materials, bp_plural(materials),
                 what, spheres, bp_scene_shapes(scene), bp_scene_noun(scene),
                 bp_plural(bp_scene_shapes(scene)));
    else if (materials > 0)
        snprintf(reason, size, "%zu material%s %s %s, but no %s has %s", materials, bp_plural(materials),
                 materials == 1 ? "has" : "have", what, bp_scene_noun(scene), materials == 1 ? "it" : "them");
    else
        snprintf(reason, size, "no material has a texture%s",
                 effect == BP_EFFECT_NOISE    ? " of noise"
                 : effect == BP_EFFECT_IMAGES ? " from an image"
                                              : "");
    return spheres > 0;
}

static bool explain_environment(const BpScene *scene, size_t size, char *reason) {
    const BpImage *image = scene->environment;
    if (image == NULL)
        snprintf(reason, size, "the background is not an image");
    else
        snprintf(reason, size, "an image of %u by %u texels", (unsigned)image->width,
                 (unsigned)image->height);
    return image != NULL;
}

/* Whether there are triangles. What lamps send through or off them is found by chance. */
static bool explain_triangles(const BpScene *scene, size_t size, char *reason) {
    if (scene->triangle_count == 0)
        snprintf(reason, size, "no triangles, quads, boxes or meshes");
    else
        snprintf(reason, size, "%zu triangle%s%s", scene->triangle_count, bp_plural(scene->triangle_count),
                 scene->sphere_count == 0 ? " and no spheres" : "");
    return scene->triangle_count > 0;
}

static bool explain_capsules(const BpScene *scene, size_t size, char *reason) {
    if (scene->capsule_count == 0)
        snprintf(reason, size, "no capsules");
    else
        snprintf(reason, size, "%zu capsule%s", scene->capsule_count, bp_plural(scene->capsule_count));
    return scene->capsule_count > 0;
}

/* Whether rays are sent to triangles, where they are `sent` to lamps. */
static bool explain_triangle_lamps(const BpScene *scene, bool sent, size_t size, char *reason) {
    const size_t emitting = bp_scene_emitting_triangles(scene);
    if (emitting == 0)
        snprintf(reason, size, "no triangle emits");
    else if (!sent)
        snprintf(reason, size, "no rays are sent to lamps");
    else
        snprintf(reason, size, "%zu of %zu triangle%s emit%s, on both sides", emitting, scene->triangle_count,
                 bp_plural(scene->triangle_count), emitting == 1 ? "s" : "");
    return emitting > 0 && sent;
}

/* Whether a triangle is smooth. */
static bool explain_smooth_normals(const BpScene *scene, size_t size, char *reason) {
    size_t smooth = 0;
    for (size_t i = 0; i < scene->normal_count; ++i) smooth += bp_triangle_normals(scene, i) != NULL;
    if (smooth == 0)
        snprintf(reason, size, "no triangle has normals at its vertices");
    else
        snprintf(reason, size, "%zu of %zu triangle%s %s normals at %s vertices", smooth,
                 scene->triangle_count, bp_plural(scene->triangle_count), smooth == 1 ? "has" : "have",
                 smooth == 1 ? "its" : "their");
    return smooth > 0;
}

/* Whether a texture lies on a triangle. */
static bool explain_coordinates(const BpScene *scene, size_t size, char *reason) {
    const size_t mapped = bp_scene_mapped_triangles(scene);
    if (mapped == 0)
        snprintf(reason, size, "no texture lies on triangles");
    else
        snprintf(reason, size, "%zu of %zu triangle%s %s a texture laid on %s", mapped, scene->triangle_count,
                 bp_plural(scene->triangle_count), mapped == 1 ? "has" : "have", mapped == 1 ? "it" : "them");
    return mapped > 0;
}

/* Whether a shape has a material of opacity below 1. */
static bool explain_opacity(const BpScene *scene, size_t size, char *reason) {
    size_t shapes = 0, materials = 0;
    for (size_t m = 0; m < scene->material_count; ++m)
        materials += bp_material_opacity(&scene->materials[m]) < 1;
    for (size_t i = 0; i < bp_scene_shapes(scene) && materials > 0; ++i)
        shapes += bp_material_opacity(&scene->materials[bp_shape_material(scene, i)]) < 1;
    if (shapes > 0)
        snprintf(reason, size, "%zu material%s of opacity below 1, on %zu of %zu %s%s", materials,
                 bp_plural(materials), shapes, bp_scene_shapes(scene), bp_scene_noun(scene),
                 bp_plural(bp_scene_shapes(scene)));
    else if (materials > 0)
        snprintf(reason, size, "%zu material%s %s an opacity below 1, but no %s has %s", materials,
                 bp_plural(materials), materials == 1 ? "has" : "have", bp_scene_noun(scene),
                 materials == 1 ? "it" : "them");
    else
        snprintf(reason, size, "all materials have opacity 1");
    return shapes > 0;
}

/* Whether a path carries exactly as much after it has met a shape as before. */
static bool passes_all(const BpScene *scene, size_t shape) {
    const BpMaterial *material = &scene->materials[bp_shape_material(scene, shape)];
    if (!bp_material_is(material->kind, BP_SCATTERS)) return true;
    if (material->kind == BP_MATERIAL_DIELECTRIC || material->kind == BP_MATERIAL_INTERFACE) return true;
    if (material->kind != BP_MATERIAL_LAMBERTIAN && material->kind != BP_MATERIAL_METAL) return false;
    const double *albedo = material->albedo;
    return bp_shape_albedo(scene, shape) == BP_NO_ALBEDO && !bp_material_varies(material) &&
           fmin(albedo[0], fmin(albedo[1], albedo[2])) >= 1;
}

/* Whether paths may come to carry less. */
static bool explain_roulette(const BpScene *scene, size_t size, char *reason) {
    size_t shape = 0, medium = 0;
    while (shape < bp_scene_shapes(scene) && passes_all(scene, shape)) ++shape;
    while (medium < scene->medium_count && bp_medium_is_clear(&scene->media[medium])) ++medium;
    const bool any = shape < bp_scene_shapes(scene) || medium < scene->medium_count;
    if (!any)
        snprintf(reason, size, "nothing keeps any light: all paths carry the same");
    else if (scene->camera.max_depth <= ROULETTE_SEGMENTS)
        snprintf(reason, size, "paths have at most %u segment%s, and may end from %u on",
                 (unsigned)scene->camera.max_depth, bp_plural(scene->camera.max_depth), ROULETTE_SEGMENTS);
    else
        snprintf(reason, size, "paths of up to %u segments carry less after each of them",
                 (unsigned)scene->camera.max_depth);
    return any;
}

void bp_effects_analyse(const BpScene *scene, BpEffects *effects) {
    const size_t size = sizeof effects->reason[0];
    Use uses[BP_EFFECT_COUNT], all;
    memset(effects, 0, sizeof *effects);
    effects->bits = count_uses(scene, uses, &all);
    const bool one_kind = effects->bits != 0 && (effects->bits & (effects->bits - 1)) == 0;
    for (int e = 0; e < BP_EFFECT_COUNT; ++e)
        if (texts[e].left_out[0] != '\0')
            explain_material((BpEffect)e, bp_scene_noun(scene), &uses[e], &all, one_kind, size,
                             effects->reason[e]);

    const BpCamera *camera = &scene->camera;
    if (camera->lens_radius > 0) {
        effects->bits |= 1u << BP_EFFECT_LENS;
        snprintf(effects->reason[BP_EFFECT_LENS], size, "a lens of radius %.4g, in focus at %.4g",
                 camera->lens_radius, camera->focus_dist);
    } else {
        snprintf(effects->reason[BP_EFFECT_LENS], size, "defocus_angle 0: the lens is a pinhole");
    }
    if (explain_discs(scene, size, effects->reason[BP_EFFECT_DISCS])) effects->bits |= 1u << BP_EFFECT_DISCS;
    for (int e = BP_EFFECT_TEXTURES; e <= BP_EFFECT_IMAGES; ++e)
        if (explain_textures(scene, (BpEffect)e, size, effects->reason[e])) effects->bits |= 1u << e;
    if (explain_environment(scene, size, effects->reason[BP_EFFECT_ENVIRONMENT]))
        effects->bits |= 1u << BP_EFFECT_ENVIRONMENT;
    if (explain_media(scene, size, effects->reason[BP_EFFECT_MEDIA])) effects->bits |= 1u << BP_EFFECT_MEDIA;
    if (explain_body_media(scene, bp_effects_has(effects->bits, BP_EFFECT_MEDIA), size,
                           effects->reason[BP_EFFECT_BODY_MEDIA]))
        effects->bits |= 1u << BP_EFFECT_BODY_MEDIA;
    snprintf(effects->reason[BP_EFFECT_SHADOW_CATCHER], size,
             scene->shadow_catcher.present ? "the scene has a shadow catcher" : "no shadow catcher");
    if (scene->shadow_catcher.present) effects->bits |= 1u << BP_EFFECT_SHADOW_CATCHER;
    if (explain_motion(scene, size, effects->reason[BP_EFFECT_MOTION]))
        effects->bits |= 1u << BP_EFFECT_MOTION;
    if ((effects->bits & (1u << BP_EFFECT_EMISSION | 1u << BP_EFFECT_DISCS)) == 0 && !sampled_image(scene))
        explain_no_lamp(scene, size,
                        effects->reason[BP_EFFECT_LAMPS]); /* without another look at all shapes */
    else if (explain_lamps(scene, size, effects->reason[BP_EFFECT_LAMPS]))
        effects->bits |= 1u << BP_EFFECT_LAMPS;
    if (explain_triangles(scene, size, effects->reason[BP_EFFECT_TRIANGLES]))
        effects->bits |= 1u << BP_EFFECT_TRIANGLES;
    if (explain_triangle_lamps(scene, bp_effects_has(effects->bits, BP_EFFECT_LAMPS), size,
                               effects->reason[BP_EFFECT_TRIANGLE_LAMPS]))
        effects->bits |= 1u << BP_EFFECT_TRIANGLE_LAMPS;
    if (explain_smooth_normals(scene, size, effects->reason[BP_EFFECT_SMOOTH_NORMALS]))
        effects->bits |= 1u << BP_EFFECT_SMOOTH_NORMALS;
    if (explain_coordinates(scene, size, effects->reason[BP_EFFECT_TEXTURE_COORDINATES]))
        effects->bits |= 1u << BP_EFFECT_TEXTURE_COORDINATES;
    if (explain_capsules(scene, size, effects->reason[BP_EFFECT_CAPSULES]))
        effects->bits |= 1u << BP_EFFECT_CAPSULES;
    if (explain_opacity(scene, size, effects->reason[BP_EFFECT_OPACITY]))
        effects->bits |= 1u << BP_EFFECT_OPACITY;
    effects->triangles_alone = scene->triangle_count > 0 && scene->sphere_count + scene->capsule_count == 0;
    if (!bp_effects_has(effects->bits, BP_EFFECT_LAMPS))
        snprintf(effects->reason[BP_EFFECT_CAUSTICS], size, "no rays are sent to lamps");
    else
        effects->caustics = bp_focusers_explain(scene, size, effects->reason[BP_EFFECT_CAUSTICS]);
    effects->focuser_pairs = effects->caustics && bp_focusers_pair(scene);
    effects->dims = explain_roulette(scene, size, effects->reason[BP_EFFECT_ROULETTE]);
    if (effects->dims && scene->camera.max_depth > ROULETTE_SEGMENTS)
        effects->bits |= 1u << BP_EFFECT_ROULETTE;
}

size_t bp_effect_count(void) {
    return BP_EFFECT_COUNT;
}

bool bp_scene_effect(const BpScene *scene, size_t index, BpEffectInfo *info) {
    if (index >= BP_EFFECT_COUNT) return false;
    BpEffects effects;
    bp_effects_analyse(scene, &effects);
    info->name = texts[index].name;
    info->description = texts[index].text;
    info->simulated = bp_effects_has(effects.bits, (BpEffect)index);
    snprintf(info->reason, sizeof info->reason, "%s", effects.reason[index]);
    return true;
}
