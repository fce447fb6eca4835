/* material.c: see material.h. */
#include "material.h"

#include "base/words.h"
#include "scene.h"

#include <math.h>
#include <string.h>

#define SCATTER_WORDS(X)                                                                                     \
    X(BP_SCATTER_LAMBERTIAN, "lambertian")                                                                   \
    X(BP_SCATTER_COSINE_CUBED, "cosine_cubed") X(BP_SCATTER_HEMISPHERE, "hemisphere")
BP_WORDS(BpScatter, static const char *const bp_scatter_names, SCATTER_WORDS);
#define FUZZ_SHAPE_WORDS(X) X(BP_FUZZ_SPHERE, "sphere") X(BP_FUZZ_BALL, "ball")
BP_WORDS(BpFuzzShape, static const char *const bp_fuzz_shape_names, FUZZ_SHAPE_WORDS);
#define FRESNEL_WORDS(X)                                                                                     \
    X(BP_FRESNEL_SCHLICK, "schlick") X(BP_FRESNEL_EXACT, "exact") X(BP_FRESNEL_NONE, "none")
BP_WORDS(BpFresnel, static const char *const bp_fresnel_names, FRESNEL_WORDS);
#define TOTAL_REFLECTION_WORDS(X)                                                                            \
    X(BP_TOTAL_REFLECT, "reflect") X(BP_TOTAL_ABSORB, "absorb") X(BP_TOTAL_REFRACT, "refract")
BP_WORDS(BpTotalReflection, static const char *const bp_total_reflection_names, TOTAL_REFLECTION_WORDS);

const BpMaterialType bp_material_types[] = {
#define TYPE(identifier, name, kernel_kind, effect, traits, weight, members, needed, outcome)                 \
    [BP_MATERIAL_##identifier] = {                                                                            \
        name,                                                                                                 \
        traits,                                                                                               \
        weight,                                                                                               \
        (members) | BP_HAS(EMIT) | (BP_MATERIAL_##identifier == BP_MATERIAL_INTERFACE ? 0 : BP_HAS(OPACITY)), \
        needed,                                                                                               \
        outcome},
    BP_MATERIAL_LIST(TYPE)
#undef TYPE
};
const size_t bp_material_type_count = sizeof bp_material_types / sizeof bp_material_types[0];

/* A choice is an enumeration, read and written as the number that it is. */
#define CHECK_COLOUR(identifier, name, field, low, high, range, needed, place)
#define CHECK_NUMBER(identifier, name, field, low, high, range, needed, place, cap)
#define CHECK_CHOICE(identifier, name, field, place, ignored_if_zero, names)                                 \
    _Static_assert(sizeof((BpMaterial){0}.field) == sizeof(unsigned), "a choice has the size of a number");
BP_MEMBER_LIST(CHECK_COLOUR, CHECK_NUMBER, CHECK_CHOICE)

const BpMemberInfo bp_members[BP_MEMBER_COUNT] = {
#define COLOUR(identifier, name_, field, low_, high_, range_, needed_, place)                                \
    [BP_MEMBER_##identifier] = {.name = (name_),                                                             \
                                .form = BP_FORM_COLOUR,                                                      \
                                .offset = offsetof(BpMaterial, field),                                       \
                                .low = (low_),                                                               \
                                .high = (high_),                                                             \
                                .cap = INFINITY,                                                             \
                                .range = (range_),                                                           \
                                .needed = (needed_)},
#define NUMBER(identifier, name_, field, low_, high_, range_, needed_, place, cap_)                          \
    [BP_MEMBER_##identifier] = {.name = (name_),                                                             \
                                .form = BP_FORM_NUMBER,                                                      \
                                .offset = offsetof(BpMaterial, field),                                       \
                                .low = (low_),                                                               \
                                .high = (high_),                                                             \
                                .cap = (cap_),                                                               \
                                .range = (range_),                                                           \
                                .needed = (needed_)},
#define CHOICE(identifier, name_, field, place, ignored_if_zero_, names_)                                    \
    [BP_MEMBER_##identifier] = {.name = (name_),                                                             \
                                .form = BP_FORM_CHOICE,                                                      \
                                .offset = offsetof(BpMaterial, field),                                       \
                                .ignored_if_zero = (ignored_if_zero_),                                       \
                                .names = (names_),                                                           \
                                .name_count = sizeof(names_) / sizeof((names_)[0])},
    BP_MEMBER_LIST(COLOUR, NUMBER, CHOICE)};

double *bp_member_values(BpMaterial *material, BpMember member) {
    return (double *)(void *)((char *)material + bp_members[member].offset);
}

const double *bp_member_values_of(const BpMaterial *material, BpMember member) {
    return (const double *)(const void *)((const char *)material + bp_members[member].offset);
}

unsigned bp_member_choice(const BpMaterial *material, BpMember member) {
    unsigned choice;
    memcpy(&choice, (const char *)material + bp_members[member].offset, sizeof choice);
    return choice;
}

void bp_member_choose(BpMaterial *material, BpMember member, unsigned choice) {
    memcpy((char *)material + bp_members[member].offset, &choice, sizeof choice);
}

void bp_member_vary(BpMaterial *material, BpMember member, uint32_t number, const BpTexture *texture) {
    double bound[3], *values = bp_member_values(material, member);
    bp_texture_bound(texture, bound);
    material->texture[member] = number;
    if (bp_members[member].form == BP_FORM_COLOUR)
        memcpy(values, bound, sizeof bound);
    else
        *values = fmin(bound[0], bp_members[member].cap);
}

bool bp_material_varies(const BpMaterial *material) {
    for (int m = 0; m < BP_MEMBER_COUNT; m++)
        if (material->texture[m] != 0) return true;
    return false;
}

/* By the midpoint rule in the root of the cosine, which is even where reflectance is steep. */
double bp_coat_lets_in(double index) {
    enum { STEPS = 4000 };
    double sum = 0;
    for (int i = 0; i < STEPS; ++i) {
        const double s = (i + 0.5) / STEPS, c = s * s;
        const double beyond = sqrt(1 - (1 - c * c) / (index * index));
        const double across = (c - index * beyond) / (c + index * beyond);
        const double along = (index * c - beyond) / (index * c + beyond);
        sum += (1 - 0.5 * (across * across + along * along)) * 4 * s * s * s / STEPS; /* 2 c dc */
    }
    return sum;
}

double bp_material_opacity(const BpMaterial *material) {
    return bp_material_has(material->kind, BP_MEMBER_OPACITY) && material->opacity != 0 ? material->opacity
                                                                                        : 1;
}

bool bp_material_is_lit(const BpMaterial *material) {
    return material->kind == BP_MATERIAL_LAMBERTIAN || material->kind == BP_MATERIAL_OREN_NAYAR ||
           material->kind == BP_MATERIAL_GLOSSY ||
           (material->kind == BP_MATERIAL_ROUGH_METAL && material->roughness >= BP_LIT_ROUGHNESS_MIN) ||
           (material->kind == BP_MATERIAL_ROUGH_DIELECTRIC && material->roughness >= BP_LIT_ROUGHNESS_MIN &&
            fmax(material->refraction_index, 1 / material->refraction_index) >= BP_LIT_INDEX_MIN) ||
           (material->kind == BP_MATERIAL_METAL && material->fuzz >= BP_LIT_FUZZ_MIN);
}
