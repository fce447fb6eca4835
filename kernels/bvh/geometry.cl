/* geometry.cl: the spheres, triangles and capsules of the scene and the tree above them, as packed tables.
 *
 * Knows: scene_types.h, parts.cl.   Does not know: rays, materials. */

/* What a kernel that knows triangles is given of them, each followed by a comma. */
#if SMOOTH_TRIANGLES
#define TRIANGLES_PARAMETERS                                                                                           \
    SCENE_ARRAYS_OF_TRIANGLES(SPLIT_PARAMETER) SCENE_ARRAYS_OF_NORMALS(SPLIT_PARAMETER) uint first_triangles, uint normal_leaves,
#define TRIANGLES_ARGUMENTS                                                                                            \
    SCENE_ARRAYS_OF_TRIANGLES(SPLIT_ARGUMENT) SCENE_ARRAYS_OF_NORMALS(SPLIT_ARGUMENT) first_triangles, normal_leaves,
#elif EFFECT_TRIANGLES
#define TRIANGLES_PARAMETERS SCENE_ARRAYS_OF_TRIANGLES(SPLIT_PARAMETER) uint first_triangles,
#define TRIANGLES_ARGUMENTS SCENE_ARRAYS_OF_TRIANGLES(SPLIT_ARGUMENT) first_triangles,
#endif
#if EFFECT_TRIANGLES
#define WITH_SHEAR(shear) shear,
#else
#define TRIANGLES_PARAMETERS
#define TRIANGLES_ARGUMENTS
#define WITH_SHEAR(shear)
#endif

/* The same of capsules. */
#if EFFECT_CAPSULES
#define CAPSULES_PARAMETERS SCENE_ARRAYS_OF_CAPSULES(SPLIT_PARAMETER)
#define CAPSULES_ARGUMENTS SCENE_ARRAYS_OF_CAPSULES(SPLIT_ARGUMENT)
#else
#define CAPSULES_PARAMETERS
#define CAPSULES_ARGUMENTS
#endif

typedef struct Geometry {
    SCENE_ARRAYS_OF_TREE(SPLIT_MEMBER)
    uint first_leaves; /* the leaves of spheres so large that most rays meet them; without a tree, all */
    uint leaf_count;
#if EFFECT_TRIANGLES
    SCENE_ARRAYS_OF_TRIANGLES(SPLIT_MEMBER)
    uint first_triangles; /* the leaves from here on hold triangles */
#endif
#if SMOOTH_TRIANGLES
    SCENE_ARRAYS_OF_NORMALS(SPLIT_MEMBER)
    uint normal_leaves; /* 0: no triangle is smooth */
#endif
#if EFFECT_CAPSULES
    SCENE_ARRAYS_OF_CAPSULES(SPLIT_MEMBER)
#endif
#ifdef FLAT_GROUPS_MAX
    FlatTree flat;
#endif
} Geometry;

static void geometry_init(SCENE_ARRAYS_OF_TREE(SPLIT_PARAMETER) CAPSULES_PARAMETERS TRIANGLES_PARAMETERS uint first_leaves, uint leaf_count,
                          Geometry *geometry) {
#define SET_ARRAY(numbers, element, name, count, what) SET_SPLIT(geometry, name)
    SCENE_ARRAYS_OF_TREE(SET_ARRAY)
#if EFFECT_TRIANGLES
    SCENE_ARRAYS_OF_TRIANGLES(SET_ARRAY)
    geometry->first_triangles = first_triangles;
#endif
#if SMOOTH_TRIANGLES
    SCENE_ARRAYS_OF_NORMALS(SET_ARRAY)
    geometry->normal_leaves = normal_leaves;
#endif
#if EFFECT_CAPSULES
    SCENE_ARRAYS_OF_CAPSULES(SET_ARRAY)
#endif
#undef SET_ARRAY
    geometry->first_leaves = first_leaves;
    geometry->leaf_count = leaf_count;
#if defined(FLAT_GROUPS_MAX) && defined(SCENE_PARTS)
    geometry->flat.leaf_count = 0; /* the tree is too large */
#elif defined(FLAT_GROUPS_MAX)
    flatten_tree(node_boxes, children, first_leaves, leaf_count - first_leaves, &geometry->flat);
#endif
}
