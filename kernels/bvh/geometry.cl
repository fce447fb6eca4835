/* geometry.cl: the spheres of the scene and the tree above them, as packed tables.
 *
 * Knows: scene_types.h.   Does not know: rays, materials. */
typedef struct Geometry {
    __global const real *boxes;
    __global const uint *children;
    __global const real *leaves;
    __global const uint *slot_sphere;
    uint first_leaves; /* the leaves of spheres so large that most rays meet them; without a tree, all */
    uint leaf_count;
#ifdef BATCH_LEAVES
    FlatTree flat;
#endif
} Geometry;

static void geometry_init(__global const real *boxes, __global const uint *children, __global const real *leaves,
                          __global const uint *slot_sphere, uint first_leaves, uint leaf_count, Geometry *geometry) {
    geometry->boxes = boxes;
    geometry->children = children;
    geometry->leaves = leaves;
    geometry->slot_sphere = slot_sphere;
    geometry->first_leaves = first_leaves;
    geometry->leaf_count = leaf_count;
#ifdef BATCH_LEAVES
    flatten_tree(boxes, children, leaf_count - first_leaves, &geometry->flat);
#endif
}
