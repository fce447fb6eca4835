/* scene.cl: the packed scene as a kernel gets it, and as the functions that read it want it.
 *
 * In:    the arguments of a kernel that traces.   Out: a Scene.
 * Knows: scene_types.h, geometry.cl.   Does not know: paths. */
typedef struct Scene {
    Geometry geometry;
    __global const PackedSky *sky;
    __global const real *materials; /* PackedMaterial */
    __global const uint *kinds;     /* PackedMaterialKind */
    __global const uint *slot_material;
    __global const real *slot_albedo;
} Scene;

/* What every kernel that traces is told; scene_init and path_init_from_camera take it apart. */
#define SCENE_PARAMETERS                                                                                               \
    __global const PackedCamera *camera, __global const PackedSky *sky, __global const PackedMaterial *materials,      \
        __global const PackedMaterialKind *kinds, __global const uint *slot_material,                                  \
        __global const real *slot_albedo, __global const real *boxes, __global const uint *children,                   \
        __global const real *leaves, __global const uint *slot_sphere, uint first_leaves, uint leaf_count,             \
        uint pixel_center, uint max_depth, uint seed_low, uint seed_high, uint replicates, uint width
#define SCENE_ARGUMENTS                                                                                                \
    sky, materials, kinds, slot_material, slot_albedo, boxes, children, leaves, slot_sphere, first_leaves, leaf_count

static Scene scene_init(__global const PackedSky *sky, __global const PackedMaterial *materials,
                        __global const PackedMaterialKind *kinds, __global const uint *slot_material,
                        __global const real *slot_albedo, __global const real *boxes, __global const uint *children,
                        __global const real *leaves, __global const uint *slot_sphere, uint first_leaves,
                        uint leaf_count) {
    Scene scene;
    geometry_init(boxes, children, leaves, slot_sphere, first_leaves, leaf_count, &scene.geometry);
    scene.sky = sky;
    scene.materials = (__global const real *)materials;
    scene.kinds = (__global const uint *)kinds;
    scene.slot_material = slot_material;
    scene.slot_albedo = slot_albedo;
    return scene;
}
