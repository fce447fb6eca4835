/* material_index.c: see material_index.h. */
#include "material_index.h"

#include <stdlib.h>
#include <string.h>

static int compare_names(const void *a, const void *b) {
    return strcmp((*(const BpMaterial *const *)a)->name, (*(const BpMaterial *const *)b)->name);
}

BpStatus bp_material_index_create(const BpScene *scene, BpMaterialIndex *index, BpError *err) {
    index->count = scene->material_count;
    index->first = scene->materials;
    index->by_name = malloc((index->count > 0 ? index->count : 1) * sizeof(BpMaterial *));
    if (index->by_name == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu materials", index->count);
    for (size_t i = 0; i < index->count; i++) index->by_name[i] = &scene->materials[i];
    qsort(index->by_name, index->count, sizeof(BpMaterial *), compare_names);
    return BP_OK;
}

BpStatus bp_missing_material_text(const BpMaterialIndex *index, const char *name,
                                  char out[BP_MISSING_NAME_SIZE], BpError *err) {
    const char **names = malloc((index->count + 1) * sizeof *names);
    if (names == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    for (size_t i = 0; i < index->count; i++) names[i] = index->by_name[i]->name;
    bp_missing_name_text("material", "materials", names, index->count, name, out);
    free(names);
    return BP_OK;
}

uint32_t bp_material_find(const BpMaterialIndex *index, const char *name) {
    size_t low = 0, high = index->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        const int order = strcmp(name, index->by_name[middle]->name);
        if (order == 0) return (uint32_t)(index->by_name[middle] - index->first);
        if (order < 0)
            high = middle;
        else
            low = middle + 1;
    }
    return UINT32_MAX;
}

BpStatus bp_parse_material_name(const BpNode *node, const BpMaterialIndex *index, uint32_t *material,
                                BpError *err) {
    const char *name = NULL;
    BP_TRY(bp_node_string(node, &name, err));
    const uint32_t found = bp_material_find(index, name);
    if (found == UINT32_MAX) {
        char text[BP_MISSING_NAME_SIZE];
        BP_TRY(bp_missing_material_text(index, name, text, err));
        return bp_node_fail(node, BP_PART_VALUE, err, "%s", text);
    }
    *material = found;
    return BP_OK;
}

BpStatus bp_material_of_set(const BpMaterialIndex *index, const char *material, const char *set,
                            BpScene *scene, uint32_t *found, BpError *err) {
    *found = material == NULL ? bp_implicit_material(scene, err) : bp_material_find(index, material);
    if (*found != UINT32_MAX) return BP_OK;
    if (material == NULL) return BP_ERR_MEMORY;
    char text[BP_MISSING_NAME_SIZE];
    BP_TRY(bp_missing_material_text(index, material, text, err));
    return bp_fail(err, BP_ERR_SCENE, "%s: %s", set, text);
}

/* Plain matte, whose colour each particle brings. */
uint32_t bp_implicit_material(BpScene *scene, BpError *err) {
    if (scene->implicit_material != SIZE_MAX) return (uint32_t)scene->implicit_material;
    BpMaterial *const material = &scene->materials[scene->material_count];
    *material = (BpMaterial){.kind = BP_MATERIAL_LAMBERTIAN, .albedo = {0.8, 0.8, 0.8}};
    if (bp_copy_text("particles", &material->name, err) != BP_OK) return UINT32_MAX;
    scene->implicit_material = scene->material_count++;
    return (uint32_t)scene->implicit_material;
}
