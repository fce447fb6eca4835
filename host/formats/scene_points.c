/* scene_points.c: see scene_points.h. */
#include "scene_points.h"

#include "base/input_file.h"
#include "named_file.h"
#include "ply.h"

#include <stdlib.h>
#include <string.h>

static BpStatus read_file(const BpNode *file_node, const char *file, const BpPlyOptions *options,
                          BpScene *scene, BpError *err) {
    FILE *stream = NULL;
    uint64_t size = 0;
    char *path = bp_path_beside(file_node->document->name, file);
    if (path == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a path");
    BpStatus status = bp_node_open_file(file_node, path, "a PLY file", &stream, &size, err);
    if (status != BP_OK) goto done;
    if (size > BP_PLY_BYTES_MAX) {
        status =
            bp_node_fail(file_node, BP_PART_VALUE, err,
                         "\"%.200s\": found %llu bytes, expected at most %llu, which is a kilobyte for every "
                         "sphere that a scene can have",
                         file, (unsigned long long)size, (unsigned long long)BP_PLY_BYTES_MAX);
        fclose(stream);
        goto done;
    }
    const size_t first = scene->sphere_count;
    char notes[BP_PLY_NOTES_SIZE];
    status = bp_ply_read(stream, size, path, options, scene, notes, err);
    fclose(stream);
    if (status == BP_ERR_SCENE && err != NULL) bp_name_document(file_node, "a cloud", err);
    if (status == BP_OK && notes[0] != '\0') status = bp_scene_note(scene, file, notes, err);
    if (status == BP_OK) status = bp_keep_point_file(file, first, NULL, scene, err);
done:
    free(path);
    return status;
}

static BpStatus parse_material_list(const BpNode *node, const BpMaterialIndex *index, uint32_t **materials,
                                    size_t *count, BpError *err) {
    BP_TRY(bp_node_list(node, "a list of names from \"materials\"", err));
    *count = json_array_size(node->value);
    if (node->value != NULL && *count == 0) return bp_node_wrong(node, "one name or more", err);
    if (*count == 0) return BP_OK;
    *materials = malloc(*count * sizeof **materials);
    if (*materials == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu materials", *count);
    for (size_t i = 0; i < *count; i++) {
        const BpNode element = bp_node_element(node, i);
        BP_TRY(bp_parse_material_name(&element, index, &(*materials)[i], err));
    }
    return BP_OK;
}

static BpStatus parse_cloud(const BpNode *node, const BpMaterialIndex *index, unsigned flags, BpScene *scene,
                            BpError *err) {
    static const char *const names[] = {"file", "radius", "material", "materials"};
    if (!json_is_object(node->value))
        return bp_node_wrong(node, "an object: { \"file\": \"points.ply\", ... }", err);
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(node, "file", "the path of a PLY file, relative to the scene", err));
    const BpNode file_node = bp_node_member(node, "file");
    const BpNode radius = bp_node_member(node, "radius");
    const BpNode material = bp_node_member(node, "material");
    const BpNode materials = bp_node_member(node, "materials");
    BpPlyOptions options = {.material = BP_PLY_NO_MATERIAL};
    uint32_t *list = NULL;
    const char *file = NULL;
    BP_TRY(bp_node_string(&file_node, &file, err));
    BP_TRY(bp_node_number(&radius, &options.radius, err));
    if (radius.value != NULL && options.radius == 0)
        return bp_node_wrong(&radius, "a number other than 0, or no \"radius\" where the file has radii",
                             err);
    if (material.value != NULL)
        BP_TRY(bp_parse_material_name(&material, index, &options.material, err));
    else if (materials.value == NULL)
        return bp_node_fail(node, BP_PART_VALUE, err,
                            "found no \"material\", expected a name from \"materials\", or a list of them in "
                            "\"materials\" that the file's points choose from");
    BpStatus status = parse_material_list(&materials, index, &list, &options.material_count, err);
    options.materials = list;
    if (status == BP_OK && (flags & BP_PARSE_NO_CLOUDS) == 0)
        status = read_file(&file_node, file, &options, scene, err);
    free(list);
    return status;
}

BpStatus bp_parse_clouds(const BpNode *node, const BpMaterialIndex *index, unsigned flags, BpScene *scene,
                         BpError *err) {
    BP_TRY(bp_node_list(node, "a list of clouds: [ { \"file\": \"points.ply\", ... } ]", err));
    for (size_t i = 0; i < json_array_size(node->value); i++) {
        const BpNode element = bp_node_element(node, i);
        BP_TRY(parse_cloud(&element, index, flags, scene, err));
    }
    return BP_OK;
}
