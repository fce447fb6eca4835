/* tree_grid.h: a grid over many spheres, whose cells stand for them in the upper splits.
 *
 * In:    a run of items.
 * Out:   for every cell in use a count and a box; the cell of every item; the best plane.
 * Knows: the surface area heuristic, the thread pool.   Does not know: what becomes of a split. */
#ifndef BP_PACKED_TREE_GRID_H
#define BP_PACKED_TREE_GRID_H

#include "tree_binary.h"

#define BP_GRID_CELLS_MAX 32768u
#define BP_GRID_BLOCKS_MAX 256u

typedef struct BpGridCell {
    BpTreeBox box; /* around the spheres, which may stand out of the cell */
    uint32_t count;
    uint16_t at[3]; /* column, each axis */
} BpGridCell;

typedef struct BpGrid {
    BpGridCell *cells; /* BP_GRID_CELLS_MAX for each thread; the first so many are the whole */
    uint16_t *cell_of; /* of each item, in order */
    uint32_t cell_of_capacity;
    uint32_t *used; /* the cells that are not empty */
    uint32_t used_count;
    /* The items at hand, and the blocks in which threads take them. */
    const BpTreeItem *items;
    uint32_t count, block_size, block_count;
    BpTreeBox block_box[BP_GRID_BLOCKS_MAX]; /* around the centers */
    float low[3], scale[3];
    uint32_t columns[3], cell_count;
} BpGrid;

/* A plane across `axis`: a cell lies left of it if (at - low) * bins / span < bin. */
typedef struct BpGridPlane {
    int axis; /* < 0: none */
    uint32_t low, bins, span, bin;
} BpGridPlane;

/* Lays a grid over the items and counts them into its cells. `items` must outlive its use, and the thread
 * pool is the same for all uses. Zero a grid before the first. False: out of memory. */
bool bp_grid_fill(BpGrid *grid, const BpTreeItem *items, uint32_t count, BpThreadPool *pool);

void bp_grid_clear(BpGrid *grid);

/* Number of items in a block, the first of which is *first. */
uint32_t bp_grid_block(const BpGrid *grid, uint32_t block, uint32_t *first);

/* The cheapest plane through a set of cells with `items` items in all, among those that leave at most
 * `side_max` on either side. `width`: of the tree. */
BpGridPlane bp_grid_plane(const BpGrid *grid, const uint32_t *cells, uint32_t cell_count, uint32_t items,
                          uint32_t width, uint64_t side_max);

/* Moves the cells left of the plane to the front and returns their number. */
uint32_t bp_grid_part(const BpGrid *grid, uint32_t *cells, uint32_t cell_count, const BpGridPlane *plane);

#endif
