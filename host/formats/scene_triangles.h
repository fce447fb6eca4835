/* scene_triangles.h: the triangles, quads and boxes that a scene document lists.
 *
 * In:    the document.   Out: triangles, those of quads and boxes behind those that are listed.
 * Knows: the members of the three.   Does not know: which triangles a scene may have
 * (scene/triangle_rules.c).
 *
 * A quad is a corner and two sides, u and v, as in the book; its outside is where u x v points. A box is two
 * opposite corners, turned by `rotate` (degrees about x, then y, then z) and then moved by `translate`. A
 * vertex that triangles share is computed once, so it is the same in all of them, bit for bit.
 *
 * Texture coordinates of triangles are written beside them, those of quads and boxes follow from their sides;
 * these have some only where a texture needs them. */
#ifndef BP_FORMATS_SCENE_TRIANGLES_H
#define BP_FORMATS_SCENE_TRIANGLES_H

#include "material_index.h"

/* `root`: the document. Into the scene, which has no triangles yet. */
BpStatus bp_parse_triangles(const BpNode *root, const BpMaterialIndex *index, BpScene *scene, BpError *err);

#endif
