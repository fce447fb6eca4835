/* flat_tree.cl: the leaves of a small tree in a row, for packets: to test the boxes of all leaves is then faster than a
 * walk. They come in groups of TREE_WIDTH, in the order of their numbers, which is that of a walk. So a group is close
 * together, and a ray that misses the box around it misses all its leaves.
 *
 * In:    packed nodes.   Out: the boxes of leaves and of groups, the work-item's own copy.
 * Knows: scene_types.h.   Does not know: rays. */
#if ACCELERATION_TREE
#define FLAT_GROUPS_MAX (FLAT_LEAVES_MAX / TREE_WIDTH)

typedef struct FlatTree {
    uint leaf_count; /* 0: the tree has too many leaves */
    uint first_leaf; /* the others follow it */
    /* Rows as in a node: low x, y, z, high x, y, z of TREE_WIDTH boxes. Where there is no leaf, low is above high. */
    JOIN(REAL, TREE_WIDTH) planes[FLAT_GROUPS_MAX][6];
    real around[FLAT_GROUPS_MAX][6]; /* the box around each group */
} FlatTree;

/* `first_leaf`, `wanted`: which leaves the nodes have. */
static void flatten_tree(__global const real *boxes, __global const uint *children, uint first_leaf, uint wanted,
                         FlatTree *flat) {
    flat->leaf_count = wanted <= FLAT_LEAVES_MAX ? wanted : 0;
    flat->first_leaf = first_leaf;
    for (uint group = 0; group * TREE_WIDTH < flat->leaf_count; ++group)
        for (uint row = 0; row < 6; ++row) {
            flat->around[group][row] = row < 3 ? R(1e30) : R(-1e30);
            flat->planes[group][row] = (JOIN(REAL, TREE_WIDTH))(flat->around[group][row]);
        }
    uint count = 0;
    for (uint node = 0; count < flat->leaf_count; ++node) {
        for (uint lane = 0; lane < TREE_WIDTH; ++lane) {
            __global const real *plane = boxes + node * (6 * TREE_WIDTH) + lane;
            const uint child = children[node * TREE_WIDTH + lane];
            if ((child & CHILD_LEAF) == 0 || plane[0] > plane[3 * TREE_WIDTH]) continue;
            const uint place = (child & ~CHILD_LEAF) - first_leaf;
            real *own_plane = (real *)flat->planes[place / TREE_WIDTH] + place % TREE_WIDTH;
            real *around = flat->around[place / TREE_WIDTH];
            for (uint row = 0; row < 6; ++row) {
                const real side = plane[row * TREE_WIDTH];
                own_plane[row * TREE_WIDTH] = side;
                if (row < 3 ? side < around[row] : side > around[row]) around[row] = side;
            }
            ++count;
        }
    }
}
#endif
