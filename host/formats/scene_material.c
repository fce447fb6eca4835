/* scene_material.c: one material of a scene document.
 *
 * In:    its node.   Out: a BpMaterial.
 * Knows: which members belong to which type, and their defaults. Ranges are checked by scene_validate.c. */
#include "scene_parse.h"

#include <string.h>

static const char *const type_names[] = {[BP_MATERIAL_LAMBERTIAN] = "lambertian",
                                         [BP_MATERIAL_METAL] = "metal",
                                         [BP_MATERIAL_DIELECTRIC] = "dielectric",
                                         [BP_MATERIAL_DIFFUSE_LIGHT] = "diffuse_light",
                                         [BP_MATERIAL_NORMALS] = "normals"};
static const char *const scatter_names[] = {[BP_SCATTER_LAMBERTIAN] = "lambertian",
                                            [BP_SCATTER_COSINE_CUBED] = "cosine_cubed",
                                            [BP_SCATTER_HEMISPHERE] = "hemisphere"};
static const char *const shape_names[] = {[BP_FUZZ_SPHERE] = "sphere", [BP_FUZZ_BALL] = "ball"};
static const char *const fresnel_names[] = {
    [BP_FRESNEL_SCHLICK] = "schlick", [BP_FRESNEL_EXACT] = "exact", [BP_FRESNEL_NONE] = "none"};
static const char *const total_names[] = {
    [BP_TOTAL_REFLECT] = "reflect", [BP_TOTAL_ABSORB] = "absorb", [BP_TOTAL_REFRACT] = "refract"};

static const char *const member_names[] = {
    "type",       "albedo",           "emit",    "scatter",         "fuzz",
    "fuzz_shape", "refraction_index", "fresnel", "total_reflection"};

/* The members that only some types have; `owners` holds one bit a type. */
static const struct {
    const char *name;
    unsigned owners;
    const char *owner_names;
} owned_members[] = {
    {"albedo", 1u << BP_MATERIAL_LAMBERTIAN | 1u << BP_MATERIAL_METAL, "\"lambertian\" and \"metal\""},
    {"scatter", 1u << BP_MATERIAL_LAMBERTIAN, "\"lambertian\""},
    {"fuzz", 1u << BP_MATERIAL_METAL, "\"metal\""},
    {"fuzz_shape", 1u << BP_MATERIAL_METAL, "\"metal\""},
    {"refraction_index", 1u << BP_MATERIAL_DIELECTRIC, "\"dielectric\""},
    {"fresnel", 1u << BP_MATERIAL_DIELECTRIC, "\"dielectric\""},
    {"total_reflection", 1u << BP_MATERIAL_DIELECTRIC, "\"dielectric\""},
};

const char *bp_material_type_name(BpMaterialKind kind) {
    return type_names[kind];
}

static BpStatus refuse_foreign_members(const BpNode *node, int type, BpError *err) {
    for (size_t i = 0; i < BP_COUNT(owned_members); i++) {
        const BpNode member = bp_node_member(node, owned_members[i].name);
        if (member.value == NULL || (owned_members[i].owners >> type & 1u) != 0) continue;
        return bp_node_fail(
            &member, BP_PART_NAME, err,
            "found in a material of type \"%s\", expected only in %s; remove it or change the type",
            type_names[type], owned_members[i].owner_names);
    }
    return BP_OK;
}

static BpStatus read_choice(const BpNode *object, const char *name, const char *const *names, size_t count,
                            int *choice, BpError *err) {
    const BpNode node = bp_node_member(object, name);
    return bp_node_choice(&node, names, count, choice, err);
}

BpStatus bp_parse_material(const BpNode *node, BpMaterial *material, BpError *err) {
    BP_TRY(bp_node_object(node, member_names, BP_COUNT(member_names), err));
    BP_TRY(bp_node_require(
        node, "type", "one of \"lambertian\", \"metal\", \"dielectric\", \"diffuse_light\" or \"normals\"",
        err));
    int type = 0, scatter = 0, shape = 0, fresnel = 0, total = 0;
    BP_TRY(read_choice(node, "type", type_names, BP_COUNT(type_names), &type, err));
    BP_TRY(refuse_foreign_members(node, type, err));
    material->kind = (BpMaterialKind)type;
    if (bp_material_has_albedo(material->kind))
        BP_TRY(bp_node_require(node, "albedo",
                               "the colour of the material, such as \"albedo\": [0.8, 0.8, 0.8]", err));
    if (type == BP_MATERIAL_DIELECTRIC)
        BP_TRY(bp_node_require(node, "refraction_index",
                               "the index of the inside over that of the outside, such as 1.5 "
                               "for glass",
                               err));
    if (type == BP_MATERIAL_DIFFUSE_LIGHT)
        BP_TRY(bp_node_require(node, "emit", "the light it gives, such as \"emit\": [4, 4, 4]", err));
    material->refraction_index = 1;
    const BpNode albedo = bp_node_member(node, "albedo");
    const BpNode emit = bp_node_member(node, "emit");
    const BpNode fuzz = bp_node_member(node, "fuzz");
    const BpNode index = bp_node_member(node, "refraction_index");
    BP_TRY(bp_node_vector(&albedo, material->albedo, err));
    BP_TRY(bp_node_vector(&emit, material->emit, err));
    BP_TRY(bp_node_number(&fuzz, &material->fuzz, err));
    BP_TRY(bp_node_number(&index, &material->refraction_index, err));
    BP_TRY(read_choice(node, "scatter", scatter_names, BP_COUNT(scatter_names), &scatter, err));
    BP_TRY(read_choice(node, "fuzz_shape", shape_names, BP_COUNT(shape_names), &shape, err));
    BP_TRY(read_choice(node, "fresnel", fresnel_names, BP_COUNT(fresnel_names), &fresnel, err));
    BP_TRY(read_choice(node, "total_reflection", total_names, BP_COUNT(total_names), &total, err));
    if (material->fuzz > 1) material->fuzz = 1; /* as the first and fourth editions */
    material->scatter = (BpScatter)scatter;
    material->fuzz_shape = (BpFuzzShape)shape;
    material->fresnel = (BpFresnel)fresnel;
    material->total_reflection = (BpTotalReflection)total;
    return BP_OK;
}
