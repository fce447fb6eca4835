/* scene_figure.h: the text beside a picture, of a scene document.
 *
 * In:    the node of "figure".   Out: this part of a BpScene.
 * Knows: the grammar.   Does not know: where the text stands (figure/layout.h). */
#ifndef BP_FORMATS_SCENE_FIGURE_H
#define BP_FORMATS_SCENE_FIGURE_H

#include "document.h"
#include "scene/scene.h"

BpStatus bp_parse_figure(const BpNode *node, BpScene *scene, BpError *err);

#endif
