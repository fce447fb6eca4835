/* tree_top.c: the upper part of a large binary tree; see tree_binary.h.
 *
 * Spheres are counted into the cells of a grid, which takes the place of some six passes of splitting: the
 * upper splits are chosen among the grid's planes, over cells instead of spheres, and the spheres are then
 * moved to their parts in one stable pass. First all threads together part the whole into some ranges, and
 * again what is still too large for one thread. Then each thread takes range after range, parts it by grids
 * of its own until what remains is small, and builds that (tree_binary.c). So the number of passes over
 * memory does not grow with the number of spheres, and most of them stay in a core's cache.
 *
 * Every decision is made from sums and extremes over all spheres, so it is the same for any number of
 * threads. */
#include "base/pages.h"
#include "tree_binary.h"
#include "tree_grid.h"

#include <stdlib.h>
#include <string.h>

#define RANGES 64u /* about so many ranges, or more, keep the threads of most machines busy */
#define RANGE_LEAST 2048u
#define RANGE_MOST (1u << 19) /* a thread's copy of a range is up to four times as many items */
#define RUN_MOST 16384u       /* runs of up to four times as many items fit a core's cache and need no grid */

/* Items first .. first+count-1, whose tree belongs at *place. */
typedef struct Run {
    uint32_t first, count, height_max;
    BpBinaryNode **place;
    bool one; /* a grid cannot part it */
} Run;

typedef struct RunList {
    Run *runs;
    uint32_t count, capacity;
} RunList;

/* Parts ranges by grids: one for all threads together, and one for each thread. */
typedef struct Splitter {
    BpTreeItem *items;
    const BpBinaryOptions *options;
    BpThreadPool *thread_pool;
    BpNodePool *pool;
    uint32_t run_max;     /* what is this small is not split further by a grid */
    BpBinaryNode **nodes; /* made here, parents before children */
    uint32_t node_count, node_capacity;
    BpTreeItem *buffer;
    uint32_t buffer_capacity;
    bool whole;  /* the range at hand is all there is: its copy replaces it */
    bool failed; /* out of memory */

    /* The range at hand. */
    Run range;
    BpGrid grid;
    uint32_t part_max;                  /* parts this small are not split further by this grid */
    uint32_t run_of[BP_GRID_CELLS_MAX]; /* number in `parts` */
    RunList parts;
    uint32_t *offsets; /* grid.block_count * parts.count */
    uint32_t filled;   /* items in the parts so far */
} Splitter;

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

/* Builds the upper tree over cells; what is small enough, or cannot be parted, becomes a part. */
static void build_cells(Splitter *s, uint32_t *cells, uint32_t cell_count, uint32_t height_max,
                        BpBinaryNode **place) {
    const uint32_t width = s->options->width;
    uint32_t items = 0;
    for (uint32_t c = 0; c < cell_count; ++c) items += s->grid.cells[cells[c]].count;
    BpGridPlane plane = {.axis = -1};
    if (items > s->part_max && cell_count > 1)
        plane =
            bp_grid_plane(&s->grid, cells, cell_count, items, width, bp_binary_side_max(width, height_max));
    if (plane.axis < 0) {
        const Run run = {s->range.first + s->filled, items, height_max, place, items == s->range.count};
        for (uint32_t c = 0; c < cell_count; ++c) s->run_of[cells[c]] = s->parts.count;
        s->filled += items;
        s->failed = s->failed || !push_run(&s->parts, &run);
        return;
    }
    BpBinaryNode *node = bp_node_pool_take(s->pool, s->options->width);
    BpBinaryNode **nodes = grow(s->nodes, s->node_count, &s->node_capacity, sizeof *nodes);
    if (nodes != NULL) s->nodes = nodes;
    if (node == NULL || nodes == NULL) {
        s->failed = true;
        return;
    }
    node->left = node->right = NULL;
    node->first = 0;
    node->count = items;
    *place = s->nodes[s->node_count++] = node;
    const uint32_t left = bp_grid_part(&s->grid, cells, cell_count, &plane);
    build_cells(s, cells, left, height_max - 1, &node->left);
    build_cells(s, cells + left, cell_count - left, height_max - 1, &node->right);
}

static void histogram_block(void *context, uint32_t block, unsigned thread) {
    (void)thread;
    Splitter *s = context;
    uint32_t first;
    const uint32_t count = bp_grid_block(&s->grid, block, &first);
    uint32_t *offsets = s->offsets + (size_t)block * s->parts.count;
    for (uint32_t i = first; i < first + count; ++i) ++offsets[s->run_of[s->grid.cell_of[i]]];
}

static void scatter_block(void *context, uint32_t block, unsigned thread) {
    (void)thread;
    Splitter *s = context;
    uint32_t first;
    const uint32_t count = bp_grid_block(&s->grid, block, &first);
    uint32_t *offsets = s->offsets + (size_t)block * s->parts.count;
    for (uint32_t i = first; i < first + count; ++i)
        s->buffer[offsets[s->run_of[s->grid.cell_of[i]]]++] = s->grid.items[i];
}

static void return_block(void *context, uint32_t block, unsigned thread) {
    (void)thread;
    Splitter *s = context;
    uint32_t first;
    const uint32_t count = bp_grid_block(&s->grid, block, &first);
    memcpy(s->items + s->range.first + first, s->buffer + first, count * sizeof *s->buffer);
}

/* Moves the items of the range to the parts that build_cells() made of it. */
static void move_items(Splitter *s) {
    const uint32_t count = s->range.count;
    if (s->buffer_capacity < count) {
        free(s->buffer);
        const size_t bytes = count * sizeof *s->buffer;
        s->buffer = bp_large_pages(malloc(bytes), bytes);
        s->buffer_capacity = count;
    }
    s->offsets = calloc((size_t)s->grid.block_count * s->parts.count, sizeof *s->offsets);
    if (s->offsets == NULL || s->buffer == NULL) {
        s->failed = true;
        return;
    }
    bp_parallel_for(s->thread_pool, histogram_block, s, s->grid.block_count);
    uint32_t next = 0;
    for (uint32_t r = 0; r < s->parts.count; ++r)
        for (uint32_t b = 0; b < s->grid.block_count; ++b) {
            uint32_t *offset = &s->offsets[(size_t)b * s->parts.count + r];
            const uint32_t here = *offset;
            *offset = next;
            next += here;
        }
    bp_parallel_for(s->thread_pool, scatter_block, s, s->grid.block_count);
    if (s->whole) {
        BpTreeItem *const before = s->items;
        s->items = s->buffer;
        s->buffer = NULL;
        s->buffer_capacity = 0;
        free(before);
    } else {
        bp_parallel_for(s->thread_pool, return_block, s, s->grid.block_count);
    }
    free(s->offsets);
    s->offsets = NULL;
}

/* Parts a range. What is too large for what follows, more than `most`, goes back to `ranges`, the rest to
 * `runs`. */
static void split_range(Splitter *s, const Run *range, uint32_t most, RunList *ranges, RunList *runs) {
    s->range = *range;
    s->parts.count = s->filled = 0;
    s->part_max = range->count / RANGES > s->run_max ? range->count / RANGES : s->run_max;
    if (!bp_grid_fill(&s->grid, s->items + range->first, range->count, s->thread_pool)) {
        s->failed = true;
        return;
    }
    build_cells(s, s->grid.used, s->grid.used_count, range->height_max, range->place);
    if (!s->failed && s->parts.count > 1) move_items(s);
    for (uint32_t p = 0; p < s->parts.count && !s->failed; ++p) {
        const Run *part = &s->parts.runs[p];
        s->failed = !push_run(part->count > most && !part->one ? ranges : runs, part);
    }
}

/* Gives back what a range was moved by. */
static void release_room(Splitter *s) {
    bp_grid_clear(&s->grid);
    free(s->buffer);
    s->buffer = NULL;
    s->buffer_capacity = 0;
}

static void splitter_clear(Splitter *s) {
    release_room(s);
    free(s->nodes);
    free(s->parts.runs);
}

/* Makes the nodes whole whose children are. */
static void finish_nodes(Splitter *s) {
    for (uint32_t n = s->node_count; n > 0 && !s->failed; --n)
        bp_binary_finish(s->nodes[n - 1], s->options->width);
    s->node_count = 0;
}

/* ---- the threads ----------------------------------------------------------------------------------- */

typedef struct Top {
    Splitter *own; /* of each thread */
    RunList runs;  /* for one thread each, the largest first */
    BpBinaryTree *tree;
} Top;

static void build_run(void *context, uint32_t piece, unsigned thread) {
    Top *top = context;
    Splitter *s = &top->own[thread];
    BpNodePool pool = top->tree->pools[thread]; /* a copy, for neighbours in memory belong to other threads */
    RunList ranges = {0}, runs = {0};
    s->pool = &pool;
    s->failed = s->failed || !push_run(top->runs.runs[piece].count > 4 * s->run_max ? &ranges : &runs,
                                       &top->runs.runs[piece]);
    while (!s->failed && ranges.count + runs.count > 0) {
        if (runs.count > 0) {
            const Run *run = &runs.runs[--runs.count];
            const BpBinaryOptions options = {s->options->width, run->height_max};
            *run->place = bp_binary_build_run(s->items, run->first, run->count, &options, &pool);
            s->failed = pool.failed;
        } else {
            const Run range = ranges.runs[--ranges.count];
            split_range(s, &range, 4 * s->run_max, &ranges, &runs);
        }
    }
    finish_nodes(s);
    free(ranges.runs);
    free(runs.runs);
    top->tree->pools[thread] = pool;
}

static int larger_first(const void *a, const void *b) {
    const Run *l = a, *r = b;
    if (l->count != r->count) return l->count > r->count ? -1 : 1;
    return l->first < r->first ? -1 : l->first > r->first;
}

/* All threads together part the whole into runs of at most about `most` items, one for each thread's turn. */
static void split_whole(Splitter *all, const Run *whole, uint32_t most, RunList *runs) {
    RunList ranges = {0};
    all->failed = !push_run(whole->count > most ? &ranges : runs, whole);
    while (!all->failed && ranges.count > 0) {
        const Run range = ranges.runs[--ranges.count];
        all->whole = range.count == whole->count;
        split_range(all, &range, most, &ranges, runs);
    }
    free(ranges.runs);
    release_room(all); /* before each thread takes some */
}

BpStatus bp_binary_tree_build(BpTreeItem **items, uint32_t count, const BpBinaryOptions *options,
                              BpThreadPool *thread_pool, BpBinaryTree *tree, BpError *err) {
    const unsigned threads = bp_thread_pool_size(thread_pool);
    *tree = (BpBinaryTree){.pools = calloc(threads, sizeof *tree->pools), .pool_count = threads};
    Top top = {.own = calloc(threads, sizeof *top.own), .tree = tree};
    Splitter *all = calloc(1, sizeof *all);
    BpThreadPool *alone = bp_thread_pool_create(1);
    bool failed = tree->pools == NULL || top.own == NULL || all == NULL || alone == NULL;
    if (!failed && count > 0) {
        const Run whole = {.count = count, .height_max = options->height_max, .place = &tree->root};
        *all = (Splitter){
            .items = *items, .options = options, .thread_pool = thread_pool, .pool = &tree->pools[0]};
        all->run_max = count / RANGES < RANGE_MOST ? count / RANGES : RANGE_MOST;
        if (all->run_max < RANGE_LEAST) all->run_max = RANGE_LEAST;
        split_whole(all, &whole, 4 * all->run_max, &top.runs);
        *items = all->items;
        for (unsigned w = 0; w < threads; ++w)
            top.own[w] =
                (Splitter){.items = *items, .options = options, .thread_pool = alone, .run_max = RUN_MOST};
        if (!all->failed) {
            qsort(top.runs.runs, top.runs.count, sizeof *top.runs.runs, larger_first);
            bp_parallel_for(thread_pool, build_run, &top, top.runs.count);
        }
        for (unsigned w = 0; w < threads; ++w) {
            all->failed = all->failed || top.own[w].failed;
            splitter_clear(&top.own[w]);
        }
        finish_nodes(all);
        failed = all->failed;
        splitter_clear(all);
    }
    free(top.own);
    free(top.runs.runs);
    free(all);
    bp_thread_pool_destroy(&alone);
    if (!failed) return BP_OK;
    bp_binary_tree_clear(tree);
    return bp_fail(err, BP_ERR_MEMORY, "out of memory while building the tree of %u spheres", count);
}

void bp_binary_tree_clear(BpBinaryTree *tree) {
    for (unsigned w = 0; tree->pools != NULL && w < tree->pool_count; ++w)
        bp_node_pool_clear(&tree->pools[w]);
    free(tree->pools);
    *tree = (BpBinaryTree){0};
}
