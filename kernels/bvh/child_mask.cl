/* child_mask.cl: which of the TREE_WIDTH children of a node, or spheres of a leaf, as the low bits of one integer.
 *
 * Made by lane_bits (lanes.cl), and taken apart bit by bit, lowest first. Does not know: nodes, leaves. */
typedef uint child_mask;

/* The number of zeros below the lowest bit, 32 for no bit. Compilers know this form and have an instruction for it. */
static uint lowest_bit(child_mask mask) { return popcount(~mask & (mask - 1u)); }
static child_mask without_lowest_bit(child_mask mask) { return mask & (mask - 1u); }
static child_mask without_bit(child_mask mask, uint bit) { return mask & ~((child_mask)1 << bit); }
