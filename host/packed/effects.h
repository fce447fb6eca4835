/* effects.h: which effects a scene calls for, and why.
 *
 * In:    a validated Scene.   Out: a set of bits, each with a reason in plain words.
 * Knows: what an effect is for.   Does not know: OpenCL, packed data.
 *
 * The list below is the only definition of effects: the kernel's EFFECT_ switches, `explain`, the tests and
 * docs/EFFECTS.md are all made from it. */
#ifndef BP_PACKED_EFFECTS_H
#define BP_PACKED_EFFECTS_H

#include "scene/scene.h"

/* X(identifier, name, what it simulates, what is left out without it, who is absent): the kernel sees
 * EFFECT_<identifier>. The last two are of effects that materials call for, as "... are left out" continues
 * and as "...: none of the materials in use" begins; where none is named, it is "no <name> among the
 * materials". */
#define BP_EFFECT_LIST(X)                                                                                    \
    X(LAMBERTIAN, "lambertian", "diffuse scattering, its three lobes", "diffuse lobes are left out", "")     \
    X(METAL, "metal", "mirror reflection with fuzz", "mirror reflection and fuzz are left out", "")          \
    X(DIELECTRIC, "dielectric", "refraction, Fresnel reflection and the inside of spheres",                  \
      "refraction, Fresnel and the inside of spheres are left out", "")                                      \
    X(EMISSION, "emission", "surfaces that emit light", "looking up emission is left out", "nothing emits")  \
    X(NORMALS, "normals", "surfaces that show their normal as colour", "normals as colours are left out",    \
      "nothing shows normals")                                                                               \
    X(OREN_NAYAR, "oren_nayar", "rough matte surfaces", "rough matte lobes are left out", "")                \
    X(ROUGH_METAL, "rough_metal", "metal of tiny mirrors that face all ways", "rough metal is left out", "") \
    X(GLOSSY, "glossy", "matte surfaces under a clear coat", "coats are left out", "")                       \
    X(ROUGH_DIELECTRIC, "rough_dielectric", "glass with a rough surface, such as frosted glass",             \
      "rough glass is left out", "")                                                                         \
    X(LENS, "lens", "a lens with an aperture: defocus blur", "", "")                                         \
    X(LAMPS, "light_sampling", "rays to lamps, from surfaces that scatter into many directions", "", "")     \
    X(DISCS, "discs", "lamps at infinity: discs in the sky", "", "")                                         \
    X(TEXTURES, "textures", "albedo, fuzz and emission from textures, such as checkers", "", "")             \
    X(NOISE, "noise", "textures of gradient noise: turbulence, marble, wood", "", "")                        \
    X(IMAGES, "images", "textures from image files", "", "")                                                 \
    X(ENVIRONMENT, "environment", "an image that surrounds the scene as background", "", "")                 \
    X(MOTION, "motion", "spheres that move while the shutter is open", "", "")                               \
    X(MEDIA, "media", "fog, smoke and tinted glass, in spheres or in the whole scene", "", "")               \
    X(BODY_MEDIA, "body_media", "media in boxes, meshes and capsules", "", "")                               \
    X(SHADOW_CATCHER, "shadow_catcher", "a plane that shows nothing but the shadow on it", "", "")           \
    X(CAUSTICS, "caustics", "rays to lamps through balls of glass and off mirrors", "", "")                  \
    X(TRIANGLES, "triangles", "triangles beside spheres, or in place of them", "", "")                       \
    X(TRIANGLE_LAMPS, "triangle_lamps", "rays to triangles that emit", "", "")                               \
    X(SMOOTH_NORMALS, "smooth_normals", "triangles that look curved, by normals at their vertices", "", "")  \
    X(CAPSULES, "capsules", "capsules beside spheres: lines with a radius and round ends", "", "")           \
    X(ROULETTE, "roulette", "deep paths that carry little end by chance: Russian roulette", "", "")          \
    X(TEXTURE_COORDINATES, "texture_coordinates", "textures laid on triangles by coordinates", "", "")       \
    X(OPACITY, "opacity", "surfaces that let a share of light straight on", "", "")

typedef enum BpEffect {
#define BP_EFFECT_ENUM(identifier, name, text, left_out, absent) BP_EFFECT_##identifier,
    BP_EFFECT_LIST(BP_EFFECT_ENUM)
#undef BP_EFFECT_ENUM
        BP_EFFECT_COUNT
} BpEffect;

_Static_assert(BP_EFFECT_COUNT < 32, "effects are the bits of a uint32_t");

typedef struct BpEffects {
    uint32_t bits;        /* bit e set: effect e is simulated */
    bool focuser_pairs;   /* with CAUSTICS: light may come by way of two focusers in turn */
    bool triangles_alone; /* and no code for spheres, unless options ask for more */
    bool caustics;        /* CAUSTICS is simulated too, if the options enable it */
    bool dims; /* paths may come to carry little: ROULETTE is simulated if options let them be deep */
    char reason[BP_EFFECT_COUNT][160];
} BpEffects;

#define BP_EFFECTS_ALL ((1u << BP_EFFECT_COUNT) - 1u)

static inline bool bp_effects_has(uint32_t bits, BpEffect effect) {
    return (bits >> effect & 1u) != 0;
}

const char *bp_effect_name(BpEffect effect);       /* "lambertian" */
const char *bp_effect_identifier(BpEffect effect); /* "LAMBERTIAN" */

void bp_effects_analyse(const BpScene *scene, BpEffects *effects);

#endif
