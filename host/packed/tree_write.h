/* tree_write.h: from the binary tree to the packed arrays of BpTree.
 *
 * In:    the scene, the reordered items, the binary tree.   Out: node boxes, child words, leaves, slots.
 * Knows: the packed layout, rounding.   Does not know: how splits were chosen. */
#ifndef BP_PACKED_TREE_WRITE_H
#define BP_PACKED_TREE_WRITE_H

#include "tree.h"
#include "tree_binary.h"

/* A box in double; rounded outward when stored. */
typedef struct BpBounds {
    double low[3], high[3];
} BpBounds;

#define BP_BOUNDS_EMPTY                                                                                      \
    {                                                                                                        \
        {1e30, 1e30, 1e30}, {                                                                                \
            -1e30, -1e30, -1e30                                                                              \
        }                                                                                                    \
    }

static inline void bp_bounds_add(BpBounds *bounds, const BpBounds *other) {
    for (int a = 0; a < 3; ++a) {
        bounds->low[a] = other->low[a] < bounds->low[a] ? other->low[a] : bounds->low[a];
        bounds->high[a] = other->high[a] > bounds->high[a] ? other->high[a] : bounds->high[a];
    }
}

typedef struct BpTreeWriter {
    const BpScene *scene;
    const double *origin;
    const BpTreeItem *items, *triangle_items; /* reordered: of spheres, of triangles */
    BpTree *tree;
} BpTreeWriter;

/* The sphere as the splits see it and as a tree in single precision stores it, relative to `origin`. Of one
 * that moves the splits see the ball around its way. */
BpTreeItem bp_tree_item(const BpScene *scene, uint32_t sphere, const double origin[3]);

/* A capsule, by its number among the shapes, as the splits see it: a cube with the area of its box. */
BpTreeItem bp_tree_capsule_item(const BpScene *scene, uint32_t shape, const double origin[3]);

/* The triangle as the splits see it, relative to `origin`: a cube with the area of its box. */
BpTreeItem bp_tree_triangle_item(const BpScene *scene, uint32_t triangle, const double origin[3]);

/* A box that contains the sphere of an item, the one that was rounded to it as well. */
BpBounds bp_tree_item_bounds(const BpTreeItem *item);

/* Fills leaf `leaf` with 0 <= count <= width spheres and capsules, and returns a box that contains them as
 * the scene has them and as the kernel will see them. */
BpBounds bp_tree_write_leaf(const BpTreeWriter *writer, uint32_t leaf, const BpTreeItem *items,
                            uint32_t count);

/* The same for leaf `leaf` of triangles. */
BpBounds bp_tree_write_triangles(const BpTreeWriter *writer, uint32_t leaf, const BpTreeItem *items,
                                 uint32_t count);

/* Refuses what the kernels cannot number: they find a node's and a leaf's reals by offsets of 32 bits.
 * BP_ERR_LIMIT. */
BpStatus bp_tree_check_size(uint32_t width, uint64_t nodes, uint64_t leaves, BpError *err);

/* Allocates the arrays, with triangles in the leaves from `tree->first_triangles` on, if the kernels can
 * number that many; each has room for one entry at least, so that a device buffer can be made of it. */
BpStatus bp_tree_allocate(BpTree *tree, uint32_t nodes, uint32_t leaves, BpError *err);

/* Gathers the binary tree into wide nodes, allocates the arrays of the tree and writes them, from leaf
 * `tree->leaf_count` on. root NULL: one node whose lanes are all empty. */
BpStatus bp_tree_write_nodes(const BpTreeWriter *writer, const BpBinaryNode *root, BpThreadPool *pool,
                             BpError *err);

#endif
