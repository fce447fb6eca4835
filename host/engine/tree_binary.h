/* tree_binary.h: the binary tree from which the wide one is made.
 *
 * In:    spheres, narrowed to float: good enough to choose splits, never used as bounds.
 * Out:   a binary tree whose leaves hold runs of the reordered spheres.
 * Knows: the surface area heuristic.   Does not know: the packed layout, the scene. */
#ifndef BP_ENGINE_TREE_BINARY_H
#define BP_ENGINE_TREE_BINARY_H

#include "../base/status.h"

typedef struct BpTreeItem {
    float center[3], radius;
    uint32_t sphere; /* index in the scene */
} BpTreeItem;

typedef struct BpBinaryNode {
    float low[3], high[3]; /* about right */
    uint32_t first, count; /* the run of items below this node */
    uint32_t left, right;  /* node numbers; both 0: a leaf */
    uint32_t height;       /* 0: a leaf */
} BpBinaryNode;

typedef struct BpBinaryTree {
    BpBinaryNode *nodes; /* node 0 is the root; none if there are no items */
    uint32_t node_count, leaf_count;
} BpBinaryTree;

/* Reorders `items` and builds a tree over them with at most `leaf_max` items a leaf and a height of at most
 * `height_max`, where count <= leaf_max * 2^height_max must hold. Free with bp_binary_tree_clear(). */
BpStatus bp_binary_tree_build(BpTreeItem *items, uint32_t count, uint32_t leaf_max, uint32_t height_max,
                              BpBinaryTree *tree, BpError *err);
void bp_binary_tree_clear(BpBinaryTree *tree);

#endif
