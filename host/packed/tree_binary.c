/* tree_binary.c: see tree_binary.h. One run of spheres on one thread; tree_top.c cuts large scenes into runs.
 *
 * Top down, binned surface area heuristic (Wald, "On fast construction of SAH-based bounding volume
 * hierarchies", 2007). The cost of a side is its area times the leaves that it fills, ceil(n / width),
 * because a leaf costs the same however many of its lanes are used.
 *
 * The least cost of every node below a wide one, by the number of children it may take there, is found by
 * dynamic programming from the leaves up (Ylitie, Karras and Laine, "Efficient incoherent ray traversal on
 * GPUs through compressed wide BVHs", 2017, section 4.1). */
#include "tree_binary.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BINS 32
#define POOL_BLOCK 1024u

typedef struct BpNodeBlock {
    struct BpNodeBlock *next;
    BpBinaryNode nodes[POOL_BLOCK];
} BpNodeBlock;

BpBinaryNode *bp_node_pool_take(BpNodePool *pool) {
    if (pool->blocks == NULL || pool->used == POOL_BLOCK) {
        BpNodeBlock *block = malloc(sizeof *block);
        if (block == NULL) {
            pool->failed = true;
            return NULL;
        }
        block->next = pool->blocks;
        pool->blocks = block;
        pool->used = 0;
    }
    return &pool->blocks->nodes[pool->used++];
}

void bp_node_pool_clear(BpNodePool *pool) {
    while (pool->blocks != NULL) {
        BpNodeBlock *next = pool->blocks->next;
        free(pool->blocks);
        pool->blocks = next;
    }
    *pool = (BpNodePool){0};
}

/* ---- costs of wide nodes --------------------------------------------------------------------------- */

uint32_t bp_binary_left_places(const BpBinaryNode *node, uint32_t places) {
    uint32_t best = 1;
    for (uint32_t k = 2; k < places; ++k)
        if (node->left->cost[k] + node->right->cost[places - k] <
            node->left->cost[best] + node->right->cost[places - best])
            best = k;
    return best;
}

static float cost_of_places(const BpBinaryNode *node, uint32_t places) {
    const uint32_t k = bp_binary_left_places(node, places);
    return node->left->cost[k] + node->right->cost[places - k];
}

void bp_binary_finish(BpBinaryNode *node, uint32_t width) {
    const BpBinaryNode *l = node->left, *r = node->right;
    node->box = l->box;
    bp_tree_box_add(&node->box, &r->box);
    node->leaves = l->leaves + r->leaves;
    node->height = 1 + (l->height > r->height ? l->height : r->height);
    node->cost[0] = INFINITY;
    /* One place: a wide node of its own. */
    node->cost[1] = bp_tree_box_half_area(&node->box) + cost_of_places(node, width);
    for (uint32_t k = 2; k < width; ++k) {
        const float cost = cost_of_places(node, k);
        node->cost[k] = cost < node->cost[k - 1] ? cost : node->cost[k - 1];
    }
}

/* ---- splitting ------------------------------------------------------------------------------------- */

typedef struct Split {
    int axis; /* < 0: none */
    int bin;  /* the first on the right */
    float low, scale;
} Split;

static int bin_of(float center, float low, float scale) {
    const int bin = (int)((center - low) * scale);
    return bin >= BINS ? BINS - 1 : bin;
}

/* The cheapest of the splits between bins, over the three axes. */
static Split find_split(const BpTreeItem *items, uint32_t count, uint32_t width) {
    float low[4], high[4], scale[3];
    memcpy(low, &items[0], sizeof low);
    memcpy(high, &items[0], sizeof high);
    for (uint32_t i = 1; i < count; ++i)
        for (int a = 0; a < 3; ++a) {
            low[a] = items[i].center[a] < low[a] ? items[i].center[a] : low[a];
            high[a] = items[i].center[a] > high[a] ? items[i].center[a] : high[a];
        }
    for (int a = 0; a < 3; ++a) {
        scale[a] = (float)BINS / (high[a] - low[a]);
        if (!(scale[a] < FLT_MAX)) scale[a] = 0; /* all in one bin */
    }
    static const BpTreeBox empty = BP_TREE_BOX_EMPTY;
    BpTreeBox boxes[3][BINS];
    uint32_t counts[3][BINS] = {{0}};
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < BINS; ++b) boxes[a][b] = empty;
    for (uint32_t i = 0; i < count; ++i)
        for (int a = 0; a < 3; ++a) {
            const int b = bin_of(items[i].center[a], low[a], scale[a]);
            ++counts[a][b];
            bp_tree_box_add_item(&boxes[a][b], &items[i]);
        }
    Split best = {.axis = -1};
    float best_cost = INFINITY;
    for (int a = 0; a < 3; ++a) {
        if (!(scale[a] > 0)) continue;
        float cost_right[BINS];
        BpTreeBox box = empty;
        uint32_t n = 0;
        for (int b = BINS - 1; b > 0; --b) {
            bp_tree_box_add(&box, &boxes[a][b]);
            n += counts[a][b];
            cost_right[b] = bp_tree_box_half_area(&box) * bp_tree_run_cost(n, width);
        }
        box = empty;
        n = 0;
        for (int b = 1; b < BINS; ++b) {
            bp_tree_box_add(&box, &boxes[a][b - 1]);
            n += counts[a][b - 1];
            const float cost = bp_tree_box_half_area(&box) * bp_tree_run_cost(n, width) + cost_right[b];
            if (n > 0 && n < count && cost < best_cost) {
                best_cost = cost;
                best = (Split){a, b, low[a], scale[a]};
            }
        }
    }
    return best;
}

/* Moves the items left of the split to the front and returns their number. */
static uint32_t partition(BpTreeItem *items, uint32_t count, const Split *split) {
    uint32_t left = 0, right = count;
    for (;;) {
        while (left < right && bin_of(items[left].center[split->axis], split->low, split->scale) < split->bin)
            ++left;
        while (left < right &&
               bin_of(items[right - 1].center[split->axis], split->low, split->scale) >= split->bin)
            --right;
        if (left >= right) return left;
        const BpTreeItem item = items[left];
        items[left++] = items[--right];
        items[right] = item;
    }
}

static BpBinaryNode *build(BpTreeItem *items, uint32_t first, uint32_t count, uint32_t width,
                           uint32_t height_max, BpNodePool *pool) {
    BpBinaryNode *node = bp_node_pool_take(pool);
    if (node == NULL) return NULL;
    node->first = first;
    node->count = count;
    if (count <= width) {
        node->box = (BpTreeBox)BP_TREE_BOX_EMPTY;
        node->left = node->right = NULL;
        node->leaves = 1;
        node->height = 0;
        for (uint32_t i = first; i < first + count; ++i) bp_tree_box_add_item(&node->box, &items[i]);
        for (int k = 0; k < BP_TREE_WIDTH_MAX; ++k) node->cost[k] = 0;
        return node;
    }
    const uint64_t side_max = bp_binary_side_max(width, height_max);
    const Split split = find_split(items + first, count, width);
    uint32_t left = split.axis < 0 ? 0 : partition(items + first, count, &split);
    /* Equal centers, or no height left for a lopsided split: about halves, whatever lies in them, with full
     * leaves on the left. */
    if (left == 0 || left == count || left > side_max || count - left > side_max)
        left = (count + 2 * width - 1) / (2 * width) * width;
    node->left = build(items, first, left, width, height_max - 1, pool);
    if (node->left == NULL) return NULL;
    node->right = build(items, first + left, count - left, width, height_max - 1, pool);
    if (node->right == NULL) return NULL;
    bp_binary_finish(node, width);
    return node;
}

BpBinaryNode *bp_binary_build_run(BpTreeItem *items, uint32_t first, uint32_t count,
                                  const BpBinaryOptions *options, BpNodePool *pool) {
    return build(items, first, count, options->width, options->height_max, pool);
}
