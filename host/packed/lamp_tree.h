/* lamp_tree.h: the tree from which the kernel chooses lamps.
 *
 * In:    a validated scene, its packed spheres.
 * Out:   BpLampTree, in the layout of kernels/scene_types.h.
 * Knows: what counts as a lamp, the packed layout.   Does not know: OpenCL, how surfaces reflect.
 *
 * A lamp is a triangle that emits, or a sphere that does, unless it encloses every other sphere: then no
 * point is outside it, and it is the sky. Of one that moves, the tree has the place where the shutter opens,
 * and the kernel adds its motion; the balls are around all of its way. A triangle stands in it as the ball
 * around it. The tree depends on the spheres' centres, motions and radii and the triangles' vertices as
 * packed, their radiance and their order in the scene, and not on how they themselves are arranged, since the
 * picture depends on it. */
#ifndef BP_PACKED_LAMP_TREE_H
#define BP_PACKED_LAMP_TREE_H

#include "tree.h"

typedef struct BpLampTree {
    uint32_t lamp_count;
    double unit;         /* of power: of the brightest lamp or disc, 1 over its luminance; 0: all is dark */
    uint32_t node_count; /* at least one: the root, without children where there is no lamp */
    uint32_t slot_count; /* of the shapes, or 0 where there is no lamp */
    void *lamps;         /* node_count * LAMP_NODE_REALS reals, in the precision of the spheres' tree */
    uint32_t *lamp_children; /* node_count * LAMP_WIDTH */
    uint32_t *slot_lamp;     /* slot_count */
} BpLampTree;

/* The sphere that emits and encloses every other sphere, or SIZE_MAX. A scene of one sphere has none. */
size_t bp_enclosing_lamp(const BpScene *scene);

/* Sphere `i` is a lamp of the tree. `enclosing`: see above. */
bool bp_sphere_is_sampled(const BpScene *scene, size_t i, size_t enclosing);

/* BP_ERR_MEMORY. On failure `lamps` is empty. Free with bp_lamp_tree_clear(). */
BpStatus bp_lamp_tree_build(const BpScene *scene, const BpTree *tree, BpLampTree *lamps, BpError *err);
void bp_lamp_tree_clear(BpLampTree *lamps);

#endif
