/* tree_binary.h: the binary tree from which the wide one is gathered.
 *
 * In:    spheres, narrowed to float: good enough to choose splits, never used as bounds.
 * Out:   a binary tree whose leaves hold runs of the reordered spheres, and for every node what it would cost
 *        below a wide node.
 * Knows: the surface area heuristic.   Does not know: scenes, packed data, how boxes are rounded
 * (tree_write.c). */
#ifndef BP_PACKED_TREE_BINARY_H
#define BP_PACKED_TREE_BINARY_H

#include "base/status.h"
#include "base/thread_pool.h"

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#define BP_TREE_WIDTH_MAX 16

typedef struct BpTreeItem {
    float center[3], radius; /* together four lanes; as a packed tree in single precision stores them */
    uint32_t sphere;         /* index in the scene */
} BpTreeItem;

typedef struct BpTreeBox {
    float low[4], high[4]; /* x, y, z; the fourth is not used, and makes vector code of four lanes possible */
} BpTreeBox;

typedef struct BpBinaryNode {
    BpTreeBox box;                     /* about right */
    struct BpBinaryNode *left, *right; /* both NULL: a leaf */
    uint32_t first, count;             /* the run of items below this node */
    uint32_t leaves;                   /* below this node, or 1 */
    uint32_t height;                   /* 0: a leaf */
    /* cost[k]: the least expected number of visits of wide nodes below (times the area of the whole), if this
     * node's place under a wide node may take up to k children, 1 <= k < width. A leaf has none: it costs
     * nothing, and with trees of many millions of spheres nodes are most of the memory. */
    float cost[];
} BpBinaryNode;

/* Nodes in blocks that never move. Zero it before use. */
typedef struct BpNodePool {
    struct BpNodeBlock *blocks;
    uint32_t used, size; /* bytes of the first block */
    bool failed;         /* ran out of memory */
} BpNodePool;

/* A node with room for `costs` costs. NULL and `failed` when there is no memory. */
BpBinaryNode *bp_node_pool_take(BpNodePool *pool, uint32_t costs);
void bp_node_pool_clear(BpNodePool *pool);

typedef struct BpBinaryOptions {
    uint32_t width;      /* items a leaf holds, children a wide node has */
    uint32_t height_max; /* count <= width * 2^height_max must hold */
} BpBinaryOptions;

/* Builds the tree of one run, on the calling thread; reorders the run. NULL: out of memory. */
BpBinaryNode *bp_binary_build_run(BpTreeItem *items, uint32_t first, uint32_t count,
                                  const BpBinaryOptions *options, BpNodePool *pool);

/* Makes an inner node whole once its two children are: box, height, leaves, cost. */
void bp_binary_finish(BpBinaryNode *node, uint32_t width);

/* The number of `places` for the left child that minimises the cost; the right one gets the others. */
uint32_t bp_binary_left_places(const BpBinaryNode *node, uint32_t places);

typedef struct BpBinaryTree {
    BpBinaryNode *root; /* NULL: no items */
    BpNodePool *pools;
    unsigned pool_count;
} BpBinaryTree;

/* Reorders `*items`, or frees it and puts a reordered copy in its place, and builds the tree over them. The
 * result does not depend on the thread pool's size. */
BpStatus bp_binary_tree_build(BpTreeItem **items, uint32_t count, const BpBinaryOptions *options,
                              BpThreadPool *thread_pool, BpBinaryTree *tree, BpError *err);
void bp_binary_tree_clear(BpBinaryTree *tree);

/* log2 of the width of a tree. */
static inline uint32_t bp_tree_width_bits(uint32_t width) {
    uint32_t bits = 0;
    for (; width > 1; width /= 2) ++bits;
    return bits;
}

/* The cost of a run of `count` items, by the heuristic, when a ray meets it: a leaf costs the same however
 * many of its lanes are used, and so does a wide node above leaves. The width comes as its bits, since
 * divisions would take most of the time. */
static inline float bp_tree_run_cost(uint32_t count, uint32_t width_bits) {
    const uint32_t leaf = (1u << width_bits) - 1, node = (1u << 2 * width_bits) - 1;
    return (float)(((count + leaf) >> width_bits) + ((count + node) >> 2 * width_bits));
}

/* The most items that a child of a node may hold, if the node may be `height_max` > 0 high. */
static inline uint64_t bp_binary_side_max(uint32_t width, uint32_t height_max) {
    return (uint64_t)width << (height_max > 32 ? 32 : height_max - 1);
}

/* ---- boxes ----------------------------------------------------------------------------------------- */

#define BP_TREE_BOX_EMPTY                                                                                    \
    {                                                                                                        \
        {1e30f, 1e30f, 1e30f, 1e30f}, {                                                                      \
            -1e30f, -1e30f, -1e30f, -1e30f                                                                   \
        }                                                                                                    \
    }

#if defined(__SSE__)
/* The build spends half its time here, and compilers do not make vector code of the plain form below. */
static inline void bp_tree_box_widen(BpTreeBox *box, __m128 low, __m128 high) {
    _mm_storeu_ps(box->low, _mm_min_ps(low, _mm_loadu_ps(box->low)));
    _mm_storeu_ps(box->high, _mm_max_ps(high, _mm_loadu_ps(box->high)));
}

static inline void bp_tree_box_add(BpTreeBox *box, const BpTreeBox *other) {
    bp_tree_box_widen(box, _mm_loadu_ps(other->low), _mm_loadu_ps(other->high));
}

/* The fourth lane is radius -+ radius. */
static inline void bp_tree_box_add_item(BpTreeBox *box, const BpTreeItem *item) {
    const __m128 c = _mm_loadu_ps(&item->center[0]), r = _mm_set1_ps(item->radius);
    bp_tree_box_widen(box, _mm_sub_ps(c, r), _mm_add_ps(c, r));
}
#else
static inline void bp_tree_box_add(BpTreeBox *box, const BpTreeBox *other) {
    for (int a = 0; a < 4; ++a) {
        box->low[a] = other->low[a] < box->low[a] ? other->low[a] : box->low[a];
        box->high[a] = other->high[a] > box->high[a] ? other->high[a] : box->high[a];
    }
}

static inline void bp_tree_box_add_item(BpTreeBox *box, const BpTreeItem *item) {
    const float r = item->radius;
    const float c[4] = {item->center[0], item->center[1], item->center[2], r};
    for (int a = 0; a < 4; ++a) {
        const float low = c[a] - r, high = c[a] + r;
        box->low[a] = low < box->low[a] ? low : box->low[a];
        box->high[a] = high > box->high[a] ? high : box->high[a];
    }
}
#endif

/* Half the surface area; of an empty box something large. Coordinates are below 1e13, so nothing overflows.
 */
static inline float bp_tree_box_half_area(const BpTreeBox *box) {
    const float x = box->high[0] - box->low[0], y = box->high[1] - box->low[1],
                z = box->high[2] - box->low[2];
    return x * y + y * z + z * x;
}

#endif
