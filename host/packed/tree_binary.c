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

#include "base/pages.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#define BINS 32
#define POOL_BLOCK (1u << 20) /* bytes; each block is twice as large as the one before, up to the most */
#define POOL_BLOCK_MOST (1u << 24)

typedef struct BpNodeBlock {
    struct BpNodeBlock *next;
    void *nodes[]; /* their memory, aligned for their pointers */
} BpNodeBlock;

BpBinaryNode *bp_node_pool_take(BpNodePool *pool, uint32_t costs) {
    const size_t align = sizeof(void *), wanted = sizeof(BpBinaryNode) + costs * sizeof(float);
    const uint32_t bytes = (uint32_t)((wanted + align - 1) / align * align);
    if (pool->blocks == NULL || pool->used + bytes > pool->size) {
        const uint32_t size = pool->size == 0                ? POOL_BLOCK
                              : pool->size < POOL_BLOCK_MOST ? 2 * pool->size
                                                             : POOL_BLOCK_MOST;
        BpNodeBlock *block = bp_large_pages(malloc(sizeof *block + size), sizeof *block + size);
        if (block == NULL) {
            pool->failed = true;
            return NULL;
        }
        block->next = pool->blocks;
        pool->blocks = block;
        pool->used = 0;
        pool->size = size;
    }
    void *const node = (char *)pool->blocks->nodes + pool->used;
    pool->used += bytes;
    return node;
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

static const float *costs_of(const BpBinaryNode *node) {
    static const float nothing[BP_TREE_WIDTH_MAX];
    return node->left == NULL ? nothing : node->cost;
}

uint32_t bp_binary_left_places(const BpBinaryNode *node, uint32_t places) {
    const float *const left = costs_of(node->left), *const right = costs_of(node->right);
    uint32_t best = 1;
    for (uint32_t k = 2; k < places; ++k)
        if (left[k] + right[places - k] < left[best] + right[places - best]) best = k;
    return best;
}

static float cost_of_places(const BpBinaryNode *node, uint32_t places) {
    const uint32_t k = bp_binary_left_places(node, places);
    return costs_of(node->left)[k] + costs_of(node->right)[places - k];
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

/* What find_split does for each item of a run, which is where the build spends most of its time: the bounds
 * of the centers, and the bins of the three axes with their boxes. Compilers do not make vector code of the
 * plain forms; both do the same arithmetic. */
typedef struct Bins {
    BpTreeBox boxes[3][BINS]; /* of those whose count is not 0 */
    uint32_t counts[3][BINS];
} Bins;

static const BpTreeBox empty_box = BP_TREE_BOX_EMPTY;

#if defined(__SSE2__)
static void bound_centers(const BpTreeItem *items, uint32_t count, float low[4], float high[4]) {
    __m128 l = _mm_loadu_ps(items[0].center), h = l;
    for (uint32_t i = 1; i < count; ++i) {
        const __m128 c = _mm_loadu_ps(items[i].center);
        l = _mm_min_ps(c, l);
        h = _mm_max_ps(c, h);
    }
    _mm_storeu_ps(low, l);
    _mm_storeu_ps(high, h);
}

static void fill_bins(const BpTreeItem *items, uint32_t count, const float low[4], const float scale[4],
                      Bins *bins) {
    const __m128 l = _mm_loadu_ps(low), s = _mm_loadu_ps(scale);
    for (uint32_t i = 0; i < count; ++i) {
        const __m128 c = _mm_loadu_ps(items[i].center), r = _mm_set1_ps(items[i].radius);
        const __m128 from = _mm_sub_ps(c, r), to = _mm_add_ps(c, r);
        int32_t b[4];
        /* As 16-bit numbers, of which every other is 0: bins are few. */
        _mm_storeu_si128((__m128i *)b, _mm_min_epi16(_mm_cvttps_epi32(_mm_mul_ps(_mm_sub_ps(c, l), s)),
                                                     _mm_set1_epi32(BINS - 1)));
        for (int a = 0; a < 3; ++a) {
            if (bins->counts[a][b[a]]++ == 0) bins->boxes[a][b[a]] = empty_box;
            bp_tree_box_widen(&bins->boxes[a][b[a]], from, to);
        }
    }
}
#else
static void bound_centers(const BpTreeItem *items, uint32_t count, float low[4], float high[4]) {
    memcpy(low, &items[0], 4 * sizeof *low);
    memcpy(high, &items[0], 4 * sizeof *high);
    for (uint32_t i = 1; i < count; ++i)
        for (int a = 0; a < 3; ++a) {
            low[a] = items[i].center[a] < low[a] ? items[i].center[a] : low[a];
            high[a] = items[i].center[a] > high[a] ? items[i].center[a] : high[a];
        }
}

static void fill_bins(const BpTreeItem *items, uint32_t count, const float low[4], const float scale[4],
                      Bins *bins) {
    for (uint32_t i = 0; i < count; ++i)
        for (int a = 0; a < 3; ++a) {
            const int b = bin_of(items[i].center[a], low[a], scale[a]);
            if (bins->counts[a][b]++ == 0) bins->boxes[a][b] = empty_box;
            bp_tree_box_add_item(&bins->boxes[a][b], &items[i]);
        }
}
#endif

/* The cheapest of the splits between bins, over the three axes. Most runs are small and leave most bins
 * empty, so only those in use are looked at: a split beside an empty bin costs what that before it did. */
static Split find_split(const BpTreeItem *items, uint32_t count, uint32_t width) {
    float low[4], high[4], scale[4] = {0}; /* of the fourth lane, the radius: one bin, not used */
    bound_centers(items, count, low, high);
    for (int a = 0; a < 3; ++a) {
        scale[a] = (float)BINS / (high[a] - low[a]);
        if (!(scale[a] < FLT_MAX)) scale[a] = 0; /* all in one bin */
    }
    const uint32_t width_bits = bp_tree_width_bits(width);
    Bins bins;
    memset(bins.counts, 0, sizeof bins.counts);
    fill_bins(items, count, low, scale, &bins);
    Split best = {.axis = -1};
    float best_cost = INFINITY;
    for (int a = 0; a < 3; ++a) {
        if (!(scale[a] > 0)) continue;
        int used[BINS], used_count = 0;
        for (int b = 0; b < BINS; ++b) {
            used[used_count] = b;
            used_count += bins.counts[a][b] > 0;
        }
        float cost_right[BINS];
        BpTreeBox box = empty_box;
        uint32_t n = 0;
        for (int u = used_count - 1; u > 0; --u) {
            bp_tree_box_add(&box, &bins.boxes[a][used[u]]);
            n += bins.counts[a][used[u]];
            cost_right[u] = bp_tree_box_half_area(&box) * bp_tree_run_cost(n, width_bits);
        }
        box = empty_box;
        n = 0;
        for (int u = 1; u < used_count; ++u) {
            const int b = used[u - 1];
            bp_tree_box_add(&box, &bins.boxes[a][b]);
            n += bins.counts[a][b];
            const float cost = bp_tree_box_half_area(&box) * bp_tree_run_cost(n, width_bits) + cost_right[u];
            if (cost < best_cost) {
                best_cost = cost;
                best = (Split){a, b + 1, low[a], scale[a]};
            }
        }
    }
    return best;
}

/* Moves the items left of the split to the front and returns their number. Which side an item belongs to
 * cannot be foreseen, so there is no branch on it. */
static uint32_t partition(BpTreeItem *items, uint32_t count, const Split *split) {
    uint32_t left = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const BpTreeItem item = items[i];
        items[i] = items[left];
        items[left] = item;
        left += bin_of(item.center[split->axis], split->low, split->scale) < split->bin;
    }
    return left;
}

static BpBinaryNode *build(BpTreeItem *items, uint32_t first, uint32_t count, uint32_t width,
                           uint32_t height_max, BpNodePool *pool) {
    BpBinaryNode *node = bp_node_pool_take(pool, count <= width ? 0 : width);
    if (node == NULL) return NULL;
    node->first = first;
    node->count = count;
    if (count <= width) {
        node->box = (BpTreeBox)BP_TREE_BOX_EMPTY;
        node->left = node->right = NULL;
        node->leaves = 1;
        node->height = 0;
        for (uint32_t i = first; i < first + count; ++i) bp_tree_box_add_item(&node->box, &items[i]);
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
