/* scene_medium.h: the media of a scene document, and where a shape or the scene asks for one.
 *
 * In:    the nodes of "media", "medium" and "interior".   Out: BpMedia; the number of a medium.
 * Knows: the grammar.   Does not know: which shapes are filled. Ranges are checked by scene_validate.c. */
#ifndef BP_FORMATS_SCENE_MEDIUM_H
#define BP_FORMATS_SCENE_MEDIUM_H

#include "document.h"
#include "scene/scene.h"

/* The scene's media. */
BpStatus bp_parse_media(const BpNode *node, BpScene *scene, BpError *err);
/* Finds the medium that the node, a string, names; *number counts from 1, and stays where there is no node.
 */
BpStatus bp_parse_medium_name(const BpNode *node, const BpScene *scene, uint32_t *number, BpError *err);
/* The number of the medium that fills a set of shapes which a caller hands over, by its name; `interior`
 * NULL: 0. `set`: what messages call the set. BP_ERR_SCENE proposes the nearest name; BP_ERR_MEMORY. */
BpStatus bp_medium_of_set(const char *interior, const char *set, const BpScene *scene, uint32_t *number,
                          BpError *err);
/* Puts the interior, unless it is 0, into the shapes from `first` to before `end`; *interiors, of all of
 * them, has room for the first *interior_count. BP_ERR_MEMORY. */
BpStatus bp_fill_interiors(uint32_t interior, size_t first, size_t end, uint32_t **interiors,
                           size_t *interior_count, BpError *err);
/* What fills the shape `index`, a node with or without "interior", of `count`; the same arrays.
 * BP_ERR_MEMORY, and errors of the document. */
BpStatus bp_parse_interior(const BpNode *node, const BpScene *scene, size_t index, size_t count,
                           uint32_t **interiors, size_t *interior_count, BpError *err);

#endif
