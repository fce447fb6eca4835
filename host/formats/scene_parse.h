/* scene_parse.h: what the files that read a scene document share.
 *
 * In:    nodes of the document.   Out: parts of a BpScene.
 * Knows: the grammar.             Does not know: effects, packed data, devices. */
#ifndef BP_FORMATS_SCENE_PARSE_H
#define BP_FORMATS_SCENE_PARSE_H

#include "document.h"
#include "scene/scene.h"

enum {
    BP_PARSE_NO_CLOUDS = 1, /* check the members, but open no file of points; an image is one grey texel */
    BP_PARSE_MADE = 2 /* the document was made for one file: errors in that need not name the document */
};

/* Files of particles that stay open, so that a trajectory is read once for all its frames. Zero-initialise
 * it. */
enum { BP_PARTICLE_CACHE_SIZE = 16 };
typedef struct BpParticleCache {
    struct {
        char *path;
        FILE *stream;
        struct BpParticleFile *file;
    } entry[BP_PARTICLE_CACHE_SIZE];
    size_t count;
} BpParticleCache;
void bp_particle_cache_clear(BpParticleCache *cache);

/* Changes that a command line makes to the document. Zeros: none. */
typedef struct BpSceneChanges {
    unsigned flags;    /* BP_PARSE_... */
    BpHeldFiles *held; /* Optional: as of a document */
    bool has_frame;
    int64_t frame;          /* of every file of particles that has frames */
    bool fit;               /* a camera fitted to the particles, or to the scene where there are none */
    uint32_t turning;       /* the fitted camera is for a turntable of so many pictures */
    const BpCamera *camera; /* Optional: takes its place, direction and focus instead of fitting */
    BpParticleCache *cache; /* Optional: keeps files open from frame to frame */
    uint64_t *frame_count;  /* Optional: counts frames instead of reading any; of several files, the least */
    bool has_range;         /* of the column that gives colours, where the document has none */
    double range[2];
    const char *const *set; /* Optional: members of the document, see scene_changes.h */
    size_t set_count;
    const char *projection; /* Optional. "perspective" or "orthographic", instead of the document's */
    const char *lighting; /* Optional. A name of lighting.h, instead of the document's light or background */
    const char *fresnel;  /* Optional. "schlick" or "exact", for all materials that have such a member */
    size_t *fresnel_counts;     /* Optional: in how many it was different, and how many have it */
    const BpSphereSet *spheres; /* Optional: spheres after all others */
    size_t sphere_set_count;
} BpSceneChanges;

BpStatus bp_scene_parse_changed(const char *text, size_t length, const char *name,
                                const BpSceneChanges *changes, BpScene **scene, BpError *err);
/* The direction to the camera that "view" means, and the axis that is up, in camera->vup. */
void bp_scene_view(BpScene *scene, double direction[3]);
/* bp_scene_load with changes. */
BpStatus bp_scene_load_changed(const char *path, const BpSceneChanges *changes, BpScene **scene,
                               BpError *err);

/* Reads what rays that hit nothing see (scene_background.c); `flags` as in BpSceneChanges. */
BpStatus bp_parse_background(const BpNode *node, unsigned flags, BpScene *scene, BpError *err);
BpStatus bp_parse_backdrop(const BpNode *node, BpScene *scene, BpError *err);
/* After the background, since an image there is refused. */
BpStatus bp_parse_shadow_catcher(const BpNode *node, BpScene *scene, BpError *err);
/* `name`: Optional, stands for the node. After the backdrop, which is white where a light has none. */
BpStatus bp_parse_lighting(const BpNode *root, const char *name, BpScene *scene, BpError *err);

BpStatus bp_parse_camera(const BpNode *node, BpCamera *camera, BpError *err);
/* The scene's textures (scene_texture.c). */
BpStatus bp_parse_textures(const BpNode *node, unsigned flags, BpScene *scene, BpError *err);
/* The image that the node names, as `encoding` and `scale`, nodes too, say (scene_image.c); it is the
 * scene's, which has each file once. */
BpStatus bp_parse_image(const BpNode *file, const BpNode *encoding, const BpNode *scale, unsigned flags,
                        BpScene *scene, BpImage **image, BpError *err);
/* Finds the texture that the node, { "texture": name }, names; *number counts from 1. */
BpStatus bp_parse_texture_name(const BpNode *node, const BpScene *scene, uint32_t *number, BpError *err);
/* The scene's media (scene_medium.c). */
BpStatus bp_parse_media(const BpNode *node, BpScene *scene, BpError *err);
/* Finds the medium that the node, a string, names; *number counts from 1, and stays where there is no node.
 */
BpStatus bp_parse_medium_name(const BpNode *node, const BpScene *scene, uint32_t *number, BpError *err);
/* `material` is zeroed; its name is the caller's to set. The scene has its textures. */
BpStatus bp_parse_material(const BpNode *node, const BpScene *scene, BpMaterial *material, BpError *err);

/* The materials of a scene in the order of their names. */
typedef struct BpMaterialIndex {
    const BpMaterial **by_name; /* owned */
    const BpMaterial *first;    /* materials[0] */
    size_t count;
} BpMaterialIndex;
/* Finds the material that the node, a string, names; the error names the nearest. */
BpStatus bp_parse_material_name(const BpNode *node, const BpMaterialIndex *index, uint32_t *material,
                                BpError *err);

/* Adds the particles of the files of "particles" to the scene, whose materials have room for one more. */
BpStatus bp_parse_particles(const BpNode *node, const BpMaterialIndex *index, const BpSceneChanges *changes,
                            BpScene *scene, BpError *err);
/* Adds the changes' sets of spheres to the scene, whose materials have room for one more. */
BpStatus bp_add_sphere_sets(const BpMaterialIndex *index, const BpSceneChanges *changes, BpScene *scene,
                            BpError *err);
/* The place of a name among the scene's materials, or UINT32_MAX. */
uint32_t bp_material_find(const BpMaterialIndex *index, const char *name);
/* Writes the message about a name that is not among them. Fails only if memory runs out. */
BpStatus bp_missing_material_text(const BpMaterialIndex *index, const char *name,
                                  char out[BP_MISSING_NAME_SIZE], BpError *err);
/* The material of spheres that name none: matte. It is made when it is first asked for. UINT32_MAX: out of
 * memory, which `err` says. */
uint32_t bp_implicit_material(BpScene *scene, BpError *err);
/* Adds the points of the clouds' files to the scene's spheres; `flags` as in BpSceneChanges. */
BpStatus bp_parse_clouds(const BpNode *node, const BpMaterialIndex *index, unsigned flags, BpScene *scene,
                         BpError *err);

#endif
