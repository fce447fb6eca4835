/* tree.c: see tree.h.
 *
 * Three steps: the huge spheres are set apart, a binary tree over the others is built (tree_binary.c,
 * tree_top.c), and it is gathered into nodes of `width` children and written (tree_write.c). */
#define BP_HOST
#include "tree.h"

#include "base/clock.h"
#include "base/pages.h"
#include "scene_types.h"
#include "tree_binary.h"
#include "tree_write.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A sphere whose box has more than this part of the area of the box around all others is met by so many rays,
 * and makes every box above it so large, that it is cheaper to test it always. */
#define HUGE_AREA_PART (1.0 / 64.0)

/* The largest spheres, by radius, then index. */
typedef struct Largest {
    uint32_t index[BP_TREE_WIDTH_MAX], count;
} Largest;

/* Both passes over the scene's spheres, block by block. */
typedef struct Scan {
    const BpScene *scene;
    const double *origin;
    uint32_t width;
    Largest *largest;   /* one a block */
    Largest candidates; /* of all */
    BpBounds *bounds;   /* one a block, without the candidates */
    BpTreeItem *items;  /* without the candidates */
    BpTreeItem *capsule_items;
} Scan;

static bool larger(const BpScene *scene, uint32_t a, uint32_t b) {
    const double ra = fabs(scene->spheres[a].radius), rb = fabs(scene->spheres[b].radius);
    return ra > rb || (ra == rb && a < b);
}

static void offer(const BpScene *scene, uint32_t width, Largest *largest, uint32_t sphere) {
    if (largest->count == width && !larger(scene, sphere, largest->index[width - 1])) return;
    uint32_t place = largest->count < width ? largest->count++ : width - 1;
    for (; place > 0 && larger(scene, sphere, largest->index[place - 1]); --place)
        largest->index[place] = largest->index[place - 1];
    largest->index[place] = sphere;
}

static void find_largest(void *context, uint32_t block, unsigned thread) {
    (void)thread;
    Scan *scan = context;
    Largest largest = {.count = 0};
    for (size_t i = bp_block_begin(block); i < bp_block_end(block, scan->scene->sphere_count); ++i)
        offer(scan->scene, scan->width, &largest, (uint32_t)i);
    scan->largest[block] = largest;
}

static void make_items(void *context, uint32_t block, unsigned thread) {
    (void)thread;
    Scan *scan = context;
    /* Candidates before this block leave no gap; those within are passed over. */
    bool skip[BP_BLOCK / 64][64];
    memset(skip, 0, sizeof skip);
    uint32_t place = block * BP_BLOCK;
    for (uint32_t k = 0; k < scan->candidates.count; ++k) {
        const uint32_t index = scan->candidates.index[k];
        if (index < block * BP_BLOCK) --place;
        if (index / BP_BLOCK == block) skip[index % BP_BLOCK / 64][index % 64] = true;
    }
    BpBounds bounds = BP_BOUNDS_EMPTY;
    for (size_t i = bp_block_begin(block); i < bp_block_end(block, scan->scene->sphere_count); ++i) {
        if (skip[i % BP_BLOCK / 64][i % 64]) continue;
        const BpTreeItem item = bp_tree_item(scan->scene, (uint32_t)i, scan->origin);
        const BpBounds box = bp_tree_item_bounds(&item);
        bp_bounds_add(&bounds, &box);
        scan->items[place++] = item;
    }
    scan->bounds[block] = bounds;
}

/* A capsule's number among the shapes. */
static uint32_t capsule_shape(const BpScene *scene, size_t capsule) {
    return (uint32_t)(scene->sphere_count + scene->triangle_count + capsule);
}

static void make_capsule_items(void *context, uint32_t block, unsigned thread) {
    (void)thread;
    Scan *scan = context;
    for (size_t i = bp_block_begin(block); i < bp_block_end(block, scan->scene->capsule_count); ++i)
        scan->capsule_items[i] =
            bp_tree_capsule_item(scan->scene, capsule_shape(scan->scene, i), scan->origin);
}

/* Makes the items of all spheres but the huge ones, which it leaves in `candidates`, the largest first: the
 * longest prefix of the `width` largest spheres of which each is huge against the box around all spheres that
 * are not among the `width` largest; then those of all capsules. Returns the number of items. */
static uint32_t scan_spheres(Scan *scan, BpThreadPool *pool) {
    const uint32_t count = (uint32_t)scan->scene->sphere_count, blocks = bp_block_count(count);
    bp_parallel_for(pool, find_largest, scan, blocks);
    for (uint32_t b = 0; b < blocks; ++b)
        for (uint32_t k = 0; k < scan->largest[b].count; ++k)
            offer(scan->scene, scan->width, &scan->candidates, scan->largest[b].index[k]);
    bp_parallel_for(pool, make_items, scan, blocks);
    BpBounds rest = BP_BOUNDS_EMPTY;
    for (uint32_t b = 0; b < blocks; ++b) bp_bounds_add(&rest, &scan->bounds[b]);
    const double x = rest.high[0] - rest.low[0], y = rest.high[1] - rest.low[1],
                 z = rest.high[2] - rest.low[2];
    const double rest_area = x < 0 ? 0 : 2 * (x * y + y * z + z * x);
    Largest *candidates = &scan->candidates;
    uint32_t huge = 0, items = count - candidates->count;
    for (; huge < candidates->count; ++huge) {
        const double r = scan->scene->spheres[candidates->index[huge]].radius;
        if (!(24 * r * r > HUGE_AREA_PART * rest_area)) break;
    }
    for (uint32_t k = huge; k < candidates->count; ++k)
        scan->items[items++] = bp_tree_item(scan->scene, candidates->index[k], scan->origin);
    candidates->count = huge;
    scan->capsule_items = scan->items + items;
    bp_parallel_for(pool, make_capsule_items, scan, bp_block_count((uint32_t)scan->scene->capsule_count));
    return items + (uint32_t)scan->scene->capsule_count;
}

static BpStatus build_list(const BpTreeWriter *writer, BpError *err) {
    BpTree *tree = writer->tree;
    const BpScene *scene = writer->scene;
    const uint32_t spheres = (uint32_t)scene->sphere_count, width = tree->width;
    const uint32_t count = spheres + (uint32_t)scene->capsule_count,
                   triangles = (uint32_t)scene->triangle_count;
    tree->first_triangles = (count + width - 1) / width;
    tree->first_leaves = tree->leaf_count = tree->first_triangles + (triangles + width - 1) / width;
    BP_TRY(bp_tree_allocate(tree, 0, tree->leaf_count, err));
    for (uint32_t leaf = 0; leaf < tree->leaf_count; ++leaf) {
        const bool flat = leaf >= tree->first_triangles;
        const uint32_t first = (flat ? leaf - tree->first_triangles : leaf) * width,
                       all = flat ? triangles : count;
        BpTreeItem items[BP_TREE_WIDTH_MAX];
        uint32_t n = 0;
        for (; n < width && first + n < all; ++n)
            items[n] =
                flat ? bp_tree_triangle_item(scene, first + n, writer->origin)
                : first + n < spheres
                    ? bp_tree_item(scene, first + n, writer->origin)
                    : bp_tree_capsule_item(scene, capsule_shape(scene, first + n - spheres), writer->origin);
        if (flat)
            bp_tree_write_triangles(writer, leaf, items, n);
        else
            bp_tree_write_leaf(writer, leaf, items, n);
    }
    return BP_OK;
}

static void make_triangle_items(void *context, uint32_t block, unsigned thread) {
    (void)thread;
    Scan *scan = context;
    for (size_t i = bp_block_begin(block); i < bp_block_end(block, scan->scene->triangle_count); ++i)
        scan->items[i] = bp_tree_triangle_item(scan->scene, (uint32_t)i, scan->origin);
}

/* A binary tree over the scene's triangles, whose reordered items the caller frees. */
static BpStatus build_triangles(const BpTreeWriter *writer, const BpBinaryOptions *options,
                                BpThreadPool *pool, BpTreeItem **items, BpBinaryTree *binary, BpError *err) {
    const size_t count = writer->scene->triangle_count, bytes = count * sizeof **items;
    if (count == 0) return BP_OK;
    *items = bp_large_pages(malloc(bytes), bytes);
    if (*items == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory while building the tree of %zu triangles", count);
    Scan scan = {.scene = writer->scene, .origin = writer->origin, .items = *items};
    bp_parallel_for(pool, make_triangle_items, &scan, bp_block_count((uint32_t)count));
    return bp_binary_tree_build(items, (uint32_t)count, options, pool, binary, err);
}

/* One tree of both: a leaf holds one kind, and the leaves of spheres are written first. */
static BpStatus join_kinds(BpBinaryTree *spheres, const BpBinaryTree *triangles, uint32_t width,
                           const BpBinaryNode **root, BpError *err) {
    *root = spheres->root != NULL ? spheres->root : triangles->root;
    if (spheres->root == NULL || triangles->root == NULL) return BP_OK;
    BpBinaryNode *both = bp_node_pool_take(&spheres->pools[0], width);
    if (both == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory while joining two trees");
    both->left = spheres->root;
    both->right = triangles->root;
    both->first = 0;
    both->count = both->left->count + both->right->count;
    bp_binary_finish(both, width);
    *root = both;
    return BP_OK;
}

static BpStatus build_tree(BpTreeWriter *writer, unsigned threads, BpError *err) {
    BpTree *tree = writer->tree;
    const uint32_t count = (uint32_t)writer->scene->sphere_count, blocks = bp_block_count(count) + 1;
    if (threads == 0 && bp_scene_shapes(writer->scene) < BP_BLOCK)
        threads = 1; /* waking them would take longer */
    BpStatus status = BP_OK;
    BpBinaryTree binary = {0}, flat = {0};
    BpTreeItem *triangle_items = NULL;
    const BpBinaryNode *root = NULL;
    BpThreadPool *pool = bp_thread_pool_create(threads);
    Scan scan = {.scene = writer->scene, .origin = writer->origin, .width = tree->width};
    const size_t item_bytes = ((size_t)count + writer->scene->capsule_count + 1) * sizeof *scan.items;
    scan.items = bp_large_pages(malloc(item_bytes), item_bytes);
    scan.largest = malloc(blocks * sizeof *scan.largest);
    scan.bounds = malloc(blocks * sizeof *scan.bounds);
    if (pool == NULL || scan.items == NULL || scan.largest == NULL || scan.bounds == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory while building the tree of %u spheres", count);
        goto cleanup;
    }
    const uint32_t items = scan_spheres(&scan, pool);
    /* Two trees that are joined have a level less each. */
    const bool mixed = items > 0 && writer->scene->triangle_count > 0;
    const BpBinaryOptions options = {.width = tree->width,
                                     .height_max = bp_tree_width_bits(tree->width) * TREE_DEPTH_MAX - mixed};
    BP_TRY_GOTO(status, bp_binary_tree_build(&scan.items, items, &options, pool, &binary, err), cleanup);
    BP_TRY_GOTO(status, build_triangles(writer, &options, pool, &triangle_items, &flat, err), cleanup);
    BP_TRY_GOTO(status, join_kinds(&binary, &flat, tree->width, &root, err), cleanup);
    writer->items = scan.items;
    writer->triangle_items = triangle_items;
    tree->first_leaves = tree->leaf_count = scan.candidates.count > 0 ? 1 : 0;
    tree->first_triangles = tree->first_leaves + (binary.root != NULL ? binary.root->leaves : 0);
    BP_TRY_GOTO(status, bp_tree_write_nodes(writer, root, pool, err), cleanup);
    BpTreeItem huge[BP_TREE_WIDTH_MAX];
    for (uint32_t k = 0; k < scan.candidates.count; ++k)
        huge[k] = bp_tree_item(writer->scene, scan.candidates.index[k], writer->origin);
    if (tree->first_leaves > 0) bp_tree_write_leaf(writer, 0, huge, scan.candidates.count);
cleanup:
    bp_binary_tree_clear(&binary);
    bp_binary_tree_clear(&flat);
    free(triangle_items);
    free(scan.items);
    free(scan.largest);
    free(scan.bounds);
    bp_thread_pool_destroy(&pool);
    return status;
}

BpStatus bp_tree_build(const BpScene *scene, const double origin[3], const BpTreeOptions *options,
                       BpTree *tree, BpError *err) {
    const double start = bp_clock_seconds();
    const uint32_t width = options->width;
    *tree = (BpTree){.width = width, .single_precision = options->single_precision, .own_slot = NO_SLOT};
    tree->has_motions = options->motions || scene->moving_count > 0;
    tree->has_normals = scene->normal_count > 0;
    tree->has_coordinates = bp_scene_mapped_triangles(scene) > 0;
    tree->has_axes = options->axes || scene->capsule_count > 0;
    if (width != 2 && width != 4 && width != 8 && width != 16)
        return bp_fail(err, BP_ERR_LIMIT, "a tree is 2, 4, 8 or 16 wide, not %u", width);
    /* A list cannot run out of depth, and neither can a wider tree of up to BP_SPHERES_MAX shapes. */
    const uint64_t limit = width == 2 && !options->list
                               ? (uint64_t)width << (TREE_DEPTH_MAX - (scene->triangle_count > 0))
                               : BP_SPHERES_MAX;
    if (bp_scene_shapes(scene) > limit)
        return bp_fail(err, BP_ERR_LIMIT, "%zu %ss; a tree %u wide holds at most %llu",
                       bp_scene_shapes(scene), bp_scene_noun(scene), width, (unsigned long long)limit);
    BpTreeWriter writer = {.scene = scene, .origin = origin, .tree = tree};
    const BpStatus status =
        options->list ? build_list(&writer, err) : build_tree(&writer, options->threads, err);
    if (status != BP_OK)
        bp_tree_clear(tree);
    else
        tree->build_seconds = bp_clock_seconds() - start;
    return status;
}

void bp_tree_clear(BpTree *tree) {
    free(tree->node_boxes);
    free(tree->children);
    free(tree->leaves);
    free(tree->slot_sphere);
    free(tree->triangles);
    free(tree->triangle_normals);
    free(tree->triangle_coordinates);
    free(tree->leaf_motions);
    free(tree->leaf_axes);
    *tree = (BpTree){0};
}
