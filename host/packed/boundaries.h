/* boundaries.h: the table by which a kernel finds out which medium a point lies in.
 *
 * In:    a scene, and where its shapes stand in the tree.   Out: the array `boundaries` of scene_types.h.
 * Knows: medium.h's rule, the packed layout.   Does not know: what media do to light. */
#ifndef BP_PACKED_BOUNDARIES_H
#define BP_PACKED_BOUNDARIES_H

#include "tree.h"

/* What the array starts with, for kernels that know media in bodies. */
typedef struct BpBodyTable {
    bool wanted;
    double origin[3]; /* where the camera's rays begin */
    uint32_t material_count,
        first_row; /* of packed materials: all, and that of body 0; those of others follow */
} BpBodyTable;

/* *count: of its uints. The caller frees the array. BP_ERR_MEMORY. */
BpStatus bp_pack_boundaries(const BpScene *scene, const BpTree *tree, const BpBodyTable *table,
                            uint32_t **boundaries, uint32_t *count, BpError *err);

#endif
