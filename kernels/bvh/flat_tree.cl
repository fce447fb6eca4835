/* flat_tree.cl: the leaves of a small tree in a row, for packets: to test the boxes of all leaves is then faster than a
 * walk.
 *
 * In:    packed nodes.   Out: leaves and their boxes, the work-item's own copy.
 * Knows: scene_types.h.   Does not know: rays. */
#if ACCELERATION_TREE
#define BATCH_LEAVES 32u /* one bit each */
#define BATCHES_MAX 3u

/* Some leaves and their boxes. */
typedef struct FlatBatch {
    uint count;
    uint leaf[BATCH_LEAVES];
    /* Rows as in a node: low x, y, z, high x, y, z of TREE_WIDTH boxes; 0 where there is no box. */
    JOIN(REAL, TREE_WIDTH) planes[BATCH_LEAVES / TREE_WIDTH][6];
} FlatBatch;

typedef struct FlatTree {
    uint batch_count; /* 0: the tree has too many leaves */
    FlatBatch batches[BATCHES_MAX];
} FlatTree;

/* `wanted`: how many leaves the nodes have. */
static void flatten_tree(__global const real *boxes, __global const uint *children, uint wanted, FlatTree *flat) {
    flat->batch_count = 0;
    if (wanted > BATCHES_MAX * BATCH_LEAVES) return;
    uint count = 0;
    for (uint node = 0; count < wanted; ++node) {
        for (uint lane = 0; lane < TREE_WIDTH; ++lane) {
            __global const real *plane = boxes + node * (6 * TREE_WIDTH) + lane;
            const uint child = children[node * TREE_WIDTH + lane];
            if ((child & CHILD_LEAF) == 0 || plane[0] > plane[3 * TREE_WIDTH]) continue;
            FlatBatch *batch = &flat->batches[count / BATCH_LEAVES];
            const uint place = count % BATCH_LEAVES;
            real *own_plane = (real *)batch->planes[place / TREE_WIDTH] + place % TREE_WIDTH;
            if (place % TREE_WIDTH == 0)
                for (uint row = 0; row < 6; ++row) batch->planes[place / TREE_WIDTH][row] = (JOIN(REAL, TREE_WIDTH))(0);
            batch->leaf[place] = child & ~CHILD_LEAF;
            for (uint row = 0; row < 6; ++row) own_plane[row * TREE_WIDTH] = plane[row * TREE_WIDTH];
            batch->count = place + 1;
            ++count;
        }
    }
    flat->batch_count = (wanted + BATCH_LEAVES - 1) / BATCH_LEAVES;
}
#endif
