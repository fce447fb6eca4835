/* scene.cl: the packed scene as a kernel gets it, and as the functions that read it want it.
 *
 * In:    the arguments of a kernel that traces.   Out: a Scene.
 * Knows: the lists of scene_types.h, geometry.cl.   Does not know: paths. */
typedef struct Scene {
    Geometry geometry;
    uint max_depth; /* ray segments of a path */
    SCENE_ARRAYS_OF_PACK(ARRAY_MEMBER)
    SCENE_ARRAYS_OF_FOCUSERS(ARRAY_MEMBER)
    SCENE_ARRAYS_OF_SLOTS(SPLIT_MEMBER)
    SCENE_ARRAYS_OF_LAMPS(SPLIT_MEMBER)
#if EFFECT_TRIANGLES
    uint coloured_slots;
#endif
} Scene;

#if EFFECT_TRIANGLES
#define COLOURS_PARAMETER uint coloured_slots,
#define COLOURS_ARGUMENT coloured_slots,
#else
#define COLOURS_PARAMETER
#define COLOURS_ARGUMENT
#endif

/* What every kernel that traces is told, each followed by a comma; scene_init and path_init_from_camera take it
 * apart. */
#define NUMBER_PARAMETER(name) uint name,
#define SCENE_PARAMETERS                                                                                               \
    SCENE_ARRAYS_OF_PACK(ARRAY_PARAMETER) SCENE_ARRAYS_OF_FOCUSERS(ARRAY_PARAMETER) SCENE_ARRAYS_OF_SLOTS(SPLIT_PARAMETER)                                       \
    SCENE_ARRAYS_OF_LAMPS(SPLIT_PARAMETER) SCENE_ARRAYS_OF_TREE(SPLIT_PARAMETER) CAPSULES_PARAMETERS TRIANGLES_PARAMETERS COLOURS_PARAMETER SCENE_NUMBERS(NUMBER_PARAMETER)
#define NUMBER_ARGUMENT(name) name,
/* All of them, for a function that takes the same. */
#define SCENE_NAMES                                                                                                    \
    SCENE_ARRAYS_OF_PACK(ARRAY_ARGUMENT) SCENE_ARRAYS_OF_FOCUSERS(ARRAY_ARGUMENT) SCENE_ARRAYS_OF_SLOTS(SPLIT_ARGUMENT)                                         \
    SCENE_ARRAYS_OF_LAMPS(SPLIT_ARGUMENT) SCENE_ARRAYS_OF_TREE(SPLIT_ARGUMENT) CAPSULES_ARGUMENTS TRIANGLES_ARGUMENTS COLOURS_ARGUMENT SCENE_NUMBERS(NUMBER_ARGUMENT)
#define SCENE_ARGUMENTS                                                                                                \
    SCENE_ARRAYS_OF_PACK(ARRAY_ARGUMENT) SCENE_ARRAYS_OF_FOCUSERS(ARRAY_ARGUMENT) SCENE_ARRAYS_OF_SLOTS(SPLIT_ARGUMENT)                                         \
    SCENE_ARRAYS_OF_LAMPS(SPLIT_ARGUMENT) SCENE_ARRAYS_OF_TREE(SPLIT_ARGUMENT) CAPSULES_ARGUMENTS TRIANGLES_ARGUMENTS COLOURS_ARGUMENT first_leaves, leaf_count, max_depth

static Scene scene_init(SCENE_ARRAYS_OF_PACK(ARRAY_PARAMETER) SCENE_ARRAYS_OF_FOCUSERS(ARRAY_PARAMETER) SCENE_ARRAYS_OF_SLOTS(SPLIT_PARAMETER)
                            SCENE_ARRAYS_OF_LAMPS(SPLIT_PARAMETER) SCENE_ARRAYS_OF_TREE(SPLIT_PARAMETER) CAPSULES_PARAMETERS TRIANGLES_PARAMETERS COLOURS_PARAMETER uint first_leaves,
                        uint leaf_count, uint max_depth) {
    Scene scene;
    scene.max_depth = max_depth;
    geometry_init(SCENE_ARRAYS_OF_TREE(SPLIT_ARGUMENT) CAPSULES_ARGUMENTS TRIANGLES_ARGUMENTS first_leaves, leaf_count, &scene.geometry);
#define SET_ARRAY(numbers, element, name, count, what) scene.name = name;
    SCENE_ARRAYS_OF_PACK(SET_ARRAY)
    SCENE_ARRAYS_OF_FOCUSERS(SET_ARRAY)
#undef SET_ARRAY
#define SET_ARRAY(numbers, element, name, count, what) SET_SPLIT(&scene, name)
    SCENE_ARRAYS_OF_LAMPS(SET_ARRAY)
    SCENE_ARRAYS_OF_SLOTS(SET_ARRAY)
#undef SET_ARRAY
#if EFFECT_TRIANGLES
    scene.coloured_slots = coloured_slots;
#endif
#if EFFECT_OPACITY
    scene.geometry.materials = materials;
#endif
#if GLASS_TRIANGLES
    scene.geometry.material_kinds = material_kinds;
#endif
#if EFFECT_OPACITY || GLASS_TRIANGLES
    SET_SPLIT(&scene.geometry, slot_material)
#endif
#if MEDIA_IN_TRIANGLES
    scene.geometry.bodies = boundaries[2];
#endif
    return scene;
}
