/* effects.h: which effects a scene calls for, and why.
 *
 * In:    a validated Scene.   Out: a set of bits, each with a reason a person understands.
 * Knows: what an effect is for.   Does not know: OpenCL, packed data.
 *
 * The list below is the only definition of effects: the kernel's EFFECT_ switches, `explain`, the tests and
 * docs/EFFECTS.md are all made from it. */
#ifndef BP_PACKED_EFFECTS_H
#define BP_PACKED_EFFECTS_H

#include "scene/scene.h"

/* identifier (the kernel sees EFFECT_<identifier>), name, what it simulates */
#define BP_EFFECT_LIST(X)                                                                                    \
    X(LAMBERTIAN, "lambertian", "diffuse scattering, its three lobes")                                       \
    X(METAL, "metal", "mirror reflection with fuzz")                                                         \
    X(DIELECTRIC, "dielectric", "refraction, Fresnel reflection and the inside of spheres")                  \
    X(EMISSION, "emission", "surfaces that emit light")                                                      \
    X(NORMALS, "normals", "surfaces that show their normal as colour")                                       \
    X(LENS, "lens", "a lens with an aperture: defocus blur")                                                 \
    X(GRADIENT, "gradient", "a background that changes with height")                                         \
    X(TREE, "tree", "a bounding volume hierarchy")

typedef enum BpEffect {
#define BP_EFFECT_ENUM(identifier, name, text) BP_EFFECT_##identifier,
    BP_EFFECT_LIST(BP_EFFECT_ENUM)
#undef BP_EFFECT_ENUM
        BP_EFFECT_COUNT
} BpEffect;

_Static_assert(BP_EFFECT_COUNT <= BP_EFFECTS_MAX,
               "every combination that can occur is tested: at most eight bits");

typedef struct BpEffects {
    uint32_t bits; /* bit e set: effect e is simulated */
    char reason[BP_EFFECT_COUNT][160];
} BpEffects;

#define BP_EFFECTS_ALL ((1u << BP_EFFECT_COUNT) - 1u)
/* Up to this many spheres a list is at least as fast as a tree (measured: docs/EFFECTS.md). */
#define BP_LIST_SPHERES_MAX 32u

static inline bool bp_effects_has(uint32_t bits, BpEffect effect) {
    return (bits >> effect & 1u) != 0;
}

const char *bp_effect_name(BpEffect effect);       /* "lambertian" */
const char *bp_effect_identifier(BpEffect effect); /* "LAMBERTIAN" */
const char *bp_effect_description(BpEffect effect);

void bp_effects_analyse(const BpScene *scene, BpEffects *effects);

#endif
