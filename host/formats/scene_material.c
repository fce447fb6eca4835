/* scene_material.c: see scene_material.h. */
#include "scene_material.h"

#include "scene/material.h"
#include "scene_texture.h"

#include <stdio.h>
#include <string.h>

#define TYPE_NAME(identifier, name, kernel_kind, effect, traits, weight, members, needed, outcome)           \
    [BP_MATERIAL_##identifier] = (name),
static const char *const type_names[] = {BP_MATERIAL_LIST(TYPE_NAME)};
#define COLOUR_NAME(identifier, name, field, low, high, range, needed, place) name,
#define NUMBER_NAME(identifier, name, field, low, high, range, needed, place, cap) name,
#define CHOICE_NAME(identifier, name, field, place, moot, names) name,
static const char *const member_names[] = {"type", BP_MEMBER_LIST(COLOUR_NAME, NUMBER_NAME, CHOICE_NAME)};

/* The types whose bit is set, as `"a", "b" and "c"`; `last` stands before the last of several. */
static const char *join_types(unsigned types, const char *last, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (unsigned t = 0; t < BP_COUNT(type_names) && used < size; t++) {
        if ((types >> t & 1u) == 0) continue;
        const char *before = used == 0 ? "" : types >> (t + 1) == 0 ? last : ", ";
        const int length = snprintf(text + used, size - used, "%s\"%s\"", before, type_names[t]);
        used += length > 0 ? (size_t)length : 0;
    }
    return text;
}

static unsigned types_with(BpMember member) {
    unsigned types = 0;
    for (unsigned t = 0; t < BP_COUNT(type_names); t++)
        if (bp_material_has((BpMaterialKind)t, member)) types |= 1u << t;
    return types;
}

static BpStatus refuse_foreign_members(const BpNode *node, BpMaterialKind kind, BpError *err) {
    char owners[256];
    for (int m = 0; m < BP_MEMBER_COUNT; m++) {
        const BpNode member = bp_node_member(node, bp_members[m].name);
        if (member.value == NULL || bp_material_has(kind, (BpMember)m)) continue;
        return bp_node_fail(
            &member, BP_PART_NAME, err,
            "found in a material of type \"%s\", expected only in %s; remove it or change the type",
            type_names[kind], join_types(types_with((BpMember)m), " and ", owners, sizeof owners));
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
    int type = 0;
    BP_TRY(bp_node_object(node, member_names, BP_COUNT(member_names), err));
    join_types((1u << BP_COUNT(type_names)) - 1u, " or ", text + used, sizeof text - used);
    BP_TRY(bp_node_require(node, "type", text, err));
    const BpNode type_node = bp_node_member(node, "type");
    BP_TRY(bp_node_choice(&type_node, type_names, BP_COUNT(type_names), &type, err));
    material->kind = (BpMaterialKind)type;
    BP_TRY(refuse_foreign_members(node, material->kind, err));
    for (int m = 0; m < BP_MEMBER_COUNT; m++)
        if ((bp_material_types[type].needed >> m & 1u) != 0)
            BP_TRY(bp_node_require(node, bp_members[m].name, bp_members[m].needed, err));
    material->refraction_index = 1;
    for (int m = 0; m < BP_MEMBER_COUNT; m++) BP_TRY(read_member(node, (BpMember)m, scene, material, err));
    return BP_OK;
}
