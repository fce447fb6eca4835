/* scene_particles.h: the particles of a scene document.
 *
 * In:    the node of "particles".   Out: the particles of the files that it names, as spheres, triangles and
 * capsules. Knows: the members of an entry, where relative paths begin. Does not know: how formats are read
 * (particles/file.c). */
#ifndef BP_FORMATS_SCENE_PARTICLES_H
#define BP_FORMATS_SCENE_PARTICLES_H

#include "material_index.h"
#include "scene_changes.h"

/* Adds the particles of the files of "particles" to the scene, whose materials have room for one more. */
BpStatus bp_parse_particles(const BpNode *node, const BpMaterialIndex *index, const BpSceneChanges *changes,
                            BpScene *scene, BpError *err);

#endif
