/* scene_texture.h: the textures of a scene document, and where a material asks for one.
 *
 * In:    the nodes of "textures", and of members that name one.   Out: BpTextures; the one that a member has.
 * Knows: the grammar.   Does not know: which materials use them. Ranges are checked by scene_validate.c. */
#ifndef BP_FORMATS_SCENE_TEXTURE_H
#define BP_FORMATS_SCENE_TEXTURE_H

#include "document.h"
#include "scene/scene.h"

/* The scene's textures. */
BpStatus bp_parse_textures(const BpNode *node, unsigned flags, BpScene *scene, BpError *err);
/* Finds the texture that the node, { "texture": name }, names; *number counts from 1. */
BpStatus bp_parse_texture_name(const BpNode *node, const BpScene *scene, uint32_t *number, BpError *err);

#endif
