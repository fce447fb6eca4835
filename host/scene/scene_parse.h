/* scene_parse.h: what the files that read a scene document share.
 *
 * In:    nodes of the document.   Out: parts of a BpScene.
 * Knows: the grammar.             Does not know: effects, packed data, devices. */
#ifndef BP_SCENE_PARSE_H
#define BP_SCENE_PARSE_H

#include "scene.h"
#include "scene_document.h"

enum { BP_PARSE_NO_CLOUDS = 1 }; /* check the members of "clouds", but open none of their files */

/* bp_scene_parse with flags. */
BpStatus bp_scene_parse_with(const char *text, size_t length, const char *name, unsigned flags,
                             BpScene **scene, BpError *err);

/* The fourth edition's camera, all by default. */
void bp_camera_defaults(BpCamera *camera);
/* Of a lens whose cone of rays has the angle at its point in focus. */
double bp_lens_radius(double defocus_degrees, double focus_dist);
BpStatus bp_parse_camera(const BpNode *node, BpCamera *camera, BpError *err);
/* As the grammar has it: "lambertian". */
const char *bp_material_type_name(BpMaterialKind kind);
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

/* Copies a string; NULL becomes "". */
BpStatus bp_copy_text(const char *text, char **copy, BpError *err);
/* A scene that holds nothing but defaults. */
BpStatus bp_scene_create_empty(const char *path, BpScene **scene, BpError *err);

#endif
