/* geometry.cl: the spheres of the scene and the tree above them, as packed tables.
 *
 * Knows: scene_types.h.   Does not know: rays, materials. */

/* For the lists of arrays in scene_types.h: a member of a struct, a parameter and an argument with its comma. */
#define ARRAY_MEMBER(numbers, element, name, count, what) __global const element *name;
#define ARRAY_PARAMETER(numbers, element, name, count, what) __global const element *name,
#define ARRAY_ARGUMENT(numbers, element, name, count, what) name,

typedef struct Geometry {
    SCENE_ARRAYS_OF_TREE(ARRAY_MEMBER)
    uint first_leaves; /* the leaves of spheres so large that most rays meet them; without a tree, all */
    uint leaf_count;
#ifdef BATCH_LEAVES
    FlatTree flat;
#endif
} Geometry;

static void geometry_init(SCENE_ARRAYS_OF_TREE(ARRAY_PARAMETER) uint first_leaves, uint leaf_count,
                          Geometry *geometry) {
#define SET_ARRAY(numbers, element, name, count, what) geometry->name = name;
    SCENE_ARRAYS_OF_TREE(SET_ARRAY)
#undef SET_ARRAY
    geometry->first_leaves = first_leaves;
    geometry->leaf_count = leaf_count;
#ifdef BATCH_LEAVES
    flatten_tree(node_boxes, children, leaf_count - first_leaves, &geometry->flat);
#endif
}
