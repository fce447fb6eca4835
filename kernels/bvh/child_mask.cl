/* child_mask.cl: some of the TREE_WIDTH children of a node, or spheres of a leaf, as the low bits of one integer.
 *
 * lane_bits makes a mask; these functions take it apart bit by bit, the lowest first.
 * Knows: lanes.cl.   Does not know: nodes, leaves. */
typedef uint child_mask;

/* The number of zeros below the lowest bit, 32 for no bit. Compilers know this form and have an instruction for it. */
static uint lowest_bit(child_mask mask) { return popcount(~mask & (mask - 1u)); }
static child_mask without_lowest_bit(child_mask mask) { return mask & (mask - 1u); }
static child_mask without_bit(child_mask mask, uint bit) { return mask & ~((child_mask)1 << bit); }
