/* line_sets.h: lines that a caller hands over as arrays.
 *
 * In:    sets of arrays.   Out: their capsules and colours, behind all others of a scene.
 * Knows: how arrays lie in memory, the two colours of a line.   Does not know: who made them. */
#ifndef BP_FORMATS_LINE_SETS_H
#define BP_FORMATS_LINE_SETS_H

#include "material_index.h"

/* Adds the lines to the scene, whose materials have room for one more. */
BpStatus bp_add_line_sets(const BpMaterialIndex *index, const BpShapeSets *shapes, BpScene *scene,
                          BpError *err);

#endif
