/* bounce.cl: how paths begin and how they go on by one segment, in lane code.
 *
 * The kernel around it is in trace_sample.cl or trace_packet.cl. Both are given the packed scene and a chunk: a range
 * of pixels (or of a list of pixels) times a range of samples. Both write for each pixel sample of the chunk its
 * radiance, and in a fourth number the ray segments traced, plus 1/2 for a path that the depth cap cut. What is
 * computed for a pixel sample depends on neither of them. */

/* One segment of every living path: intersect, collect radiance, scatter. */
static void advance(const Scene *scene, Paths *paths) {
    const Meeting meeting = meet(scene, paths);
    paths->met = meeting.met;
    paths->entered = meeting.enters;
    paths->distance = meeting.t;
    paths->depth = choose_uint(paths->alive, paths->depth + 1u, paths->depth);

    const masks escaped = paths->alive & not_mask(meeting.met);
    if (any_lane(escaped)) {
        const Vec3 light = multiply3(paths->throughput, sky_radiance(scene->sky, paths->direction));
        paths->radiance = choose3(escaped, add3(paths->radiance, light), paths->radiance);
    }
    paths->alive = paths->alive & meeting.met;
    if (!any_lane(paths->alive)) return;

    Surface surface;
    Vec3 centre, outward, emitted;
    reals radius;
    Point point;
    look_up(scene, &meeting, &centre, &radius, &surface, &emitted);
    surface_point(&paths->origin, paths->direction, meeting.t, meeting.enters, centre, radius, &point, &outward);
    /* A chord ends as far off its sphere as it began, and a little more. */
    const masks own = mask_of_uint(meeting.slot == paths->own_slot);
    point.slack = choose(own, point.slack + paths->origin.slack, point.slack);
    surface.incoming = paths->direction;
    surface.enters = meeting.enters;
    surface.normal = choose3(meeting.enters, outward, scale3(splat(-1), outward));
#if EFFECT_NORMALS
    const masks shows_normal = has_kind(&surface, KIND_NORMALS);
    const Vec3 colour = vec3(fma(surface.normal.x, splat(R(0.5)), splat(R(0.5))),
                             fma(surface.normal.y, splat(R(0.5)), splat(R(0.5))),
                             fma(surface.normal.z, splat(R(0.5)), splat(R(0.5))));
    emitted = choose3(shows_normal, add3(emitted, colour), emitted);
#endif
#if EFFECT_EMISSION || EFFECT_NORMALS
    paths->radiance = choose3(paths->alive, add3(paths->radiance, multiply3(paths->throughput, emitted)),
                              paths->radiance);
#endif
    const Scattering scattering = scatter(&surface, paths->key, paths->depth - 1u);
    paths->throughput = multiply3(paths->throughput, scattering.weight);
    paths->direction = scattering.direction;
    paths->origin = point;
    paths->own_slot = meeting.slot;
    /* Coming from outside and staying there, or from inside and going through: outside. */
    paths->inward = (meeting.enters & scattering.refracted) | (not_mask(meeting.enters) & not_mask(scattering.refracted));
    paths->alive = paths->alive & scattering.goes_on;
}

/* What every kernel that traces is told; begin_scene and begin_paths take it apart. */
#define SCENE_PARAMETERS                                                                                     \
    __global const PackedCamera *camera, __global const PackedSky *sky, __global const PackedMaterial *materials, \
        __global const PackedMaterialKind *kinds, __global const uint *slot_material,                         \
        __global const real *slot_albedo, __global const real *boxes, __global const uint *children,         \
        __global const real *leaves, __global const uint *slot_sphere, uint first_leaves, uint leaf_count,   \
        uint pixel_center, uint max_depth, uint seed_low, uint seed_high, uint replicates, uint width
#define SCENE_ARGUMENTS                                                                                      \
    sky, materials, kinds, slot_material, slot_albedo, boxes, children, leaves, slot_sphere, first_leaves, leaf_count

static Scene begin_scene(__global const PackedSky *sky, __global const PackedMaterial *materials,
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
static void set_out(__global const PackedCamera *camera, SampleKey key, Vec3 origin, Vec3 direction, masks fresh,
                    Paths *paths) {
    paths->origin.high = choose3(fresh, origin, paths->origin.high);
    paths->origin.low = choose3(fresh, zero3(), paths->origin.low);
    paths->origin.slack = choose(fresh, splat(camera->own_slot[2]), paths->origin.slack);
    paths->direction = choose3(fresh, direction, paths->direction);
    paths->throughput = choose3(fresh, vec3(splat(1), splat(1), splat(1)), paths->throughput);
    paths->radiance = choose3(fresh, zero3(), paths->radiance);
    paths->key.a = choose_uint(fresh, key.a, paths->key.a);
    paths->key.b = choose_uint(fresh, key.b, paths->key.b);
#if SAMPLER_SOBOL
    paths->key.index_reversed = choose_uint(fresh, key.index_reversed, paths->key.index_reversed);
    paths->key.scramble_a = choose_uint(fresh, key.scramble_a, paths->key.scramble_a);
    paths->key.scramble_b = choose_uint(fresh, key.scramble_b, paths->key.scramble_b);
#endif
    paths->depth = choose_uint(fresh, splat_uint(0), paths->depth);
    /* A camera that stands on a sphere leaves it like any other point of its surface. */
    const masks inward = dot3(splat3(camera->inward), direction) > splat(0);
    const uint own_slot = (uint)camera->own_slot[0] | (uint)camera->own_slot[1] << 16;
    paths->own_slot = choose_uint(fresh, splat_uint(own_slot), paths->own_slot);
    paths->inward = (fresh & inward) | (not_mask(fresh) & paths->inward);
    paths->alive = paths->alive | fresh;
}

/* The same for the pixel sample at a row and a column, whole numbers. */
static void begin_paths(__global const PackedCamera *camera, uint pixel_center, SampleKey key, reals column, reals row,
                        masks fresh, Paths *paths) {
    Vec3 origin, direction;
    camera_ray(camera, pixel_center, key, column, row, &origin, &direction);
    set_out(camera, key, origin, direction, fresh, paths);
}

#define TRACE_PARAMETERS                                                                                     \
    SCENE_PARAMETERS, uint first_pixel, uint first_sample, uint samples_per_pixel, uint sample_count,            \
        __global real *samples PIXEL_LIST_PARAMETER
