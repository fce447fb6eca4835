/* placement.h: how boxes and meshes are put in their place.
 *
 * In:    a scale, angles, a way.   Out: points where they belong.
 * Knows: the order: scale, turn about x, then y, then z, move.   Does not know: what the points are of. */
#ifndef BP_SCENE_PLACEMENT_H
#define BP_SCENE_PLACEMENT_H

#include <stdbool.h>

typedef struct BpPlacement {
    double scale[3];
    double sine[3], cosine[3]; /* of the angles about x, y and z */
    double translate[3];
} BpPlacement;

/* Counter-clockwise, seen from the axis' tip. Quarter turns are exact: what is parallel to the axes stays so.
 */
BpPlacement bp_placement(const double scale[3], const double degrees[3], const double translate[3]);
void bp_place_point(const BpPlacement *placement, double point[3]);
/* The same of a direction across a surface, of any length. */
void bp_place_normal(const BpPlacement *placement, double normal[3]);
/* Whether it mirrors, so that what ran clockwise runs counter-clockwise. */
bool bp_placement_mirrors(const BpPlacement *placement);

#endif
