/* material_index.h: the materials of a scene by their names.
 *
 * In:    a scene that has its materials, a name.   Out: the place of the material; the one of spheres that
 * name none. Knows: names, how a wrong one is answered.   Does not know: what materials are made of
 * (scene_material.h). */
#ifndef BP_FORMATS_MATERIAL_INDEX_H
#define BP_FORMATS_MATERIAL_INDEX_H

#include "document.h"
#include "scene/scene.h"

/* The materials of a scene in the order of their names. */
typedef struct BpMaterialIndex {
    const BpMaterial **by_name; /* owned */
    const BpMaterial *first;    /* materials[0] */
    size_t count;
} BpMaterialIndex;
/* The scene's materials must stay where they are. Free by_name with free(). */
BpStatus bp_material_index_create(const BpScene *scene, BpMaterialIndex *index, BpError *err);
/* Finds the material that the node, a string, names; the error names the nearest. */
BpStatus bp_parse_material_name(const BpNode *node, const BpMaterialIndex *index, uint32_t *material,
                                BpError *err);

/* The place of a name among the scene's materials, or UINT32_MAX. */
uint32_t bp_material_find(const BpMaterialIndex *index, const char *name);
/* Writes the message about a name that is not among them. Fails only if memory runs out. */
BpStatus bp_missing_material_text(const BpMaterialIndex *index, const char *name,
                                  char out[BP_MISSING_NAME_SIZE], BpError *err);
/* The same of what a caller hands over; `material`: Optional, NULL is that of shapes that name none. Errors
 * begin with `set`, what messages call it. */
BpStatus bp_material_of_set(const BpMaterialIndex *index, const char *material, const char *set,
                            BpScene *scene, uint32_t *found, BpError *err);
/* The material of spheres that name none: matte. It is made when it is first asked for. UINT32_MAX: out of
 * memory, which `err` says. */
uint32_t bp_implicit_material(BpScene *scene, BpError *err);

#endif
