/* bounce.cl: how paths begin and how they go on by one segment, in lane code.
 *
 * The kernel around it is in trace_sample.cl or trace_packet.cl. Both are given the packed scene and a chunk: a range
 * of pixels (or of a list of pixels) times a range of samples. Both write for each pixel sample of the chunk its
 * radiance, and in a fourth number the ray segments traced, plus 1/2 for a path that the depth cap cut. What is
 * computed for a pixel sample depends on neither of them. */

/* One segment of every living path: intersect, collect radiance, scatter. */
static void trace_bounce(const Scene *scene, Path *path) {
    const Hit hit = intersect_closest(scene, path);
    path->met = hit.met;
    path->entered = hit.enters;
    path->distance = hit.t;
    path->depth = choose_uint(path->alive, path->depth + 1u, path->depth);

    const vbool escaped = path->alive & vbool_not(hit.met);
    if (any_lane(escaped)) {
        const Vec3 light = multiply3(path->throughput, sky_radiance(scene->sky, path->direction));
        path->radiance = choose3(escaped, add3(path->radiance, light), path->radiance);
    }
    path->alive = path->alive & hit.met;
    if (!any_lane(path->alive)) return;

    Surface surface;
    Vec3 centre, outward, emitted;
    vreal radius;
    Point point;
    fetch_surface(scene, &hit, &centre, &radius, &surface, &emitted);
    surface_point(&path->origin, path->direction, hit.t, hit.enters, centre, radius, &point, &outward);
    /* A chord ends as far off its sphere as it began, and a little more. */
    const vbool own = vbool_of_uint(hit.slot == path->own_slot);
    point.error = choose(own, point.error + path->origin.error, point.error);
    surface.incoming = path->direction;
    surface.enters = hit.enters;
    surface.normal = choose3(hit.enters, outward, scale3(splat(-1), outward));
#if EFFECT_NORMALS
    const vbool shows_normal = has_kind(&surface, KIND_NORMALS);
    const Vec3 colour = vec3(fma(surface.normal.x, splat(R(0.5)), splat(R(0.5))),
                             fma(surface.normal.y, splat(R(0.5)), splat(R(0.5))),
                             fma(surface.normal.z, splat(R(0.5)), splat(R(0.5))));
    emitted = choose3(shows_normal, add3(emitted, colour), emitted);
#endif
#if EFFECT_EMISSION || EFFECT_NORMALS
    path->radiance = choose3(path->alive, add3(path->radiance, multiply3(path->throughput, emitted)),
                              path->radiance);
#endif
    const BsdfSample bsdf_sample = scatter(&surface, path->key, path->depth - 1u);
    path->throughput = multiply3(path->throughput, bsdf_sample.weight);
    path->direction = bsdf_sample.direction;
    path->origin = point;
    path->own_slot = hit.slot;
    /* Coming from outside and staying there, or from inside and going through: outside. */
    path->inward = (hit.enters & bsdf_sample.transmitted) | (vbool_not(hit.enters) & vbool_not(bsdf_sample.transmitted));
    path->alive = path->alive & bsdf_sample.scattered;
}

/* What every kernel that traces is told; scene_init and path_init_from_camera take it apart. */
#define SCENE_PARAMETERS                                                                                     \
    __global const PackedCamera *camera, __global const PackedSky *sky, __global const PackedMaterial *materials, \
        __global const PackedMaterialKind *kinds, __global const uint *slot_material,                         \
        __global const real *slot_albedo, __global const real *boxes, __global const uint *children,         \
        __global const real *leaves, __global const uint *slot_sphere, uint first_leaves, uint leaf_count,   \
        uint pixel_center, uint max_depth, uint seed_low, uint seed_high, uint replicates, uint width
#define SCENE_ARGUMENTS                                                                                      \
    sky, materials, kinds, slot_material, slot_albedo, boxes, children, leaves, slot_sphere, first_leaves, leaf_count

static Scene scene_init(__global const PackedSky *sky, __global const PackedMaterial *materials,
                         __global const PackedMaterialKind *kinds, __global const uint *slot_material,
                         __global const real *slot_albedo, __global const real *boxes, __global const uint *children,
                         __global const real *leaves, __global const uint *slot_sphere, uint first_leaves,
                         uint leaf_count) {
    Scene scene;
    scene.geometry.boxes = boxes;
    scene.geometry.children = children;
    scene.geometry.leaves = leaves;
    scene.geometry.slot_sphere = slot_sphere;
    scene.geometry.first_leaves = first_leaves;
    scene.geometry.leaf_count = leaf_count;
    scene.sky = sky;
    scene.materials = (__global const real *)materials;
    scene.kinds = (__global const uint *)kinds;
    scene.slot_material = slot_material;
    scene.slot_albedo = slot_albedo;
#if LANE_COUNT > 1 && EFFECT_TREE
    flatten_tree(&scene.geometry, &scene.flat);
#endif
    return scene;
}

/* Sets the lanes of `fresh` to the beginning of a path: a camera ray, and the key of its pixel sample. */
static void path_init(__global const PackedCamera *camera, SampleKey key, Vec3 origin, Vec3 direction, vbool fresh,
                    Path *path) {
    path->origin.high = choose3(fresh, origin, path->origin.high);
    path->origin.low = choose3(fresh, zero3(), path->origin.low);
    path->origin.error = choose(fresh, splat(camera->own_slot[2]), path->origin.error);
    path->direction = choose3(fresh, direction, path->direction);
    path->throughput = choose3(fresh, vec3(splat(1), splat(1), splat(1)), path->throughput);
    path->radiance = choose3(fresh, zero3(), path->radiance);
    path->key.a = choose_uint(fresh, key.a, path->key.a);
    path->key.b = choose_uint(fresh, key.b, path->key.b);
#if SAMPLER_SOBOL
    path->key.index_reversed = choose_uint(fresh, key.index_reversed, path->key.index_reversed);
    path->key.scramble_a = choose_uint(fresh, key.scramble_a, path->key.scramble_a);
    path->key.scramble_b = choose_uint(fresh, key.scramble_b, path->key.scramble_b);
#endif
    path->depth = choose_uint(fresh, splat_uint(0), path->depth);
    /* A camera that stands on a sphere leaves it like any other point of its surface. */
    const vbool inward = dot3(splat3(camera->inward), direction) > splat(0);
    const uint own_slot = (uint)camera->own_slot[0] | (uint)camera->own_slot[1] << 16;
    path->own_slot = choose_uint(fresh, splat_uint(own_slot), path->own_slot);
    path->inward = (fresh & inward) | (vbool_not(fresh) & path->inward);
    path->alive = path->alive | fresh;
}

/* The same for the pixel sample at a row and a column, whole numbers. */
static void path_init_from_camera(__global const PackedCamera *camera, uint pixel_center, SampleKey key, vreal column, vreal row,
                        vbool fresh, Path *path) {
    Vec3 origin, direction;
    camera_ray(camera, pixel_center, key, column, row, &origin, &direction);
    path_init(camera, key, origin, direction, fresh, path);
}

#define TRACE_PARAMETERS                                                                                     \
    SCENE_PARAMETERS, uint first_pixel, uint first_sample, uint samples_per_pixel, uint sample_count,            \
        __global real *samples PIXEL_LIST_PARAMETER
