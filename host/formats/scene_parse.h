/* scene_parse.h: what the files that read a scene document share.
 *
 * In:    nodes of the document.   Out: parts of a BpScene.
 * Knows: the grammar.             Does not know: effects, packed data, devices. */
#ifndef BP_FORMATS_SCENE_PARSE_H
#define BP_FORMATS_SCENE_PARSE_H

#include "document.h"
#include "scene/scene.h"

enum { BP_PARSE_NO_CLOUDS = 1 }; /* check the members of "clouds", but open none of their files */

/* bp_scene_parse with flags. */
BpStatus bp_scene_parse_with(const char *text, size_t length, const char *name, unsigned flags,
                             BpScene **scene, BpError *err);

BpStatus bp_parse_camera(const BpNode *node, BpCamera *camera, BpError *err);
/* `material` is zeroed; its name is the caller's to set. */
BpStatus bp_parse_material(const BpNode *node, BpMaterial *material, BpError *err);

/* The materials of a scene in the order of their names. */
typedef struct BpMaterialIndex {
    const BpMaterial **by_name; /* owned */
    const BpMaterial *first;    /* materials[0] */
    size_t count;
} BpMaterialIndex;
/* Finds the material that the node, a string, names; the error names the nearest. */
BpStatus bp_parse_material_name(const BpNode *node, const BpMaterialIndex *index, uint32_t *material,
                                BpError *err);

/* Adds the points of the clouds' files to the scene's spheres; `flags` as in bp_scene_parse_with. */
BpStatus bp_parse_clouds(const BpNode *node, const BpMaterialIndex *index, unsigned flags, BpScene *scene,
                         BpError *err);

#endif
