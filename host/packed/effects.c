/* effects.c: see effects.h. */
#include "effects.h"

#include "base/plural.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *bp_effect_name(BpEffect effect) {
    switch (effect) {
#define EFFECT_NAME(identifier, name, text)                                                                  \
    case BP_EFFECT_##identifier:                                                                             \
        return name;
        BP_EFFECT_LIST(EFFECT_NAME)
#undef EFFECT_NAME
    case BP_EFFECT_COUNT:
        break;
    }
    return "no effect";
}

const char *bp_effect_identifier(BpEffect effect) {
    switch (effect) {
#define EFFECT_IDENTIFIER(identifier, name, text)                                                            \
    case BP_EFFECT_##identifier:                                                                             \
        return #identifier;
        BP_EFFECT_LIST(EFFECT_IDENTIFIER)
#undef EFFECT_IDENTIFIER
    case BP_EFFECT_COUNT:
        break;
    }
    return "NONE";
}

const char *bp_effect_description(BpEffect effect) {
    switch (effect) {
#define EFFECT_DESCRIPTION(identifier, name, text)                                                           \
    case BP_EFFECT_##identifier:                                                                             \
        return text;
        BP_EFFECT_LIST(EFFECT_DESCRIPTION)
#undef EFFECT_DESCRIPTION
    case BP_EFFECT_COUNT:
        break;
    }
    return "nothing";
}

/* How many materials, and how many spheres with them, call for one effect. */
typedef struct Use {
    size_t materials, spheres, unused; /* unused: materials that would, but that no sphere has */
} Use;

/* The effects that a material brings in where a sphere has it. A lamp is always EMISSION, even one of
 * radiance 0: it is the code that ends the path there. */
static uint32_t material_bits(const BpMaterial *material) {
    uint32_t bits = 0;
    switch (material->kind) {
    case BP_MATERIAL_LAMBERTIAN:
        bits = 1u << BP_EFFECT_LAMBERTIAN;
        break;
    case BP_MATERIAL_METAL:
        bits = 1u << BP_EFFECT_METAL;
        break;
    case BP_MATERIAL_DIELECTRIC:
        bits = 1u << BP_EFFECT_DIELECTRIC;
        break;
    case BP_MATERIAL_DIFFUSE_LIGHT:
        bits = 1u << BP_EFFECT_EMISSION;
        break;
    case BP_MATERIAL_NORMALS:
        bits = 1u << BP_EFFECT_NORMALS;
        break;
    }
    if (material->emit[0] > 0 || material->emit[1] > 0 || material->emit[2] > 0)
        bits |= 1u << BP_EFFECT_EMISSION;
    return bits;
}

/* What is left out with an effect of a material, as "... are left out" continues. */
static const char *left_out(BpEffect effect) {
    switch (effect) {
    case BP_EFFECT_LAMBERTIAN:
        return "diffuse lobes are left out";
    case BP_EFFECT_METAL:
        return "mirror reflection and fuzz are left out";
    case BP_EFFECT_DIELECTRIC:
        return "refraction, Fresnel and the inside of spheres are left out";
    case BP_EFFECT_EMISSION:
        return "looking up emission is left out";
    case BP_EFFECT_NORMALS:
        return "normals as colours are left out";
    default:
        return "";
    }
}

static void explain_material(BpEffect effect, const Use *use, const Use *all, bool one_kind, size_t size,
                             char *reason) {
    const char *name = bp_effect_name(effect);
    char in_use[64];
    snprintf(in_use, sizeof in_use, "none of the %zu materials in use", all->materials);
    char kinds[64] = "";
    if (all->materials > 1) snprintf(kinds, sizeof kinds, " (%zu of it)", all->materials);
    if (use->materials > 0 && one_kind)
        snprintf(reason, size,
                 "the one kind of material in use%s, on all %zu sphere%s: no switch between kinds", kinds,
                 all->spheres, bp_plural(all->spheres));
    else if (use->materials > 0)
        snprintf(reason, size, "%zu of the %zu material%s in use, on %zu of %zu sphere%s", use->materials,
                 all->materials, bp_plural(all->materials), use->spheres, all->spheres,
                 bp_plural(all->spheres));
    else if (all->spheres == 0)
        snprintf(reason, size, "no spheres: the picture is the sky");
    else if (use->unused > 0)
        snprintf(reason, size, "%zu material%s would, but no sphere has %s: %s", use->unused,
                 bp_plural(use->unused), use->unused == 1 ? "it" : "them", left_out(effect));
    else if (effect == BP_EFFECT_EMISSION)
        snprintf(reason, size, "nothing emits: %s",
                 all->materials == 1 ? "not the one material in use" : in_use);
    else if (effect == BP_EFFECT_NORMALS)
        snprintf(reason, size, "nothing shows normals: %s",
                 all->materials == 1 ? "not the one material in use" : in_use);
    else if (all->materials == 1)
        snprintf(reason, size, "the one material in use is not %s: %s", name, left_out(effect));
    else
        snprintf(reason, size, "no %s among the %zu materials in use: %s", name, all->materials,
                 left_out(effect));
}

/* Fills `uses` (one an effect) and `all`, and returns the bits; false without memory. */
static bool count_uses(const BpScene *scene, Use uses[BP_EFFECT_COUNT], Use *all, uint32_t *bits) {
    size_t *spheres_with = calloc(scene->material_count + 1, sizeof *spheres_with);
    if (spheres_with == NULL) return false;
    for (size_t i = 0; i < scene->sphere_count; ++i) ++spheres_with[scene->spheres[i].material];
    *bits = 0;
    memset(uses, 0, BP_EFFECT_COUNT * sizeof *uses);
    *all = (Use){.spheres = scene->sphere_count};
    for (size_t m = 0; m < scene->material_count; ++m) {
        const uint32_t called_for = material_bits(&scene->materials[m]);
        const bool used = spheres_with[m] > 0;
        if (used) {
            *bits |= called_for;
            ++all->materials;
        }
        for (int e = 0; e < BP_EFFECT_COUNT; ++e) {
            if (!bp_effects_has(called_for, (BpEffect)e)) continue;
            uses[e].materials += used ? 1 : 0;
            uses[e].unused += used ? 0 : 1;
            uses[e].spheres += spheres_with[m];
        }
    }
    free(spheres_with);
    return true;
}

void bp_effects_analyse(const BpScene *scene, BpEffects *effects) {
    static const BpEffect of_materials[] = {BP_EFFECT_LAMBERTIAN, BP_EFFECT_METAL, BP_EFFECT_DIELECTRIC,
                                            BP_EFFECT_EMISSION, BP_EFFECT_NORMALS};
    const size_t size = sizeof effects->reason[0];
    Use uses[BP_EFFECT_COUNT], all;
    memset(effects, 0, sizeof *effects);
    if (!count_uses(scene, uses, &all, &effects->bits)) {
        /* The general kernel renders every scene right. */
        effects->bits = BP_EFFECTS_ALL;
        for (int e = 0; e < BP_EFFECT_COUNT; ++e)
            snprintf(effects->reason[e], size, "no memory to look at the scene: everything is simulated");
        return;
    }

    const bool one_kind = effects->bits != 0 && (effects->bits & (effects->bits - 1)) == 0;
    for (size_t i = 0; i < sizeof of_materials / sizeof of_materials[0]; ++i)
        explain_material(of_materials[i], &uses[of_materials[i]], &all, one_kind, size,
                         effects->reason[of_materials[i]]);

    const BpCamera *camera = &scene->camera;
    if (camera->lens_radius > 0) {
        effects->bits |= 1u << BP_EFFECT_LENS;
        snprintf(effects->reason[BP_EFFECT_LENS], size, "a lens of radius %.4g, in focus at %.4g",
                 camera->lens_radius, camera->focus_dist);
    } else {
        snprintf(effects->reason[BP_EFFECT_LENS], size, "defocus_angle 0: the lens is a pinhole");
    }

    const double *bottom = scene->background_bottom, *top = scene->background_top;
    if (bottom[0] != top[0] || bottom[1] != top[1] || bottom[2] != top[2]) {
        effects->bits |= 1u << BP_EFFECT_GRADIENT;
        snprintf(effects->reason[BP_EFFECT_GRADIENT], size,
                 "the background goes from (%.3g, %.3g, %.3g) below to (%.3g, %.3g, %.3g) above", bottom[0],
                 bottom[1], bottom[2], top[0], top[1], top[2]);
    } else {
        snprintf(effects->reason[BP_EFFECT_GRADIENT], size,
                 "background constant (%.3g, %.3g, %.3g): no gradient", top[0], top[1], top[2]);
    }

    if (scene->sphere_count > BP_LIST_SPHERES_MAX) {
        effects->bits |= 1u << BP_EFFECT_TREE;
        snprintf(effects->reason[BP_EFFECT_TREE], size, "%zu spheres, more than %u: a tree",
                 scene->sphere_count, BP_LIST_SPHERES_MAX);
    } else if (scene->sphere_count == 0) {
        snprintf(effects->reason[BP_EFFECT_TREE], size, "no spheres: the picture is the sky");
    } else {
        snprintf(effects->reason[BP_EFFECT_TREE], size, "%zu sphere%s: a list, no tree", scene->sphere_count,
                 bp_plural(scene->sphere_count));
    }
}

size_t bp_scene_effects(const BpScene *scene, BpEffectInfo list[BP_EFFECTS_MAX]) {
    BpEffects effects;
    bp_effects_analyse(scene, &effects);
    for (int e = 0; e < BP_EFFECT_COUNT; ++e) {
        list[e].name = bp_effect_name((BpEffect)e);
        list[e].description = bp_effect_description((BpEffect)e);
        list[e].simulated = bp_effects_has(effects.bits, (BpEffect)e);
        snprintf(list[e].reason, sizeof list[e].reason, "%s", effects.reason[e]);
    }
    return BP_EFFECT_COUNT;
}
