/* tree.c: see tree.h.
 *
 * Three steps: the huge spheres are set apart, a binary tree over the others is built (tree_binary.c), and it
 * is gathered into nodes of `width` children. Boxes are computed afterwards, upwards, from the spheres in
 * double. */
#include "tree.h"

#define BP_HOST
#include "../base/status.h"
#include "reals.h"
#include "scene_types.h"
#include "tree_binary.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* A sphere whose box has more than this part of the area of the box around all others is met by so many rays,
 * and makes every box above it so large, that it is cheaper to test it always. */
#define HUGE_AREA_PART (1.0 / 64.0)
/* A child box that no ray meets; finite, so that (low - origin) * (1 / direction) is never NaN. */
#define EMPTY_LANE 1.0e30
#define WIDTH_MAX 8

typedef struct Bounds {
    double low[3], high[3];
} Bounds;

typedef struct Writer {
    const BpScene *scene;
    const double *origin;
    const BpTreeItem *items;
    const BpBinaryTree *binary;
    BpTree *tree;
    uint32_t height_bits; /* log2 of the width */
} Writer;

static const Bounds empty_bounds = {{EMPTY_LANE, EMPTY_LANE, EMPTY_LANE},
                                    {-EMPTY_LANE, -EMPTY_LANE, -EMPTY_LANE}};

static double now_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void bounds_add(Bounds *bounds, const Bounds *other) {
    for (int a = 0; a < 3; ++a) {
        if (other->low[a] < bounds->low[a]) bounds->low[a] = other->low[a];
        if (other->high[a] > bounds->high[a]) bounds->high[a] = other->high[a];
    }
}

/* Half the surface area. */
static double bounds_half_area(const Bounds *bounds) {
    const double x = bounds->high[0] - bounds->low[0], y = bounds->high[1] - bounds->low[1],
                 z = bounds->high[2] - bounds->low[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
}

/* The radius as the kernel will see it. What is too small for float becomes the smallest normal number, so
 * that a lane in use always has a radius above 0. */
static double stored_radius(double radius, bool single) {
    const double r = fabs(radius);
    if (!single) return r;
    return r < FLT_MIN ? FLT_MIN : (double)(float)r;
}

/* The box that contains the sphere as the scene has it and as the kernel sees it, rounded centre, rounded
 * radius. Widened by a bound of the rounding of these very sums: three roundings of numbers up to |center| +
 * radius, each at most 2^-53 of it. */
static Bounds sphere_bounds(const BpSphere *sphere, const double origin[3], bool single) {
    const double r = fabs(sphere->radius), r_stored = stored_radius(r, single);
    const double r_max = r > r_stored ? r : r_stored;
    Bounds bounds;
    for (int a = 0; a < 3; ++a) {
        const double c = sphere->center[a] - origin[a];
        const double c_stored = single ? (double)(float)c : c;
        const double margin = (fabs(c) + r_max) * 0x1p-51;
        bounds.low[a] = (c < c_stored ? c : c_stored) - r_max - margin;
        bounds.high[a] = (c > c_stored ? c : c_stored) + r_max + margin;
    }
    return bounds;
}

/* ---- huge spheres ------------------------------------------------------------------------------------ */

static bool larger(const BpScene *scene, uint32_t a, uint32_t b) {
    const double ra = fabs(scene->spheres[a].radius), rb = fabs(scene->spheres[b].radius);
    return ra > rb || (ra == rb && a < b);
}

/* Writes the spheres that are to be tested before the tree to `huge`, the largest first; returns how many,
 * at most `width`. They are the longest prefix of the spheres by size of which each is huge against the box
 * around all spheres that are not among the `width` largest. */
static uint32_t find_huge(const BpScene *scene, const double origin[3], uint32_t width,
                          uint32_t huge[WIDTH_MAX]) {
    const uint32_t count = (uint32_t)scene->sphere_count;
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (found == width && !larger(scene, i, huge[width - 1])) continue;
        uint32_t place = found < width ? found++ : width - 1;
        for (; place > 0 && larger(scene, i, huge[place - 1]); --place) huge[place] = huge[place - 1];
        huge[place] = i;
    }
    Bounds rest = empty_bounds;
    for (uint32_t i = 0; i < count; ++i) {
        bool among = false;
        for (uint32_t k = 0; k < found; ++k) among = among || huge[k] == i;
        if (among) continue;
        const Bounds bounds = sphere_bounds(&scene->spheres[i], origin, false);
        bounds_add(&rest, &bounds);
    }
    const double rest_area = bounds_half_area(&rest);
    uint32_t keep = 0;
    while (keep < found) {
        const double r = scene->spheres[huge[keep]].radius;
        if (!(12.0 * r * r > HUGE_AREA_PART * rest_area)) break;
        ++keep;
    }
    return keep;
}

/* ---- writing the packed arrays ------------------------------------------------------------------------- */

/* Fills a leaf, its unused lanes too, and returns its box. */
static Bounds write_leaf(const Writer *writer, uint32_t leaf, const uint32_t *spheres, uint32_t count) {
    BpTree *tree = writer->tree;
    const uint32_t width = tree->width;
    const bool single = tree->single_precision;
    const size_t base = (size_t)leaf * LEAF_REALS(width);
    Bounds box = empty_bounds;
    for (uint32_t lane = 0; lane < width; ++lane) {
        uint32_t index = NO_SPHERE;
        double center[3] = {0, 0, 0}, radius = -1;
        if (lane < count) {
            index = spheres[lane];
            const BpSphere *sphere = &writer->scene->spheres[index];
            const Bounds bounds = sphere_bounds(sphere, writer->origin, single);
            bounds_add(&box, &bounds);
            for (int a = 0; a < 3; ++a) center[a] = sphere->center[a] - writer->origin[a];
            radius = stored_radius(sphere->radius, single);
        }
        for (uint32_t a = 0; a < 3; ++a)
            bp_reals_store(tree->leaves, single, base + a * width + lane, center[a]);
        bp_reals_store(tree->leaves, single, base + 3 * width + lane, radius);
        tree->slot_sphere[(size_t)leaf * width + lane] = index;
    }
    return box;
}

static void write_child(BpTree *tree, uint32_t node, uint32_t lane, const Bounds *box, uint32_t word) {
    const size_t base = (size_t)node * NODE_REALS(tree->width) + lane;
    for (uint32_t a = 0; a < 3; ++a) {
        bp_reals_store_down(tree->node_boxes, tree->single_precision, base + a * tree->width, box->low[a]);
        bp_reals_store_up(tree->node_boxes, tree->single_precision, base + (3 + a) * tree->width,
                          box->high[a]);
    }
    tree->children[(size_t)node * tree->width + lane] = word;
}

static double binary_half_area(const BpBinaryNode *node) {
    const double x = (double)node->high[0] - (double)node->low[0];
    const double y = (double)node->high[1] - (double)node->low[1];
    const double z = (double)node->high[2] - (double)node->low[2];
    return x * y + y * z + z * x;
}

/* Replaces children[place] by its two halves. */
static void open_child(const BpBinaryTree *binary, uint32_t *children, uint32_t *count, uint32_t place) {
    const BpBinaryNode *node = &binary->nodes[children[place]];
    memmove(children + place + 2, children + place + 1, (*count - place - 1) * sizeof *children);
    children[place] = node->left;
    children[place + 1] = node->right;
    ++*count;
}

/* Chooses up to `width` descendants of a binary node as the children of a wide one: the inner node with the
 * largest area is opened until there are enough. If that left one higher than `height_max`, all are opened
 * level by level instead, which takes log2(width) off every height. */
static uint32_t gather_children(const Writer *writer, uint32_t number, uint32_t height_max,
                                uint32_t *children) {
    const BpBinaryTree *binary = writer->binary;
    const uint32_t width = writer->tree->width;
    uint32_t count = 1;
    children[0] = number;
    while (count < width) {
        uint32_t best = width;
        double best_area = -1;
        for (uint32_t i = 0; i < count; ++i) {
            const BpBinaryNode *node = &binary->nodes[children[i]];
            const double area = binary_half_area(node);
            if (node->height > 0 && area > best_area) {
                best_area = area;
                best = i;
            }
        }
        if (best == width) break;
        open_child(binary, children, &count, best);
    }
    bool fits = true;
    for (uint32_t i = 0; i < count; ++i) fits = fits && binary->nodes[children[i]].height <= height_max;
    if (fits) return count;
    count = 1;
    children[0] = number;
    for (uint32_t level = 0; level < writer->height_bits; ++level)
        for (uint32_t i = 0; i < count; ++i)
            if (binary->nodes[children[i]].height > 0) open_child(binary, children, &count, i++);
    return count;
}

/* Writes the wide node of a binary one and everything below; returns its box. `depth` counts from 1. */
static Bounds write_node(const Writer *writer, uint32_t number, uint32_t depth) {
    BpTree *tree = writer->tree;
    const uint32_t node = tree->node_count++;
    if (depth > tree->depth) tree->depth = depth;
    uint32_t children[WIDTH_MAX];
    const uint32_t count =
        gather_children(writer, number, (TREE_DEPTH_MAX - depth) * writer->height_bits, children);
    Bounds box = empty_bounds;
    for (uint32_t lane = 0; lane < tree->width; ++lane) {
        Bounds child_box = empty_bounds;
        uint32_t word = CHILD_LEAF;
        if (lane < count) {
            const BpBinaryNode *child = &writer->binary->nodes[children[lane]];
            if (child->height == 0) {
                const uint32_t leaf = tree->leaf_count++;
                word = CHILD_LEAF | leaf;
                uint32_t spheres[WIDTH_MAX];
                for (uint32_t i = 0; i < child->count; ++i)
                    spheres[i] = writer->items[child->first + i].sphere;
                child_box = write_leaf(writer, leaf, spheres, child->count);
            } else {
                word = tree->node_count; /* the number that the next call takes */
                child_box = write_node(writer, children[lane], depth + 1);
            }
            bounds_add(&box, &child_box);
        }
        write_child(tree, node, lane, &child_box, word);
    }
    return box;
}

/* ---- the whole -------------------------------------------------------------------------------------------
 */

/* Allocates the arrays; each has room for one entry at least, so that a device buffer can be made of it. */
static BpStatus allocate(BpTree *tree, uint32_t nodes, uint32_t leaves, BpError *err) {
    const size_t real_size = tree->single_precision ? sizeof(float) : sizeof(double);
    const size_t n = nodes > 0 ? nodes : 1, l = leaves > 0 ? leaves : 1, width = tree->width;
    tree->node_boxes = calloc(n * NODE_REALS(width), real_size);
    tree->children = calloc(n * width, sizeof *tree->children);
    tree->leaves = calloc(l * LEAF_REALS(width), real_size);
    tree->slot_sphere = calloc(l * width, sizeof *tree->slot_sphere);
    if (tree->node_boxes != NULL && tree->children != NULL && tree->leaves != NULL &&
        tree->slot_sphere != NULL)
        return BP_OK;
    return bp_fail(err, BP_ERR_MEMORY, "out of memory for a tree of %u leaves and %u nodes", leaves, nodes);
}

static BpStatus build_list(const Writer *writer, BpError *err) {
    BpTree *tree = writer->tree;
    const uint32_t count = (uint32_t)writer->scene->sphere_count, width = tree->width;
    tree->first_leaves = tree->leaf_count = (count + width - 1) / width;
    BP_TRY(allocate(tree, 0, tree->leaf_count, err));
    for (uint32_t leaf = 0; leaf < tree->leaf_count; ++leaf) {
        uint32_t spheres[WIDTH_MAX], n = 0;
        for (; n < width && leaf * width + n < count; ++n) spheres[n] = leaf * width + n;
        write_leaf(writer, leaf, spheres, n);
    }
    return BP_OK;
}

/* Narrows all spheres but the huge ones. */
static BpTreeItem *make_items(const BpScene *scene, const double origin[3], const uint32_t *huge,
                              uint32_t huge_count) {
    const uint32_t count = (uint32_t)scene->sphere_count;
    BpTreeItem *items = malloc(((size_t)count + 1) * sizeof *items);
    if (items == NULL) return NULL;
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; ++i) {
        bool set_apart = false;
        for (uint32_t k = 0; k < huge_count; ++k) set_apart = set_apart || huge[k] == i;
        if (set_apart) continue;
        const BpSphere *sphere = &scene->spheres[i];
        for (int a = 0; a < 3; ++a) items[n].center[a] = (float)(sphere->center[a] - origin[a]);
        items[n].radius = (float)fabs(sphere->radius);
        items[n++].sphere = i;
    }
    return items;
}

static BpStatus build_tree(Writer *writer, BpError *err) {
    BpTree *tree = writer->tree;
    uint32_t huge[WIDTH_MAX];
    BpStatus status = BP_OK;
    BpBinaryTree binary = {0};
    const uint32_t huge_count = find_huge(writer->scene, writer->origin, tree->width, huge);
    const uint32_t count = (uint32_t)writer->scene->sphere_count - huge_count;
    const uint32_t height_max = TREE_DEPTH_MAX * writer->height_bits;
    BpTreeItem *items = make_items(writer->scene, writer->origin, huge, huge_count);
    if (items == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory while building the tree of %u spheres", count);
        goto cleanup;
    }
    BP_TRY_GOTO(status, bp_binary_tree_build(items, count, tree->width, height_max, &binary, err), cleanup);
    tree->first_leaves = huge_count > 0 ? 1 : 0;
    /* A wide node takes at least width - 1 splits, except where leaves end it early: no tighter bound is
     * known beforehand, and pages never written cost nothing. */
    const uint32_t inner = binary.node_count - binary.leaf_count;
    BP_TRY_GOTO(status, allocate(tree, inner + 1, binary.leaf_count + tree->first_leaves, err), cleanup);
    writer->items = items;
    writer->binary = &binary;
    if (huge_count > 0) write_leaf(writer, tree->leaf_count++, huge, huge_count);
    if (count > 0) {
        write_node(writer, 0, 1);
    } else {
        tree->node_count = tree->depth = 1;
        for (uint32_t lane = 0; lane < tree->width; ++lane)
            write_child(tree, 0, lane, &empty_bounds, CHILD_LEAF);
    }
cleanup:
    bp_binary_tree_clear(&binary);
    free(items);
    return status;
}

BpStatus bp_tree_build(const BpScene *scene, const double origin[3], const BpTreeOptions *options,
                       BpTree *tree, BpError *err) {
    const double start = now_seconds();
    const uint32_t width = options->width;
    *tree = (BpTree){.width = width, .single_precision = options->single_precision};
    if (width != 2 && width != 4 && width != 8)
        return bp_fail(err, BP_ERR_LIMIT, "a tree is 2, 4 or 8 wide, not %u", width);
    Writer writer = {.scene = scene, .origin = origin, .tree = tree};
    for (uint32_t w = width; w > 1; w /= 2) ++writer.height_bits;
    const uint64_t limit = writer.height_bits == 1 ? (uint64_t)width << TREE_DEPTH_MAX : BP_SPHERES_MAX;
    BpStatus status = BP_OK;
    if (scene->sphere_count > limit) {
        status = bp_fail(err, BP_ERR_LIMIT, "%zu spheres; a tree %u wide holds at most %llu",
                         scene->sphere_count, width, (unsigned long long)limit);
        goto cleanup;
    }
    status = options->list ? build_list(&writer, err) : build_tree(&writer, err);
cleanup:
    if (status != BP_OK) bp_tree_clear(tree);
    tree->build_seconds = now_seconds() - start;
    return status;
}

void bp_tree_clear(BpTree *tree) {
    free(tree->node_boxes);
    free(tree->children);
    free(tree->leaves);
    free(tree->slot_sphere);
    *tree = (BpTree){0};
}
