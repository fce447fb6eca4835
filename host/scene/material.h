/* material.h: every kind of material and every member that a material can have, in two lists.
 *
 * In:    a kind.   Out: its name, what it does with light, its members.
 * Knows: the grammar's terms, the fields of BpMaterial, what kernels and effects call a kind.
 * Does not know: how documents are read, how light is traced.
 *
 * From these lists come parsing (formats/scene_material.c), writing (formats/scene_write.c), validation
 * (scene_validate.c), packing (packed/pack.c), effects (packed/effects.c), the hash and the bound of a film
 * (film/film_scene.c) and the words of `explain --pixel`. The reference tracer has its own, on purpose; so
 * has the schema of documents, which is written by hand. */
#ifndef BP_SCENE_MATERIAL_H
#define BP_SCENE_MATERIAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct BpMaterial BpMaterial; /* scene.h */
struct BpTexture;                     /* texture.h */

/* Metal of less fuzz than this is not lit by rays to lamps (kernels/bsdf/bsdf.cl, LOBE_FUZZ_MIN). */
#define BP_LIT_FUZZ_MIN (1.0 / 64)
/* The same of less roughness (kernels/bsdf/rough_metal.cl, LIT_ROUGHNESS_MIN). */
#define BP_LIT_ROUGHNESS_MIN (1.0 / 16)
/* And of rough glass whose index over that of the outside, or its inverse, is less
 * (kernels/bsdf/rough_dielectric.cl). */
#define BP_LIT_INDEX_MIN 1.0625

/* Traits of a kind of material, bits of BpMaterialType.traits. */
enum {
    BP_SCATTERS = 1,     /* paths continue from it */
    BP_HAS_INSIDE = 2,   /* light goes through: a negative radius turns it inside out */
    BP_SHOWS_COLOUR = 4, /* adds a colour of up to 1 of its own to what it emits */
};

#define BP_HAS(member) (1u << BP_MEMBER_##member)

/* Less is not worth a surface, and rays would pass too many of them. */
#define BP_OPACITY_MIN 0.001

/* X(identifier, name, kernel's kind, effect, traits, weight, members, members that it needs, what becomes of
 * a path). `weight`: the largest weight of the kernel's lobe (kernels/bsdf/bsdf.cl) over the albedo, or over
 * 1 where it has none; the film's scale follows from it, so a sample that weighs more may be left out. Of
 * kinds of one name, a document means the last of which it has all that is needed. The kernel's kind is
 * KIND_... of scene_types.h, the effect BP_EFFECT_... of packed/effects.h. Every material may have "emit",
 * and brings in the effect EMISSION with it; and all but interfaces, which light passes as if there were
 * none, "opacity", which below 1 brings in OPACITY. */
#define BP_MATERIAL_LIST(X)                                                                                  \
    X(LAMBERTIAN, "lambertian", LAMBERTIAN, LAMBERTIAN, BP_SCATTERS, 1, BP_HAS(ALBEDO) | BP_HAS(SCATTER),    \
      BP_HAS(ALBEDO), "scatters it")                                                                         \
    X(METAL, "metal", METAL, METAL, BP_SCATTERS, 1, BP_HAS(ALBEDO) | BP_HAS(FUZZ) | BP_HAS(FUZZ_SHAPE),      \
      BP_HAS(ALBEDO), "reflects it")                                                                         \
    X(DIELECTRIC, "dielectric", DIELECTRIC, DIELECTRIC, BP_SCATTERS | BP_HAS_INSIDE, 1,                      \
      BP_HAS(REFRACTION_INDEX) | BP_HAS(FRESNEL) | BP_HAS(TOTAL_REFLECTION), BP_HAS(REFRACTION_INDEX),       \
      "refracts it")                                                                                         \
    X(DIFFUSE_LIGHT, "diffuse_light", LIGHT, EMISSION, 0, 0, 0, BP_HAS(EMIT), "a lamp: the path ends")       \
    X(NORMALS, "normals", NORMALS, NORMALS, BP_SHOWS_COLOUR, 0, 0, 0, "shows its normal: the path ends")     \
    X(INTERFACE, "interface", INTERFACE, MEDIA, BP_SCATTERS | BP_HAS_INSIDE, 1, 0, 0, "lets it through")     \
    X(OREN_NAYAR, "oren_nayar", OREN_NAYAR, OREN_NAYAR, BP_SCATTERS, 1, BP_HAS(ALBEDO) | BP_HAS(ROUGHNESS),  \
      BP_HAS(ALBEDO) | BP_HAS(ROUGHNESS), "scatters it")                                                     \
    X(ROUGH_METAL, "metal", ROUGH_METAL, ROUGH_METAL, BP_SCATTERS, 1, BP_HAS(ALBEDO) | BP_HAS(ROUGHNESS),    \
      BP_HAS(ALBEDO) | BP_HAS(ROUGHNESS), "reflects it")                                                     \
    X(GLOSSY, "glossy", GLOSSY, GLOSSY, BP_SCATTERS, 1,                                                      \
      BP_HAS(ALBEDO) | BP_HAS(ROUGHNESS) | BP_HAS(REFRACTION_INDEX), BP_HAS(ALBEDO), "scatters it")          \
    X(ROUGH_DIELECTRIC, "dielectric", ROUGH_DIELECTRIC, ROUGH_DIELECTRIC, BP_SCATTERS | BP_HAS_INSIDE, 1,    \
      BP_HAS(REFRACTION_INDEX) | BP_HAS(ROUGHNESS), BP_HAS(REFRACTION_INDEX) | BP_HAS(ROUGHNESS),            \
      "refracts it")

typedef enum BpMaterialKind {
#define BP_MATERIAL_ENUM(identifier, name, kernel_kind, effect, traits, weight, members, needed, outcome)    \
    BP_MATERIAL_##identifier,
    BP_MATERIAL_LIST(BP_MATERIAL_ENUM)
#undef BP_MATERIAL_ENUM
} BpMaterialKind;

#define BP_REFRACTION_INDEX_RANGE                                                                            \
    "the index of the inside over that of the outside, from 1e-6 to 1e6 (glass in air: 1.5, an air "         \
    "bubble in water: 1/1.33)"
#define BP_REFRACTION_INDEX_NEEDED "the index of the inside over that of the outside, such as 1.5 for glass"

/* The members, in the order in which documents are written, in three forms.
 *
 * COLOUR(identifier, name, field, low, high, range, needed, place): three numbers. `range` describes for
 * messages what they may be; `needed` describes what to write where a kind that needs it lacks it.
 *
 * NUMBER(identifier, name, field, low, high, range, needed, place, cap): one number; what is above `cap`
 * counts as `cap`.
 *
 * CHOICE(identifier, name, field, place, ignored_if_zero, names): one of `names`, the first where there is
 * none. It has no effect where the member `ignored_if_zero`, a number, is 0.
 *
 * `place`: MATERIAL_... of scene_types.h, where the kernel has the member; NOWHERE: it stands elsewhere. */
#define BP_MEMBER_LIST(COLOUR, NUMBER, CHOICE)                                                               \
    COLOUR(ALBEDO, "albedo", albedo, 0, 1, "shares of light from 0 to 1",                                    \
           "the colour of the material, such as \"albedo\": [0.8, 0.8, 0.8]", NOWHERE)                       \
    CHOICE(SCATTER, "scatter", scatter, LOBE, BP_MEMBER_COUNT, bp_scatter_names)                             \
    NUMBER(FUZZ, "fuzz", fuzz, 0, 1, "a number of at least 0 (above 1 counts as 1)", "", FUZZ, 1)            \
    CHOICE(FUZZ_SHAPE, "fuzz_shape", fuzz_shape, VARIANT, BP_MEMBER_FUZZ, bp_fuzz_shape_names)               \
    NUMBER(ROUGHNESS, "roughness", roughness, 0, 1, "a number from 0 to 1",                                  \
           "how rough the surface is, from 0 to 1, such as 0.5", ROUGHNESS, INFINITY)                        \
    NUMBER(REFRACTION_INDEX, "refraction_index", refraction_index, 1 / BP_REFRACTION_INDEX_MAX,              \
           BP_REFRACTION_INDEX_MAX, BP_REFRACTION_INDEX_RANGE, BP_REFRACTION_INDEX_NEEDED, INDEX, INFINITY)  \
    CHOICE(FRESNEL, "fresnel", fresnel, VARIANT, BP_MEMBER_COUNT, bp_fresnel_names)                          \
    CHOICE(TOTAL_REFLECTION, "total_reflection", total_reflection, TOTAL_REFLECTION, BP_MEMBER_COUNT,        \
           bp_total_reflection_names)                                                                        \
    COLOUR(EMIT, "emit", emit, 0, BP_RADIANCE_MAX, "radiances from 0 to 1e12",                               \
           "the light it gives, such as \"emit\": [4, 4, 4]", EMIT)                                          \
    NUMBER(OPACITY, "opacity", opacity, BP_OPACITY_MIN, 1, "a number from 0.001 to 1", "", OPACITY, INFINITY)

typedef enum BpMember {
#define BP_MEMBER_COLOUR(identifier, name, field, low, high, range, needed, place) BP_MEMBER_##identifier,
#define BP_MEMBER_NUMBER(identifier, name, field, low, high, range, needed, place, cap)                      \
    BP_MEMBER_##identifier,
#define BP_MEMBER_CHOICE(identifier, name, field, place, ignored_if_zero, names) BP_MEMBER_##identifier,
    BP_MEMBER_LIST(BP_MEMBER_COLOUR, BP_MEMBER_NUMBER, BP_MEMBER_CHOICE)
#undef BP_MEMBER_COLOUR
#undef BP_MEMBER_NUMBER
#undef BP_MEMBER_CHOICE
        BP_MEMBER_COUNT
} BpMember;

typedef enum BpMemberForm { BP_FORM_COLOUR, BP_FORM_NUMBER, BP_FORM_CHOICE } BpMemberForm;

typedef struct BpMemberInfo {
    const char *name;
    BpMemberForm form;
    size_t offset;         /* in BpMaterial */
    double low, high, cap; /* of colours and numbers */
    const char *range, *needed;
    BpMember ignored_if_zero; /* of choices */
    const char *const *names; /* of choices */
    size_t name_count;
} BpMemberInfo;

typedef struct BpMaterialType {
    const char *name;
    unsigned traits;          /* BP_SCATTERS, ... */
    double weight;            /* the largest of its lobe, over the albedo; 0: it scatters nothing */
    unsigned members, needed; /* BP_HAS(...) */
    const char *outcome;
} BpMaterialType;

extern const BpMaterialType bp_material_types[];
extern const size_t bp_material_type_count;
extern const BpMemberInfo bp_members[BP_MEMBER_COUNT];

static inline bool bp_material_is(BpMaterialKind kind, unsigned trait) {
    return (bp_material_types[kind].traits & trait) != 0;
}
static inline bool bp_material_has(BpMaterialKind kind, BpMember member) {
    return (bp_material_types[kind].members >> member & 1u) != 0;
}

/* The values of a member: three for a colour, one for a number. */
double *bp_member_values(BpMaterial *material, BpMember member);
const double *bp_member_values_of(const BpMaterial *material, BpMember member);
/* The place of a choice among its names. */
unsigned bp_member_choice(const BpMaterial *material, BpMember member);
void bp_member_choose(BpMaterial *material, BpMember member, unsigned choice);

/* Whether it may have a texture instead of one value everywhere. */
static inline bool bp_member_can_vary(BpMember member) {
    return bp_members[member].form == BP_FORM_COLOUR || member == BP_MEMBER_FUZZ;
}
/* Gives a member the texture textures[number - 1], `texture`, and the largest value that it has. */
void bp_member_vary(BpMaterial *material, BpMember member, uint32_t number, const struct BpTexture *texture);
bool bp_material_varies(const BpMaterial *material);

/* The refraction index of coats: more is not found in coats, and less than 1 would be a coat that is thinner
 * than air. */
#define BP_COAT_INDEX 1.5 /* by default */
#define BP_COAT_INDEX_MAX 10

/* Rough glass beyond this index, or below its inverse, is not tested. */
#define BP_ROUGH_INDEX_MAX 10

/* The share of light from all sides, by Lambert's law, that a smooth coat lets in, of Fresnel's equations;
 * `index` from 1 to BP_COAT_INDEX_MAX. Within 1e-6. */
double bp_coat_lets_in(double index);

/* The share of paths that meet its surface, from BP_OPACITY_MIN to 1; the others go straight on. */
double bp_material_opacity(const BpMaterial *material);

/* Rays to lamps light it: it scatters into many directions. */
bool bp_material_is_lit(const BpMaterial *material);

#endif
