/* triangle_overlap.h: two triangles in one plane of which one lies on the other.
 *
 * In:    triangles, and which of them matter.   Out: a pair, or none.
 * Knows: geometry.   Does not know: effects, devices. */
#ifndef BP_SCENE_TRIANGLE_OVERLAP_H
#define BP_SCENE_TRIANGLE_OVERLAP_H

#include "scene.h"

typedef struct BpOverlap {
    bool found;
    size_t one, other; /* one < other */
} BpOverlap;

/* Looks for a pair of which one has its mark. Sides and corners that meet are no overlap. Takes time by the
 * number of triangles and a little more, unless many lie across each other. BP_ERR_MEMORY. */
BpStatus bp_find_overlap(const BpTriangle *triangles, const bool *marks, size_t count, BpOverlap *overlap,
                         BpError *err);

#endif
