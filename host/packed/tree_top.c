/* tree_top.c: the upper part of a large binary tree, on all threads; see tree_binary.h.
 *
 * Spheres are counted into the cells of a grid, which takes the place of some seven passes of splitting: the
 * upper splits are chosen among the grid's planes, over cells instead of spheres, until what remains is small
 * enough for one thread. The spheres are then moved to their runs in one stable pass, and the runs are built
 * independently (tree_binary.c). A run, or a cell, that holds too much for that gets a grid of its own.
 *
 * Every decision is made from sums and extremes over all spheres, so it is the same for any number of
 * threads. */
#include "tree_binary.h"
#include "tree_grid.h"

#include <stdlib.h>
#include <string.h>

#define RUNS 64u /* about so many runs, or more, keep the threads of most machines busy */
/* As many items as a core's cache holds. Larger runs get grids of their own, so that time grows with the
 * number of spheres alone, and not with its logarithm too. */
#define RUN_MAX 131072u

/* Items first .. first+count-1 of buffer `buffer`, whose tree belongs at *place. */
typedef struct Run {
    uint32_t first, count, height_max;
    int buffer;
    BpBinaryNode **place;
} Run;

typedef struct RunList {
    Run *runs;
    uint32_t count, capacity;
} RunList;

typedef struct Top {
    BpTreeItem *items[2];
    const BpBinaryOptions *options;
    BpTeam *team;
    BpBinaryTree *tree;
    uint32_t run_max;     /* a run this small is built by one thread, and one of up to four times as many */
    uint32_t part_max;    /* of the range at hand: what is this small is not split further by its grid */
    RunList ranges, runs; /* to be gridded; to be built */
    BpBinaryNode **nodes; /* of the upper part, parents before children */
    uint32_t node_count, node_capacity;
    bool failed; /* out of memory */

    /* The range at hand. */
    Run range;
    BpGrid grid;
    uint32_t run_of[BP_GRID_CELLS_MAX]; /* number in `runs`, counted from runs_before */
    uint32_t runs_before, runs_here;
    uint32_t *offsets; /* grid.block_count * runs_here */
    uint32_t filled;   /* items in the runs so far */
} Top;

static void *grow(void *array, uint32_t count, uint32_t *capacity, size_t size) {
    if (count < *capacity) return array;
    const uint32_t wanted = *capacity < 64 ? 64 : 2 * *capacity;
    void *larger = realloc(array, wanted * size);
    if (larger != NULL) *capacity = wanted;
    return larger;
}

static bool push_run(RunList *list, const Run *run) {
    Run *runs = grow(list->runs, list->count, &list->capacity, sizeof *runs);
    if (runs == NULL) return false;
    list->runs = runs;
    runs[list->count++] = *run;
    return true;
}

/* ---- ranges ---------------------------------------------------------------------------------------- */

/* Builds the upper tree over cells; what is small enough, or cannot be parted, becomes a run. */
static void build_cells(Top *top, uint32_t *cells, uint32_t cell_count, uint32_t height_max,
                        BpBinaryNode **place) {
    const uint32_t width = top->options->width;
    uint32_t items = 0;
    for (uint32_t c = 0; c < cell_count; ++c) items += top->grid.cells[cells[c]].count;
    BpGridPlane plane = {.axis = -1};
    if (items > top->part_max && cell_count > 1)
        plane =
            bp_grid_plane(&top->grid, cells, cell_count, items, width, bp_binary_side_max(width, height_max));
    if (plane.axis < 0) {
        const Run run = {top->range.first + top->filled, items, height_max, 1 - top->range.buffer, place};
        for (uint32_t c = 0; c < cell_count; ++c) top->run_of[cells[c]] = top->runs_here;
        top->filled += items;
        ++top->runs_here;
        top->failed = top->failed || !push_run(&top->runs, &run);
        return;
    }
    BpBinaryNode *node = bp_node_pool_take(&top->tree->pools[0], top->options->width);
    BpBinaryNode **nodes = grow(top->nodes, top->node_count, &top->node_capacity, sizeof *nodes);
    if (nodes != NULL) top->nodes = nodes;
    if (node == NULL || nodes == NULL) {
        top->failed = true;
        return;
    }
    node->left = node->right = NULL;
    node->first = 0;
    node->count = items;
    *place = top->nodes[top->node_count++] = node;
    const uint32_t left = bp_grid_part(&top->grid, cells, cell_count, &plane);
    build_cells(top, cells, left, height_max - 1, &node->left);
    build_cells(top, cells + left, cell_count - left, height_max - 1, &node->right);
}

static void histogram_block(void *context, uint32_t block, unsigned worker) {
    (void)worker;
    Top *top = context;
    uint32_t first;
    const uint32_t count = bp_grid_block(&top->grid, block, &first);
    uint32_t *offsets = top->offsets + (size_t)block * top->runs_here;
    for (uint32_t i = first; i < first + count; ++i) ++offsets[top->run_of[top->grid.cell_of[i]]];
}

static void scatter_block(void *context, uint32_t block, unsigned worker) {
    (void)worker;
    Top *top = context;
    BpTreeItem *to = top->items[1 - top->range.buffer];
    uint32_t first;
    const uint32_t count = bp_grid_block(&top->grid, block, &first);
    uint32_t *offsets = top->offsets + (size_t)block * top->runs_here;
    for (uint32_t i = first; i < first + count; ++i)
        to[offsets[top->run_of[top->grid.cell_of[i]]]++] = top->grid.items[i];
}

/* Moves the items of the range to the runs that build_cells() made of it. */
static void move_items(Top *top) {
    top->offsets = calloc((size_t)top->grid.block_count * top->runs_here, sizeof *top->offsets);
    if (top->offsets == NULL) {
        top->failed = true;
        return;
    }
    bp_team_run(top->team, histogram_block, top, top->grid.block_count);
    uint32_t next = top->range.first;
    for (uint32_t r = 0; r < top->runs_here; ++r)
        for (uint32_t b = 0; b < top->grid.block_count; ++b) {
            uint32_t *offset = &top->offsets[(size_t)b * top->runs_here + r];
            const uint32_t here = *offset;
            *offset = next;
            next += here;
        }
    bp_team_run(top->team, scatter_block, top, top->grid.block_count);
    free(top->offsets);
    top->offsets = NULL;
}

/* Parts the range into runs; of those too large for one thread, ranges. */
static void split_range(Top *top) {
    const Run *range = &top->range;
    top->runs_before = top->runs.count;
    top->runs_here = top->filled = 0;
    top->part_max = range->count / RUNS > top->run_max ? range->count / RUNS : top->run_max;
    bp_grid_fill(&top->grid, top->items[range->buffer] + range->first, range->count, top->team);
    build_cells(top, top->grid.used, top->grid.used_count, range->height_max, range->place);
    if (top->failed) return;
    if (top->runs_here == 1) {
        top->runs.runs[top->runs.count - 1].buffer = top->range.buffer;
        return;
    }
    move_items(top);
    uint32_t kept = top->runs_before;
    for (uint32_t r = top->runs_before; r < top->runs.count && !top->failed; ++r) {
        const Run run = top->runs.runs[r];
        if (run.count > 4 * top->run_max)
            top->failed = !push_run(&top->ranges, &run);
        else
            top->runs.runs[kept++] = run;
    }
    top->runs.count = kept;
}

/* ---- the runs -------------------------------------------------------------------------------------- */

static void build_run(void *context, uint32_t piece, unsigned worker) {
    Top *top = context;
    const Run *run = &top->runs.runs[piece];
    if (run->buffer == 1)
        memcpy(top->items[0] + run->first, top->items[1] + run->first, run->count * sizeof(BpTreeItem));
    const BpBinaryOptions options = {top->options->width, run->height_max};
    BpNodePool pool = top->tree->pools[worker]; /* a copy, for neighbours in memory belong to other threads */
    *run->place = bp_binary_build_run(top->items[0], run->first, run->count, &options, &pool);
    top->tree->pools[worker] = pool;
}

static int larger_first(const void *a, const void *b) {
    const Run *l = a, *r = b;
    if (l->count != r->count) return l->count > r->count ? -1 : 1;
    return l->first < r->first ? -1 : l->first > r->first;
}

static BpStatus build_large(Top *top, uint32_t count, BpError *err) {
    const unsigned workers = bp_team_size(top->team);
    top->items[1] = malloc(count * sizeof *top->items[1]);
    const Run all = {0, count, top->options->height_max, 0, &top->tree->root};
    top->failed =
        !bp_grid_init(&top->grid, count, workers) || top->items[1] == NULL || !push_run(&top->ranges, &all);
    while (top->ranges.count > 0 && !top->failed) {
        top->range = top->ranges.runs[--top->ranges.count];
        split_range(top);
    }
    if (!top->failed) {
        qsort(top->runs.runs, top->runs.count, sizeof *top->runs.runs, larger_first);
        bp_team_run(top->team, build_run, top, top->runs.count);
    }
    for (unsigned w = 0; w < workers; ++w) top->failed = top->failed || top->tree->pools[w].failed;
    for (uint32_t n = top->node_count; n > 0 && !top->failed; --n)
        bp_binary_finish(top->nodes[n - 1], top->options->width);
    const bool failed = top->failed;
    bp_grid_clear(&top->grid);
    free(top->items[1]);
    free(top->ranges.runs);
    free(top->runs.runs);
    free(top->nodes);
    return failed ? bp_fail(err, BP_ERR_MEMORY, "out of memory while building the tree of %u spheres", count)
                  : BP_OK;
}

BpStatus bp_binary_tree_build(BpTreeItem *items, uint32_t count, const BpBinaryOptions *options, BpTeam *team,
                              BpBinaryTree *tree, BpError *err) {
    BpStatus status = BP_OK;
    Top *top = NULL;
    *tree = (BpBinaryTree){.pool_count = bp_team_size(team)};
    tree->pools = calloc(tree->pool_count, sizeof *tree->pools);
    top = calloc(1, sizeof *top);
    if (tree->pools == NULL || top == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory while building the tree of %u spheres", count);
        goto cleanup;
    }
    top->items[0] = items;
    top->options = options;
    top->team = team;
    top->tree = tree;
    top->run_max = count / RUNS;
    if (top->run_max < 2048) top->run_max = 2048;
    if (top->run_max > RUN_MAX) top->run_max = RUN_MAX;
    if (count > 4 * top->run_max) {
        status = build_large(top, count, err);
    } else if (count > 0) {
        tree->root = bp_binary_build_run(items, 0, count, options, &tree->pools[0]);
        if (tree->root == NULL)
            status =
                bp_fail(err, BP_ERR_MEMORY, "out of memory while building the tree of %u spheres", count);
    }
cleanup:
    free(top);
    if (status != BP_OK) bp_binary_tree_clear(tree);
    return status;
}

void bp_binary_tree_clear(BpBinaryTree *tree) {
    for (unsigned w = 0; tree->pools != NULL && w < tree->pool_count; ++w)
        bp_node_pool_clear(&tree->pools[w]);
    free(tree->pools);
    *tree = (BpBinaryTree){0};
}
