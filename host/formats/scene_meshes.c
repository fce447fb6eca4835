/* scene_meshes.c: see scene_meshes.h. */
#include "scene_meshes.h"

#include "base/input_file.h"
#include "mesh_triangles.h"
#include "named_file.h"
#include "scene_medium.h"

#include <stdlib.h>
#include <string.h>

/* ---- members ---- */

/* What meshes of other programs have. */
static BpStatus refuse_later(const BpNode *node, BpError *err) {
    static const char *const members[][2] = {
        {"motion", "meshes stand still while the shutter is open; remove it"},
        {"translate_end", "meshes stand still while the shutter is open; remove it"},
        {"center_end", "meshes stand still while the shutter is open; remove it"}};
    for (size_t i = 0; i < BP_COUNT(members); i++) {
        const BpNode member = bp_node_member(node, members[i][0]);
        if (member.value != NULL)
            return bp_node_fail(&member, BP_PART_NAME, err, "not for meshes: %s", members[i][1]);
    }
    return BP_OK;
}

static BpStatus parse_scale(const BpNode *node, double scale[3], BpError *err) {
    if (json_is_array(node->value)) {
        BP_TRY(bp_node_vector(node, scale, err));
    } else {
        BP_TRY(bp_node_number(node, &scale[0], err));
        scale[1] = scale[2] = scale[0];
    }
    if (scale[0] == 0 || scale[1] == 0 || scale[2] == 0)
        return bp_node_wrong(node, "a number other than 0, or three such numbers for x, y and z", err);
    return BP_OK;
}

static BpStatus parse_placement(const BpNode *node, BpPlacement *placement, BpError *err) {
    double scale[3] = {1, 1, 1}, degrees[3] = {0, 0, 0}, way[3] = {0, 0, 0};
    const BpNode scaled = bp_node_member(node, "scale"), turned = bp_node_member(node, "rotate"),
                 moved = bp_node_member(node, "translate");
    BP_TRY(parse_scale(&scaled, scale, err));
    BP_TRY(bp_node_vector(&turned, degrees, err));
    BP_TRY(bp_node_vector(&moved, way, err));
    *placement = bp_placement(scale, degrees, way);
    return BP_OK;
}

/* ---- materials ---- */

static uint32_t number_in_mesh(const BpMesh *mesh, const char *name) {
    for (size_t m = 0; m < mesh->material_count; m++)
        if (mesh->materials[m].face_count > 0 && strcmp(mesh->materials[m].name, name) == 0)
            return (uint32_t)m;
    return BP_MESH_NO_MATERIAL;
}

static BpStatus refuse_name(const BpNode *node, const BpMesh *mesh, BpError *err) {
    const char **names = malloc((mesh->material_count + 1) * sizeof *names);
    size_t count = 0;
    char text[BP_MISSING_NAME_SIZE];
    if (names == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a mesh's materials");
    for (size_t m = 0; m < mesh->material_count; m++)
        if (mesh->materials[m].face_count > 0) names[count++] = mesh->materials[m].name;
    if (count > 0)
        bp_missing_name_text("material", "the file", names, count, node->member, text);
    else
        snprintf(text, sizeof text,
                 "the file names no materials of faces; remove it, and give all of them one by \"material\"");
    free(names);
    return bp_node_fail(node, BP_PART_NAME, err, "%s", text);
}

/* The scene's materials of the names that the file's faces use. `mesh`: NULL where no file is opened. */
static BpStatus parse_materials(const BpNode *node, const BpMaterialIndex *index, const BpMesh *mesh,
                                uint32_t *materials, BpError *err) {
    const char *name;
    json_t *value;
    json_object_foreach(node->value, name, value) {
        const BpNode child = bp_node_member(node, name);
        uint32_t material = 0;
        BP_TRY(bp_parse_material_name(&child, index, &material, err));
        if (mesh == NULL) continue;
        const uint32_t number = number_in_mesh(mesh, name);
        if (number == BP_MESH_NO_MATERIAL) return refuse_name(&child, mesh, err);
        materials[number] = material;
    }
    return BP_OK;
}

/* ---- a mesh ---- */

static BpStatus add_mesh(const BpNode *materials, const BpMaterialIndex *index, BpMesh *mesh, BpMeshUse *use,
                         BpScene *scene, BpError *err) {
    uint32_t *const own = malloc((mesh->material_count + 1) * sizeof *own);
    if (own == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a mesh's materials");
    for (size_t m = 0; m < mesh->material_count; m++) own[m] = UINT32_MAX;
    use->materials = own;
    BpStatus status = parse_materials(materials, index, mesh, own, err);
    if (status == BP_OK) status = bp_mesh_add_triangles(mesh, use, scene, err);
    free(own);
    return status;
}

static BpStatus read_mesh(const BpNode *node, const BpMaterialIndex *index, BpMeshUse *use,
                          const BpSceneChanges *changes, BpScene *scene, BpError *err) {
    const BpNode file_node = bp_node_member(node, "file"), materials = bp_node_member(node, "materials");
    const size_t first = scene->triangle_count;
    FILE *stream = NULL;
    uint64_t size = 0;
    BpMesh mesh = {0};
    char *const path = bp_path_beside(file_node.document->name, use->name);
    if (path == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a path");
    BpStatus status = bp_node_open_file(&file_node, path, "a file of a mesh", &stream, &size, err);
    if (status == BP_OK) {
        status = bp_mesh_read_stream(stream, path, &mesh, err);
        fclose(stream);
        if (status == BP_ERR_SCENE && err != NULL && (changes->flags & BP_PARSE_MADE) == 0)
            bp_name_document(&file_node, "a mesh", err);
    }
    if (status == BP_OK) {
        BpError inner = {0};
        status = add_mesh(&materials, index, &mesh, use, scene, &inner);
        if (status == BP_ERR_SCENE && inner.line == 0)
            bp_node_fail(&file_node, BP_PART_VALUE, err, "%s", inner.message);
        else if (status != BP_OK && err != NULL)
            *err = inner;
        if (status == BP_ERR_SCENE && inner.line == 0) bp_error_clear(&inner);
    }
    bp_mesh_clear(&mesh);
    char *const text = status == BP_OK ? json_dumps(node->value, JSON_PRESERVE_ORDER) : NULL;
    if (status == BP_OK && text == NULL) status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a mesh");
    if (status == BP_OK) status = bp_keep_mesh_file(use->name, first, text, scene, err);
    free(text);
    free(path);
    return status;
}

static BpStatus parse_mesh(const BpNode *node, const BpMaterialIndex *index, const BpSceneChanges *changes,
                           BpScene *scene, BpError *err) {
    static const char *const names[] = {"file",   "material",  "materials", "scale",
                                        "rotate", "translate", "smooth",    "interior"};
    if (!json_is_object(node->value))
        return bp_node_wrong(node, "an object: { \"file\": \"bunny.ply\", \"material\": ... }", err);
    BP_TRY(refuse_later(node, err));
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(node, "file",
                           "the path of a PLY, OBJ, STL, OFF or glTF file, relative to the scene", err));
    const BpNode file = bp_node_member(node, "file"), material = bp_node_member(node, "material"),
                 materials = bp_node_member(node, "materials");
    BpMeshUse use = {.material = UINT32_MAX};
    const BpNode smooth = bp_node_member(node, "smooth");
    BP_TRY(bp_node_string(&file, &use.name, err));
    BP_TRY(bp_node_boolean(&smooth, &use.smooth, err));
    BP_TRY(parse_placement(node, &use.placement, err));
    const BpNode interior = bp_node_member(node, "interior");
    BP_TRY(bp_parse_medium_name(&interior, scene, &use.interior, err));
    if (material.value != NULL) BP_TRY(bp_parse_material_name(&material, index, &use.material, err));
    if (materials.value != NULL && !json_is_object(materials.value))
        return bp_node_wrong(&materials,
                             "an object: { \"a material of the file\": \"one of the scene\", ... }", err);
    if (material.value == NULL && materials.value == NULL)
        return bp_node_fail(
            node, BP_PART_VALUE, err,
            "found no \"material\", expected a name from \"materials\", or in \"materials\" one "
            "for each that the file names");
    BP_TRY(parse_materials(&materials, index, NULL, NULL, err));
    if ((changes->flags & BP_PARSE_NO_CLOUDS) != 0 || changes->frame_count != NULL) return BP_OK;
    return read_mesh(node, index, &use, changes, scene, err);
}

BpStatus bp_parse_meshes(const BpNode *node, const BpMaterialIndex *index, const BpSceneChanges *changes,
                         BpScene *scene, BpError *err) {
    BP_TRY(bp_node_list(node, "a list of meshes: [ { \"file\": \"bunny.ply\", \"material\": ... } ]", err));
    for (size_t i = 0; i < json_array_size(node->value); i++) {
        const BpNode element = bp_node_element(node, i);
        BP_TRY(parse_mesh(&element, index, changes, scene, err));
    }
    return BP_OK;
}
