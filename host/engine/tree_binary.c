/* tree_binary.c: see tree_binary.h.
 *
 * Top down, binned surface area heuristic (Wald, "On fast construction of SAH-based bounding volume
 * hierarchies", 2007). The cost of a side is its area times the leaves that it fills, ceil(n / leaf_max),
 * because a leaf costs the same however many of its lanes are used. */
#include "tree_binary.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BINS 16

typedef struct Box {
    float low[3], high[3];
} Box;

typedef struct Builder {
    BpTreeItem *items;
    BpBinaryTree *tree;
    uint32_t leaf_max;
} Builder;

static const Box empty_box = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};

static void box_add_item(Box *box, const BpTreeItem *item) {
    for (int a = 0; a < 3; ++a) {
        const float low = item->center[a] - item->radius, high = item->center[a] + item->radius;
        if (low < box->low[a]) box->low[a] = low;
        if (high > box->high[a]) box->high[a] = high;
    }
}

static void box_add_box(Box *box, const Box *other) {
    for (int a = 0; a < 3; ++a) {
        if (other->low[a] < box->low[a]) box->low[a] = other->low[a];
        if (other->high[a] > box->high[a]) box->high[a] = other->high[a];
    }
}

/* Half the surface area. In double: the squares of large scenes leave float. */
static double box_half_area(const Box *box) {
    const double x = (double)box->high[0] - (double)box->low[0];
    const double y = (double)box->high[1] - (double)box->low[1];
    const double z = (double)box->high[2] - (double)box->low[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
}

static double leaves_of(const Builder *builder, uint32_t count) {
    return (double)((count + builder->leaf_max - 1) / builder->leaf_max);
}

static int bin_of(float center, float low, float scale) {
    const int bin = (int)((center - low) * scale);
    return bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin;
}

/* Finds the cheapest of the splits between bins, on the axis where the centres spread most. Returns the
 * number of items on the left, having moved them there, or 0 when no split between bins separates the items.
 */
static uint32_t split_by_bins(const Builder *builder, uint32_t first, uint32_t count) {
    BpTreeItem *items = builder->items + first;
    float low[3], high[3];
    for (int a = 0; a < 3; ++a) low[a] = high[a] = items[0].center[a];
    for (uint32_t i = 1; i < count; ++i)
        for (int a = 0; a < 3; ++a) {
            if (items[i].center[a] < low[a]) low[a] = items[i].center[a];
            if (items[i].center[a] > high[a]) high[a] = items[i].center[a];
        }
    double best_cost = INFINITY;
    int best_axis = -1, best_bin = 0;
    float best_scale = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float extent = high[axis] - low[axis];
        const float scale = (float)BINS / extent;
        if (!(extent > 0) || !(scale < FLT_MAX)) continue;
        Box boxes[BINS];
        uint32_t counts[BINS] = {0};
        for (int b = 0; b < BINS; ++b) boxes[b] = empty_box;
        for (uint32_t i = 0; i < count; ++i) {
            const int b = bin_of(items[i].center[axis], low[axis], scale);
            ++counts[b];
            box_add_item(&boxes[b], &items[i]);
        }
        double cost_right[BINS];
        Box box = empty_box;
        uint32_t n = 0;
        for (int b = BINS - 1; b > 0; --b) {
            box_add_box(&box, &boxes[b]);
            n += counts[b];
            cost_right[b] = box_half_area(&box) * leaves_of(builder, n);
        }
        box = empty_box;
        n = 0;
        for (int b = 1; b < BINS; ++b) {
            box_add_box(&box, &boxes[b - 1]);
            n += counts[b - 1];
            const double cost = box_half_area(&box) * leaves_of(builder, n) + cost_right[b];
            if (n > 0 && n < count && cost < best_cost) {
                best_cost = cost;
                best_axis = axis;
                best_bin = b;
                best_scale = scale;
            }
        }
    }
    if (best_axis < 0) return 0;
    uint32_t left = 0;
    for (uint32_t i = 0; i < count; ++i)
        if (bin_of(items[i].center[best_axis], low[best_axis], best_scale) < best_bin) {
            const BpTreeItem item = items[i];
            items[i] = items[left];
            items[left++] = item;
        }
    return left;
}

static uint32_t build(const Builder *builder, uint32_t first, uint32_t count, uint32_t height_max) {
    BpBinaryTree *tree = builder->tree;
    const uint32_t number = tree->node_count++;
    BpBinaryNode *node = &tree->nodes[number];
    *node = (BpBinaryNode){.first = first, .count = count};
    if (count <= builder->leaf_max) {
        Box box = empty_box;
        for (uint32_t i = first; i < first + count; ++i) box_add_item(&box, &builder->items[i]);
        memcpy(node->low, box.low, sizeof node->low);
        memcpy(node->high, box.high, sizeof node->high);
        ++tree->leaf_count;
        return number;
    }
    const uint64_t side_max = (uint64_t)builder->leaf_max << (height_max > 32 ? 32 : height_max - 1);
    uint32_t left = split_by_bins(builder, first, count);
    /* Equal centres, or no height left for a lopsided split: halves, whatever lies in them. */
    if (left == 0 || left > side_max || count - left > side_max) left = count / 2;
    node->left = build(builder, first, left, height_max - 1);
    node->right = build(builder, first + left, count - left, height_max - 1);
    const BpBinaryNode *l = &tree->nodes[node->left], *r = &tree->nodes[node->right];
    for (int a = 0; a < 3; ++a) {
        node->low[a] = l->low[a] < r->low[a] ? l->low[a] : r->low[a];
        node->high[a] = l->high[a] > r->high[a] ? l->high[a] : r->high[a];
    }
    node->height = 1 + (l->height > r->height ? l->height : r->height);
    return number;
}

BpStatus bp_binary_tree_build(BpTreeItem *items, uint32_t count, uint32_t leaf_max, uint32_t height_max,
                              BpBinaryTree *tree, BpError *err) {
    *tree = (BpBinaryTree){0};
    if (count == 0) return BP_OK;
    tree->nodes = malloc(2 * (size_t)count * sizeof *tree->nodes);
    if (tree->nodes == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory while building the tree of %u spheres", count);
    const Builder builder = {items, tree, leaf_max};
    build(&builder, 0, count, height_max);
    return BP_OK;
}

void bp_binary_tree_clear(BpBinaryTree *tree) {
    free(tree->nodes);
    *tree = (BpBinaryTree){0};
}
