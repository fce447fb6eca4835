/* geometry.cl: the spheres, triangles and capsules of the scene and the tree above them, as packed tables.
 *
 * Knows: scene_types.h, parts.cl.   Does not know: rays, what materials do with light. */

/* What a kernel that knows triangles is given of them, each followed by a comma. */
#if SMOOTH_TRIANGLES
#define NORMALS_PARAMETERS SCENE_ARRAYS_OF_NORMALS(SPLIT_PARAMETER)
#define NORMALS_ARGUMENTS SCENE_ARRAYS_OF_NORMALS(SPLIT_ARGUMENT)
#define NORMALS_PARAMETER uint normal_leaves,
#define NORMALS_ARGUMENT normal_leaves,
#else
#define NORMALS_PARAMETERS
#define NORMALS_ARGUMENTS
#define NORMALS_PARAMETER
#define NORMALS_ARGUMENT
#endif
#if MAPPED_TRIANGLES
#define COORDINATES_PARAMETERS SCENE_ARRAYS_OF_COORDINATES(SPLIT_PARAMETER)
#define COORDINATES_ARGUMENTS SCENE_ARRAYS_OF_COORDINATES(SPLIT_ARGUMENT)
#define COORDINATES_PARAMETER uint coordinate_leaves,
#define COORDINATES_ARGUMENT coordinate_leaves,
#else
#define COORDINATES_PARAMETERS
#define COORDINATES_ARGUMENTS
#define COORDINATES_PARAMETER
#define COORDINATES_ARGUMENT
#endif
#if EFFECT_TRIANGLES
#define TRIANGLES_PARAMETERS                                                                                           \
    SCENE_ARRAYS_OF_TRIANGLES(SPLIT_PARAMETER) NORMALS_PARAMETERS COORDINATES_PARAMETERS uint first_triangles,          \
        NORMALS_PARAMETER COORDINATES_PARAMETER
#define TRIANGLES_ARGUMENTS                                                                                            \
    SCENE_ARRAYS_OF_TRIANGLES(SPLIT_ARGUMENT) NORMALS_ARGUMENTS COORDINATES_ARGUMENTS first_triangles, NORMALS_ARGUMENT \
        COORDINATES_ARGUMENT
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
#if MAPPED_TRIANGLES
    SCENE_ARRAYS_OF_COORDINATES(SPLIT_MEMBER)
    uint coordinate_leaves; /* 0: no texture lies on a triangle */
#endif
#if EFFECT_CAPSULES
    SCENE_ARRAYS_OF_CAPSULES(SPLIT_MEMBER)
#endif
#if EFFECT_OPACITY
    __global const real *materials; /* for what surfaces let straight on */
#endif
#if GLASS_TRIANGLES
    __global const packed_uint *material_kinds; /* for which triangles are glass; 0: none is */
#endif
#if EFFECT_OPACITY || GLASS_TRIANGLES
    SPLIT_MEMBER(UINTS, packed_uint, slot_material, slots, "the table of sphere materials")
#endif
#if MEDIA_IN_TRIANGLES
    uint bodies; /* of triangles that light passes into: it may go on straight through a vertex of one */
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
#if MAPPED_TRIANGLES
    SCENE_ARRAYS_OF_COORDINATES(SET_ARRAY)
    geometry->coordinate_leaves = coordinate_leaves;
#endif
#if EFFECT_CAPSULES
    SCENE_ARRAYS_OF_CAPSULES(SET_ARRAY)
#endif
#undef SET_ARRAY
#if MEDIA_IN_TRIANGLES
    geometry->bodies = 0;
#endif
#if GLASS_TRIANGLES
    geometry->material_kinds = 0;
#endif
    geometry->first_leaves = first_leaves;
    geometry->leaf_count = leaf_count;
#if defined(FLAT_GROUPS_MAX) && defined(SCENE_PARTS)
    geometry->flat.leaf_count = 0; /* the tree is too large */
#elif defined(FLAT_GROUPS_MAX)
    flatten_tree(node_boxes, children, first_leaves, leaf_count - first_leaves, &geometry->flat);
#endif
}
