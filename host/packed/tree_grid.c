/* tree_grid.c: see tree_grid.h. Counts, extremes and what follows from them do not depend on who counts. */
#include "tree_grid.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#define PLANES 32
#define BLOCK_MIN 4096u

/* Room for `count` items. */
static bool make_room(BpGrid *grid, uint32_t count, unsigned threads) {
    if (grid->cells == NULL) grid->cells = malloc((size_t)threads * BP_GRID_CELLS_MAX * sizeof *grid->cells);
    if (grid->used == NULL) grid->used = malloc(BP_GRID_CELLS_MAX * sizeof *grid->used);
    if (grid->cell_of_capacity < count) {
        free(grid->cell_of);
        grid->cell_of = malloc(count * sizeof *grid->cell_of);
        grid->cell_of_capacity = grid->cell_of != NULL ? count : 0;
    }
    return grid->cells != NULL && grid->used != NULL && grid->cell_of != NULL;
}

void bp_grid_clear(BpGrid *grid) {
    free(grid->cells);
    free(grid->cell_of);
    free(grid->used);
    *grid = (BpGrid){0};
}

uint32_t bp_grid_block(const BpGrid *grid, uint32_t block, uint32_t *first) {
    *first = block * grid->block_size;
    const uint32_t left = grid->count - *first;
    return left < grid->block_size ? left : grid->block_size;
}

/* ---- counting -------------------------------------------------------------------------------------- */

static void bound_block(void *context, uint32_t block, unsigned thread) {
    (void)thread;
    BpGrid *grid = context;
    uint32_t first;
    const uint32_t count = bp_grid_block(grid, block, &first);
    BpTreeBox box = BP_TREE_BOX_EMPTY;
    for (uint32_t i = first; i < first + count; ++i)
        for (int a = 0; a < 3; ++a) {
            const float c = grid->items[i].center[a];
            box.low[a] = c < box.low[a] ? c : box.low[a];
            box.high[a] = c > box.high[a] ? c : box.high[a];
        }
    grid->block_box[block] = box;
}

/* Cells about as wide as high as deep, about one for eight items. */
static void lay(BpGrid *grid) {
    BpTreeBox box = grid->block_box[0];
    for (uint32_t b = 1; b < grid->block_count; ++b) bp_tree_box_add(&box, &grid->block_box[b]);
    double extent[3], wanted = grid->count / 8.0, side = 0;
    if (wanted > BP_GRID_CELLS_MAX) wanted = BP_GRID_CELLS_MAX;
    bool flat[3] = {false, false, false};
    for (int a = 0; a < 3; ++a) extent[a] = (double)box.high[a] - (double)box.low[a];
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
    grid->cell_count = 1;
    for (int a = 0; a < 3; ++a) {
        const double most = BP_GRID_CELLS_MAX / grid->cell_count;
        double columns = flat[a] ? 1 : floor(extent[a] / side * (1 + 1e-9));
        columns = columns < 1 ? 1 : columns > most ? most : columns;
        const float scale = columns > 1 ? (float)(columns / extent[a]) : 0;
        grid->low[a] = box.low[a];
        grid->scale[a] = scale < FLT_MAX ? scale : 0;
        grid->columns[a] = (uint32_t)columns;
        grid->cell_count *= grid->columns[a];
    }
}

static void clear_cells(void *context, uint32_t piece, unsigned thread) {
    (void)thread;
    BpGrid *grid = context;
    static const BpGridCell empty = {.box = BP_TREE_BOX_EMPTY};
    for (uint32_t c = 0; c < grid->cell_count; ++c)
        grid->cells[(size_t)piece * BP_GRID_CELLS_MAX + c] = empty;
}

static uint32_t column_of(const BpGrid *grid, int axis, float center) {
    const uint32_t column = (uint32_t)((center - grid->low[axis]) * grid->scale[axis]);
    return column < grid->columns[axis] ? column : grid->columns[axis] - 1;
}

static void count_block(void *context, uint32_t block, unsigned thread) {
    BpGrid *grid = context;
    BpGridCell *cells = grid->cells + (size_t)thread * BP_GRID_CELLS_MAX;
    uint32_t first;
    const uint32_t count = bp_grid_block(grid, block, &first);
    for (uint32_t i = first; i < first + count; ++i) {
        const float *c = grid->items[i].center;
        const uint32_t x = column_of(grid, 0, c[0]), y = column_of(grid, 1, c[1]),
                       z = column_of(grid, 2, c[2]);
        const uint32_t cell = (z * grid->columns[1] + y) * grid->columns[0] + x;
        grid->cell_of[i] = (uint16_t)cell;
        ++cells[cell].count;
        bp_tree_box_add_item(&cells[cell].box, &grid->items[i]);
    }
}

bool bp_grid_fill(BpGrid *grid, const BpTreeItem *items, uint32_t count, BpThreadPool *pool) {
    const unsigned threads = bp_thread_pool_size(pool);
    if (!make_room(grid, count, threads)) return false;
    grid->items = items;
    grid->count = count;
    grid->block_size = count / BP_GRID_BLOCKS_MAX + 1;
    if (grid->block_size < BLOCK_MIN) grid->block_size = BLOCK_MIN;
    grid->block_count = (count + grid->block_size - 1) / grid->block_size;
    bp_parallel_for(pool, bound_block, grid, grid->block_count);
    lay(grid);
    bp_parallel_for(pool, clear_cells, grid, threads);
    bp_parallel_for(pool, count_block, grid, grid->block_count);
    for (unsigned w = 1; w < threads; ++w)
        for (uint32_t c = 0; c < grid->cell_count; ++c) {
            const BpGridCell *cell = &grid->cells[(size_t)w * BP_GRID_CELLS_MAX + c];
            grid->cells[c].count += cell->count;
            bp_tree_box_add(&grid->cells[c].box, &cell->box);
        }
    grid->used_count = 0;
    for (uint32_t c = 0; c < grid->cell_count; ++c) {
        BpGridCell *cell = &grid->cells[c];
        if (cell->count == 0) continue;
        cell->at[0] = (uint16_t)(c % grid->columns[0]);
        cell->at[1] = (uint16_t)(c / grid->columns[0] % grid->columns[1]);
        cell->at[2] = (uint16_t)(c / grid->columns[0] / grid->columns[1]);
        grid->used[grid->used_count++] = c;
    }
    return true;
}

/* ---- planes ---------------------------------------------------------------------------------------- */

static uint32_t bin_of(const BpGridCell *cell, const BpGridPlane *plane) {
    return (cell->at[plane->axis] - plane->low) * plane->bins / plane->span;
}

BpGridPlane bp_grid_plane(const BpGrid *grid, const uint32_t *cells, uint32_t cell_count, uint32_t items,
                          uint32_t width, uint64_t side_max) {
    static const BpTreeBox empty = BP_TREE_BOX_EMPTY;
    const uint32_t width_bits = bp_tree_width_bits(width);
    BpGridPlane best = {.axis = -1};
    float best_cost = INFINITY;
    for (int a = 0; a < 3; ++a) {
        uint32_t low = UINT32_MAX, high = 0;
        for (uint32_t c = 0; c < cell_count; ++c) {
            const uint32_t at = grid->cells[cells[c]].at[a];
            low = at < low ? at : low;
            high = at > high ? at : high;
        }
        if (low == high) continue;
        BpGridPlane plane = {.axis = a, .low = low, .span = high - low + 1};
        plane.bins = plane.span < PLANES ? plane.span : PLANES;
        BpTreeBox boxes[PLANES];
        uint32_t counts[PLANES] = {0};
        for (int b = 0; b < PLANES; ++b) boxes[b] = empty;
        for (uint32_t c = 0; c < cell_count; ++c) {
            const BpGridCell *cell = &grid->cells[cells[c]];
            const uint32_t b = bin_of(cell, &plane);
            counts[b] += cell->count;
            bp_tree_box_add(&boxes[b], &cell->box);
        }
        float cost_right[PLANES];
        BpTreeBox box = empty;
        uint32_t n = 0;
        for (uint32_t b = plane.bins - 1; b > 0; --b) {
            bp_tree_box_add(&box, &boxes[b]);
            n += counts[b];
            cost_right[b] = bp_tree_box_half_area(&box) * bp_tree_run_cost(n, width_bits);
        }
        box = empty;
        n = 0;
        for (uint32_t b = 1; b < plane.bins; ++b) {
            bp_tree_box_add(&box, &boxes[b - 1]);
            n += counts[b - 1];
            const float cost = bp_tree_box_half_area(&box) * bp_tree_run_cost(n, width_bits) + cost_right[b];
            if (n > 0 && n < items && n <= side_max && items - n <= side_max && cost < best_cost) {
                best_cost = cost;
                best = plane;
                best.bin = b;
            }
        }
    }
    return best;
}

uint32_t bp_grid_part(const BpGrid *grid, uint32_t *cells, uint32_t cell_count, const BpGridPlane *plane) {
    uint32_t left = 0;
    for (uint32_t c = 0; c < cell_count; ++c)
        if (bin_of(&grid->cells[cells[c]], plane) < plane->bin) {
            const uint32_t cell = cells[c];
            cells[c] = cells[left];
            cells[left++] = cell;
        }
    return left;
}
