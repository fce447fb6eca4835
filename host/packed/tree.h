/* tree.h: a bounding volume hierarchy over spheres, triangles and capsules, with wide nodes and leaves as
 * structures of arrays.
 *
 * In:    centres, radii and vertices, in double, relative to the camera.
 * Out:   BpTree: node boxes (rounded outward when narrowed), child words, leaves and slots, in the layout of
 *        kernels/scene_types.h.
 * Knows: the packed layout, threads.   Does not know: OpenCL, what spheres are made of.
 *
 * `single_precision` decides whether the real arrays hold float or double. */
#ifndef BP_PACKED_TREE_H
#define BP_PACKED_TREE_H

#include "scene/scene.h"

typedef struct BpTreeOptions {
    uint32_t width;        /* lanes of a node and of a leaf: 2, 4, 8 or 16 */
    bool single_precision; /* store float, else double */
    bool list;             /* leaves only, in order of index; no nodes */
    unsigned threads;      /* 0: all cores */
    bool motions;          /* the kernel reads motions, even if no sphere moves */
    bool axes;             /* the kernel reads axes, even if there are no capsules */
    bool bodies;           /* the kernel reads the table of bodies, even if there are none */
} BpTreeOptions;

typedef struct BpTree {
    uint32_t width;
    bool single_precision;
    /* Leaf 0 .. first_leaves-1 hold spheres that are tested before the tree is entered (all of them, for a
     * list). Child words never point at them. A tree has one at most, with up to `width` huge spheres, the
     * largest first: those whose box has more than 1/64 of the surface of the box around all but the `width`
     * largest. */
    uint32_t first_leaves;
    uint32_t node_count; /* node 0 is the root; 0: a list */
    uint32_t leaf_count;
    uint32_t depth;        /* levels of nodes, <= TREE_DEPTH_MAX */
    void *node_boxes;      /* node_count * NODE_REALS(width) reals */
    uint32_t *children;    /* node_count * width */
    void *leaves;          /* first_triangles * LEAF_REALS(width) reals */
    uint32_t *slot_sphere; /* leaf_count * width; of triangles: their index, after that of all spheres */
    /* A leaf holds shapes of one kind. Those from `first_triangles` on hold triangles, the others spheres, of
     * which capsules are some, with an axis; their index is after that of all triangles. */
    uint32_t first_triangles;
    uint32_t triangle_leaves;   /* leaf_count - first_triangles */
    void *triangles;            /* triangle_leaves * TRIANGLE_REALS(width) reals */
    uint32_t normal_leaves;     /* triangle_leaves, or 0 where no triangle is smooth */
    void *triangle_normals;     /* normal_leaves * TRIANGLE_REALS(width) reals */
    uint32_t coordinate_leaves; /* triangle_leaves, or 0 where no texture lies on a triangle */
    void *triangle_coordinates; /* coordinate_leaves * COORDINATE_REALS(width) reals */
    bool has_motions, has_normals, has_coordinates;
    uint32_t motion_leaves; /* first_triangles, or 0 where there are no motions */
    void *leaf_motions;     /* motion_leaves * MOTION_REALS(width) reals */
    bool has_axes;
    uint32_t axis_leaves; /* first_triangles, or 0 where there are no axes */
    void *leaf_axes;      /* axis_leaves * AXIS_REALS(width) reals, of which pack.c writes the colours */
    uint32_t own_slot;    /* of the sphere at rest whose surface `origin` lies on, or NO_SLOT */
    double build_seconds;
} BpTree;

/* Builds a tree over the scene's shapes with `origin` (the camera's position) subtracted.
 * Every sphere stands in exactly one slot; boxes hold spheres on all of their way. `origin` stays on its side
 * of every surface at rest, rounded as the spheres may be, and lies on one at most. The result does not
 * depend on the number of threads. On failure `tree` is empty. BP_ERR_MEMORY or BP_ERR_LIMIT. Free with
 * bp_tree_clear(). */
BpStatus bp_tree_build(const BpScene *scene, const double origin[3], const BpTreeOptions *options,
                       BpTree *tree, BpError *err);
void bp_tree_clear(BpTree *tree);

#endif
