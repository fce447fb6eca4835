/* scene_material.c: see scene_material.h. */
#include "scene_material.h"

#include "scene/material.h"
#include "scene_texture.h"

#include <stdio.h>
#include <string.h>

#define TYPE_NAME(identifier, name, kernel_kind, effect, traits, weight, members, needed, outcome)           \
    [BP_MATERIAL_##identifier] = (name),
static const char *const kind_names[] = {BP_MATERIAL_LIST(TYPE_NAME)};
#define COLOUR_NAME(identifier, name, field, low, high, range, needed, place) name,
#define NUMBER_NAME(identifier, name, field, low, high, range, needed, place, cap) name,
#define CHOICE_NAME(identifier, name, field, place, ignored_if_zero, names) name,
static const char *const member_names[] = {"type", BP_MEMBER_LIST(COLOUR_NAME, NUMBER_NAME, CHOICE_NAME)};

/* The first kind that has the name of this one. */
static unsigned first_of_name(unsigned kind) {
    unsigned first = 0;
    while (strcmp(kind_names[first], kind_names[kind]) != 0) first++;
    return first;
}

/* The types whose bit is set, as `"a", "b" and "c"`; `last` stands before the last of several. */
static const char *join_types(unsigned types, const char *last, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    unsigned named = 0;
    for (unsigned t = 0; t < BP_COUNT(kind_names); t++)
        if ((types >> t & 1u) != 0) named |= 1u << first_of_name(t);
    types = named;
    for (unsigned t = 0; t < BP_COUNT(kind_names) && used < size; t++) {
        if ((types >> t & 1u) == 0) continue;
        const char *before = used == 0 ? "" : types >> (t + 1) == 0 ? last : ", ";
        const int length = snprintf(text + used, size - used, "%s\"%s\"", before, kind_names[t]);
        used += length > 0 ? (size_t)length : 0;
    }
    return text;
}

static unsigned types_with(BpMember member) {
    unsigned types = 0;
    for (unsigned t = 0; t < BP_COUNT(kind_names); t++)
        if (bp_material_has((BpMaterialKind)t, member)) types |= 1u << t;
    return types;
}

/* The member by which a kind is told from the first of its name. */
static unsigned member_apart(BpMaterialKind kind, unsigned first) {
    const unsigned apart = bp_material_types[kind].needed & ~bp_material_types[first].members;
    unsigned member = 0;
    while ((apart >> member & 1u) == 0) member++;
    return member;
}

/* The kind that a document means: the last of this name of which it has all that is needed. */
static BpMaterialKind kind_meant(const BpNode *node, unsigned first) {
    unsigned kind = first;
    for (unsigned k = first + 1; k < BP_COUNT(kind_names); k++) {
        bool all = first_of_name(k) == first;
        for (int m = 0; m < BP_MEMBER_COUNT; m++)
            all = all && ((bp_material_types[k].needed >> m & 1u) == 0 ||
                          bp_node_member(node, bp_members[m].name).value != NULL);
        if (all) kind = k;
    }
    return (BpMaterialKind)kind;
}

static BpStatus refuse_foreign_members(const BpNode *node, BpMaterialKind kind, BpError *err) {
    char owners[256];
    for (int m = 0; m < BP_MEMBER_COUNT; m++) {
        const BpNode member = bp_node_member(node, bp_members[m].name);
        if (member.value == NULL || bp_material_has(kind, (BpMember)m)) continue;
        const unsigned first = first_of_name(kind);
        if (first != kind && bp_material_has((BpMaterialKind)first, (BpMember)m))
            return bp_node_fail(&member, BP_PART_NAME, err,
                                "found beside \"%s\", expected only one of the two; remove one of them",
                                bp_members[member_apart(kind, first)].name);
        return bp_node_fail(
            &member, BP_PART_NAME, err,
            "found in a material of type \"%s\", expected only in %s; remove it or change the type",
            kind_names[kind], join_types(types_with((BpMember)m), " and ", owners, sizeof owners));
    }
    return BP_OK;
}

static BpStatus read_member(const BpNode *object, BpMember m, const BpScene *scene, BpMaterial *material,
                            BpError *err) {
    const BpMemberInfo *member = &bp_members[m];
    const BpNode node = bp_node_member(object, member->name);
    int choice = 0;
    if (bp_member_can_vary(m) && json_is_object(node.value)) {
        uint32_t number = 0;
        BP_TRY(bp_parse_texture_name(&node, scene, &number, err));
        bp_member_vary(material, m, number, &scene->textures[number - 1]);
        return BP_OK;
    }
    switch (member->form) {
    case BP_FORM_COLOUR:
        return bp_node_vector(&node, bp_member_values(material, m), err);
    case BP_FORM_NUMBER:
        BP_TRY(bp_node_number(&node, bp_member_values(material, m), err));
        if (m == BP_MEMBER_OPACITY && node.value != NULL && material->opacity == 0)
            return bp_node_fail(&node, BP_PART_VALUE, err,
                                "found 0, expected %s: remove what has this material instead", member->range);
        if (*bp_member_values(material, m) > member->cap) *bp_member_values(material, m) = member->cap;
        return BP_OK;
    case BP_FORM_CHOICE:
        BP_TRY(bp_node_choice(&node, member->names, member->name_count, &choice, err));
        bp_member_choose(material, m, (unsigned)choice);
        return BP_OK;
    }
    return BP_OK;
}

BpStatus bp_parse_material(const BpNode *node, const BpScene *scene, BpMaterial *material, BpError *err) {
    char text[256] = "one of ";
    const size_t used = strlen(text);
    const char *type_names[BP_COUNT(kind_names)];
    unsigned types[BP_COUNT(kind_names)], type_count = 0;
    int type = 0;
    for (unsigned k = 0; k < BP_COUNT(kind_names); k++)
        if (first_of_name(k) == k) types[type_count] = k, type_names[type_count++] = kind_names[k];
    BP_TRY(bp_node_object(node, member_names, BP_COUNT(member_names), err));
    join_types((1u << BP_COUNT(kind_names)) - 1u, " or ", text + used, sizeof text - used);
    BP_TRY(bp_node_require(node, "type", text, err));
    const BpNode type_node = bp_node_member(node, "type");
    BP_TRY(bp_node_choice(&type_node, type_names, type_count, &type, err));
    material->kind = kind_meant(node, types[type]);
    BP_TRY(refuse_foreign_members(node, material->kind, err));
    for (int m = 0; m < BP_MEMBER_COUNT; m++)
        if ((bp_material_types[material->kind].needed >> m & 1u) != 0)
            BP_TRY(bp_node_require(node, bp_members[m].name, bp_members[m].needed, err));
    material->refraction_index = material->kind == BP_MATERIAL_GLOSSY ? BP_COAT_INDEX : 1;
    for (int m = 0; m < BP_MEMBER_COUNT; m++) BP_TRY(read_member(node, (BpMember)m, scene, material, err));
    /* A mirror, which light can be traced through. */
    if (material->kind == BP_MATERIAL_ROUGH_METAL && material->roughness == 0)
        material->kind = BP_MATERIAL_METAL;
    if (material->kind == BP_MATERIAL_ROUGH_DIELECTRIC && material->roughness == 0)
        material->kind = BP_MATERIAL_DIELECTRIC, material->fresnel = BP_FRESNEL_EXACT; /* as facets have it */
    return BP_OK;
}
