/* tree_top.c: the upper part of a large binary tree, on all threads; see tree_binary.h.
 *
 * Spheres are counted into the cells of a grid, which takes the place of some seven passes of splitting: the
 * upper splits are chosen among the grid's planes, over cells instead of spheres, until what remains is small
 * enough for one thread. The spheres are then moved to their runs in one stable pass, and the runs are built
 * independently (tree_binary.c). A cell that holds too much gets a grid of its own.
 *
 * Every decision is made from sums and extremes over all spheres, so it is the same for any number of
 * threads. */
#include "tree_binary.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CELLS_MAX 32768u
#define PLANES 32
#define RUNS 64u /* about so many runs, or more, keep the threads of most machines busy */
#define BLOCKS_MAX 256u

typedef struct Cell {
    BpTreeBox box;
    uint32_t count;
    uint16_t at[3]; /* column of the grid, each axis */
} Cell;

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
    uint32_t run_max;     /* a run this small is built by one thread */
    RunList ranges, runs; /* to be gridded; to be built */
    BpBinaryNode **nodes; /* of the upper part, parents before children */
    uint32_t node_count, node_capacity;
    Cell *cells;       /* CELLS_MAX for each worker */
    uint16_t *cell_of; /* of each item of the range */
    bool failed;       /* out of memory */

    /* The range at hand. */
    Run range;
    uint32_t block_count, block_size;
    BpTreeBox block_box[BLOCKS_MAX]; /* of centres */
    float low[3], scale[3];
    uint32_t columns[3], cell_count;
    uint32_t run_of[CELLS_MAX]; /* number in `runs`, counted from runs_before */
    uint32_t runs_before, runs_here;
    uint32_t *offsets; /* block_count * runs_here */
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

/* ---- passes over the items of the range, block by block -------------------------------------------- */

static uint32_t block_items(const Top *top, uint32_t block, BpTreeItem **items, uint32_t *first) {
    *first = block * top->block_size;
    *items = top->items[top->range.buffer] + top->range.first + *first;
    const uint32_t left = top->range.count - *first;
    return left < top->block_size ? left : top->block_size;
}

static void bound_block(void *context, uint32_t block, unsigned worker) {
    (void)worker;
    Top *top = context;
    BpTreeItem *items;
    uint32_t first;
    const uint32_t count = block_items(top, block, &items, &first);
    BpTreeBox box = BP_TREE_BOX_EMPTY;
    for (uint32_t i = 0; i < count; ++i)
        for (int a = 0; a < 3; ++a) {
            const float c = items[i].center[a];
            box.low[a] = c < box.low[a] ? c : box.low[a];
            box.high[a] = c > box.high[a] ? c : box.high[a];
        }
    top->block_box[block] = box;
}

static uint32_t column_of(const Top *top, int axis, float center) {
    const uint32_t column = (uint32_t)((center - top->low[axis]) * top->scale[axis]);
    return column < top->columns[axis] ? column : top->columns[axis] - 1;
}

static void count_block(void *context, uint32_t block, unsigned worker) {
    Top *top = context;
    Cell *cells = top->cells + (size_t)worker * CELLS_MAX;
    BpTreeItem *items;
    uint32_t first;
    const uint32_t count = block_items(top, block, &items, &first);
    for (uint32_t i = 0; i < count; ++i) {
        const float *c = items[i].center;
        const uint32_t x = column_of(top, 0, c[0]), y = column_of(top, 1, c[1]), z = column_of(top, 2, c[2]);
        const uint32_t cell = (z * top->columns[1] + y) * top->columns[0] + x;
        top->cell_of[first + i] = (uint16_t)cell;
        ++cells[cell].count;
        bp_tree_box_add_item(&cells[cell].box, &items[i]);
    }
}

static void histogram_block(void *context, uint32_t block, unsigned worker) {
    (void)worker;
    Top *top = context;
    BpTreeItem *items;
    uint32_t first;
    const uint32_t count = block_items(top, block, &items, &first);
    uint32_t *offsets = top->offsets + (size_t)block * top->runs_here;
    for (uint32_t i = 0; i < count; ++i) ++offsets[top->run_of[top->cell_of[first + i]]];
}

static void scatter_block(void *context, uint32_t block, unsigned worker) {
    (void)worker;
    Top *top = context;
    BpTreeItem *items, *to = top->items[1 - top->range.buffer];
    uint32_t first;
    const uint32_t count = block_items(top, block, &items, &first);
    uint32_t *offsets = top->offsets + (size_t)block * top->runs_here;
    for (uint32_t i = 0; i < count; ++i) to[offsets[top->run_of[top->cell_of[first + i]]]++] = items[i];
}

static void clear_cells(void *context, uint32_t piece, unsigned worker) {
    (void)worker;
    Top *top = context;
    static const Cell empty = {.box = BP_TREE_BOX_EMPTY};
    for (uint32_t c = 0; c < top->cell_count; ++c) top->cells[(size_t)piece * CELLS_MAX + c] = empty;
}

/* ---- the grid -------------------------------------------------------------------------------------- */

/* Cells about as wide as high as deep, about one for eight items. */
static void lay_grid(Top *top) {
    BpTreeBox box = top->block_box[0];
    for (uint32_t b = 1; b < top->block_count; ++b) bp_tree_box_add(&box, &top->block_box[b]);
    double extent[3], wanted = top->range.count / 8.0;
    if (wanted > CELLS_MAX) wanted = CELLS_MAX;
    bool flat[3] = {false, false, false};
    for (int a = 0; a < 3; ++a) {
        top->low[a] = box.low[a];
        extent[a] = (double)box.high[a] - (double)box.low[a];
    }
    double side = 0;
    for (int round = 0; round < 3; ++round) {
        /* An axis shorter than one cell has one column; the others share the cells. */
        double product = 1;
        int axes = 0;
        for (int a = 0; a < 3; ++a) {
            flat[a] = flat[a] || extent[a] <= side;
            if (flat[a]) continue;
            product *= extent[a];
            ++axes;
        }
        if (axes == 0) break;
        side = pow(product / wanted, 1.0 / axes);
    }
    top->cell_count = 1;
    for (int a = 0; a < 3; ++a) {
        const double columns = flat[a] ? 1 : floor(extent[a] / side * (1 + 1e-9));
        top->columns[a] = columns < 1                             ? 1
                          : columns > CELLS_MAX / top->cell_count ? CELLS_MAX / top->cell_count
                                                                  : (uint32_t)columns;
        top->cell_count *= top->columns[a];
        top->scale[a] = top->columns[a] > 1 ? (float)(top->columns[a] / extent[a]) : 0;
        if (!(top->scale[a] < FLT_MAX)) top->scale[a] = 0;
    }
}

/* Counts the items into the cells, and leaves the cells in use at the front of `used`. */
static uint32_t fill_grid(Top *top, uint32_t *used) {
    bp_team_run(top->team, clear_cells, top, bp_team_size(top->team));
    bp_team_run(top->team, count_block, top, top->block_count);
    for (unsigned w = 1; w < bp_team_size(top->team); ++w)
        for (uint32_t c = 0; c < top->cell_count; ++c) {
            const Cell *cell = &top->cells[(size_t)w * CELLS_MAX + c];
            top->cells[c].count += cell->count;
            bp_tree_box_add(&top->cells[c].box, &cell->box);
        }
    uint32_t count = 0;
    for (uint32_t c = 0; c < top->cell_count; ++c) {
        if (top->cells[c].count == 0) continue;
        top->cells[c].at[0] = (uint16_t)(c % top->columns[0]);
        top->cells[c].at[1] = (uint16_t)(c / top->columns[0] % top->columns[1]);
        top->cells[c].at[2] = (uint16_t)(c / top->columns[0] / top->columns[1]);
        used[count++] = c;
    }
    return count;
}

typedef struct Plane {
    int axis; /* < 0: none */
    uint32_t low, bins, span, bin;
} Plane;

static uint32_t bin_of_cell(const Cell *cell, const Plane *plane) {
    return (cell->at[plane->axis] - plane->low) * plane->bins / plane->span;
}

/* The cheapest plane between columns (or groups of them, where there are many) that leaves no side with more
 * than `side_max` items. */
static Plane find_plane(const Top *top, const uint32_t *cells, uint32_t cell_count, uint32_t items,
                        uint64_t side_max) {
    static const BpTreeBox empty = BP_TREE_BOX_EMPTY;
    const uint32_t width = top->options->width;
    Plane best = {.axis = -1};
    float best_cost = INFINITY;
    for (int a = 0; a < 3; ++a) {
        uint32_t low = UINT32_MAX, high = 0;
        for (uint32_t c = 0; c < cell_count; ++c) {
            const uint32_t at = top->cells[cells[c]].at[a];
            low = at < low ? at : low;
            high = at > high ? at : high;
        }
        if (low == high) continue;
        Plane plane = {.axis = a, .low = low, .span = high - low + 1};
        plane.bins = plane.span < PLANES ? plane.span : PLANES;
        BpTreeBox boxes[PLANES];
        uint32_t counts[PLANES] = {0};
        for (int b = 0; b < PLANES; ++b) boxes[b] = empty;
        for (uint32_t c = 0; c < cell_count; ++c) {
            const Cell *cell = &top->cells[cells[c]];
            const uint32_t b = bin_of_cell(cell, &plane);
            counts[b] += cell->count;
            bp_tree_box_add(&boxes[b], &cell->box);
        }
        float cost_right[PLANES];
        BpTreeBox box = empty;
        uint32_t n = 0;
        for (uint32_t b = plane.bins - 1; b > 0; --b) {
            bp_tree_box_add(&box, &boxes[b]);
            n += counts[b];
            cost_right[b] = bp_tree_box_half_area(&box) * bp_tree_run_cost(n, width);
        }
        box = empty;
        n = 0;
        for (uint32_t b = 1; b < plane.bins; ++b) {
            bp_tree_box_add(&box, &boxes[b - 1]);
            n += counts[b - 1];
            const float cost = bp_tree_box_half_area(&box) * bp_tree_run_cost(n, width) + cost_right[b];
            if (n > 0 && n < items && n <= side_max && items - n <= side_max && cost < best_cost) {
                best_cost = cost;
                best = plane;
                best.bin = b;
            }
        }
    }
    return best;
}

/* Builds the upper tree over cells; what is small enough, or cannot be parted, becomes a run. */
static void build_cells(Top *top, uint32_t *cells, uint32_t cell_count, uint32_t height_max,
                        BpBinaryNode **place) {
    uint32_t items = 0;
    for (uint32_t c = 0; c < cell_count; ++c) items += top->cells[cells[c]].count;
    const uint64_t side_max = (uint64_t)top->options->width << (height_max > 32 ? 32 : height_max - 1);
    Plane plane = {.axis = -1};
    if (items > top->run_max && cell_count > 1) plane = find_plane(top, cells, cell_count, items, side_max);
    if (plane.axis < 0) {
        const Run run = {top->range.first + top->filled, items, height_max, 1 - top->range.buffer, place};
        for (uint32_t c = 0; c < cell_count; ++c) top->run_of[cells[c]] = top->runs_here;
        top->filled += items;
        ++top->runs_here;
        top->failed = top->failed || !push_run(&top->runs, &run);
        return;
    }
    BpBinaryNode *node = bp_node_pool_take(&top->tree->pools[0]);
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
    uint32_t left = 0;
    for (uint32_t c = 0; c < cell_count; ++c)
        if (bin_of_cell(&top->cells[cells[c]], &plane) < plane.bin) {
            const uint32_t cell = cells[c];
            cells[c] = cells[left];
            cells[left++] = cell;
        }
    build_cells(top, cells, left, height_max - 1, &node->left);
    build_cells(top, cells + left, cell_count - left, height_max - 1, &node->right);
}

/* Moves the items of the range to the runs that build_cells() made of it. */
static void move_items(Top *top) {
    top->offsets = calloc((size_t)top->block_count * top->runs_here, sizeof *top->offsets);
    if (top->offsets == NULL) {
        top->failed = true;
        return;
    }
    bp_team_run(top->team, histogram_block, top, top->block_count);
    uint32_t next = top->range.first;
    for (uint32_t r = 0; r < top->runs_here; ++r)
        for (uint32_t b = 0; b < top->block_count; ++b) {
            uint32_t *offset = &top->offsets[(size_t)b * top->runs_here + r];
            const uint32_t here = *offset;
            *offset = next;
            next += here;
        }
    bp_team_run(top->team, scatter_block, top, top->block_count);
    free(top->offsets);
    top->offsets = NULL;
}

/* Parts the range into runs; of those too large for one thread, ranges. */
static void split_range(Top *top, uint32_t *used) {
    top->block_size = top->range.count / BLOCKS_MAX + 1;
    if (top->block_size < 4096) top->block_size = 4096;
    top->block_count = (top->range.count + top->block_size - 1) / top->block_size;
    top->runs_before = top->runs.count;
    top->runs_here = top->filled = 0;
    bp_team_run(top->team, bound_block, top, top->block_count);
    lay_grid(top);
    const uint32_t cell_count = fill_grid(top, used);
    build_cells(top, used, cell_count, top->range.height_max, top->range.place);
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
    uint32_t *used = malloc(CELLS_MAX * sizeof *used);
    top->items[1] = malloc(count * sizeof *top->items[1]);
    top->cell_of = malloc(count * sizeof *top->cell_of);
    top->cells = malloc((size_t)workers * CELLS_MAX * sizeof *top->cells);
    const Run all = {0, count, top->options->height_max, 0, &top->tree->root};
    top->failed = used == NULL || top->items[1] == NULL || top->cell_of == NULL || top->cells == NULL ||
                  !push_run(&top->ranges, &all);
    while (top->ranges.count > 0 && !top->failed) {
        top->range = top->ranges.runs[--top->ranges.count];
        split_range(top, used);
    }
    if (!top->failed) {
        qsort(top->runs.runs, top->runs.count, sizeof *top->runs.runs, larger_first);
        bp_team_run(top->team, build_run, top, top->runs.count);
    }
    for (unsigned w = 0; w < workers; ++w) top->failed = top->failed || top->tree->pools[w].failed;
    for (uint32_t n = top->node_count; n > 0 && !top->failed; --n)
        bp_binary_finish(top->nodes[n - 1], top->options->width);
    const bool failed = top->failed;
    free(used);
    free(top->items[1]);
    free(top->cell_of);
    free(top->cells);
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
    *top = (Top){.items = {items, NULL}, .options = options, .team = team, .tree = tree};
    top->run_max = count / RUNS;
    if (top->run_max < 2048) top->run_max = 2048;
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
