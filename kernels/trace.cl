/* trace.cl: the bounce loop, in lane code, and the kernel around it.
 *
 * In:    the packed scene; a chunk: a range of pixels (or of a list of pixels) times a range of samples.
 * Out:   for each pixel sample its radiance, and in a fourth number the ray segments traced, plus 1/2 for a path
 *        that the depth cap cut.
 *
 * One lane: a work-item traces one pixel sample. Eight lanes: a work-item takes `samples_per_item` pixel samples of
 * the chunk, eight at a time; a lane whose path has ended takes the next. What is computed for a pixel sample
 * depends on neither. */

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

/* Sets the lanes of `fresh` to the beginning of the path of their pixel sample; row and column are whole numbers. */
static void begin_paths(__global const PackedCamera *camera, uint pixel_center, SampleKey key, reals column, reals row,
                        masks fresh, Paths *paths) {
    Vec3 origin, direction;
    camera_ray(camera, pixel_center, key, column, row, &origin, &direction);
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

__kernel void trace(SCENE_PARAMETERS, uint first_pixel, uint first_sample, uint samples_per_pixel, uint sample_count,
                    uint samples_per_item, __global real *samples PIXEL_LIST_PARAMETER) {
    const Scene scene = begin_scene(SCENE_ARGUMENTS);
    const uint item = get_global_id(0);
    uint next = item * samples_per_item;
    const uint end = min(next + samples_per_item, sample_count);
    if (next >= end) return;
    /* The pixel sample that `next` stands for. */
    Pixel pixel = pixel_of_chunk(first_pixel, next / samples_per_pixel, sample_count / samples_per_pixel,
                                 width PIXEL_LIST_ARGUMENT);
    uint sample = next % samples_per_pixel;

    Paths paths;
    paths.alive = splat(0) != splat(0);
    paths.depth = splat_uint(0);
    paths.radiance = zero3();
    masks cut = paths.alive;      /* lanes whose path the cap has ended, black for what is missing */
    uints number = splat_uint(0); /* of a lane's pixel sample within the chunk */
    const uint lanes = min((uint)LANE_COUNT, end - next); /* that ever have one */
    uint used = 0;
    for (;;) {
        const masks reached = paths.alive & mask_of_uint(paths.depth >= splat_uint(max_depth));
        cut = cut | reached;
        paths.alive = paths.alive & not_mask(reached);

        /* Once half of the lanes are free: results out, the next pixel samples in. */
        const uint alive = popcount(set_of_lanes(paths.alive));
        if (alive == 0 || (alive <= LANE_COUNT / 2 && next < end)) {
            real red[LANE_COUNT], green[LANE_COUNT], blue[LANE_COUNT], count[LANE_COUNT];
            uint place[LANE_COUNT];
            store_lanes(paths.radiance.x, red);
            store_lanes(paths.radiance.y, green);
            store_lanes(paths.radiance.z, blue);
            store_lanes(uint_to_reals(paths.depth) + choose(cut, splat(R(0.5)), splat(0)), count);
            store_lanes(number, place);
            /* Of a path that goes on this is not the last word, but its place is its own, and to ask costs more. */
            for (uint lane = 0; lane < used; ++lane)
                vstore4((real4)(red[lane], green[lane], blue[lane], count[lane]), place[lane], samples);
            if (next >= end) return;
            used = lanes;
            /* The free lanes take the next pixel samples, the lowest lane first. */
            const uint free = set_of_lanes(not_mask(paths.alive));
            const uints rank = popcount(splat_uint(free) & RANK_BITS);
            const masks fresh = not_mask(paths.alive) & mask_of_uint(rank < splat_uint(end - next));
            number = choose_uint(fresh, next + rank, number);
            uints sample_number = sample + rank, ahead = splat_uint(0);
            carry_over(&sample_number, samples_per_pixel, &ahead);
            const Pixels pixels = pixels_ahead(&pixel, ahead, width);
            const uint taken = min((uint)popcount(free), end - next);
            next += taken;
            for (sample += taken; sample >= samples_per_pixel; sample -= samples_per_pixel) next_pixel(&pixel, width);
            const SampleKey key = sample_key(seed_low, seed_high, pixels.row * width + pixels.column,
                                             first_sample + sample_number, replicates);
            begin_paths(camera, pixel_center, key, uint_to_reals(pixels.column), uint_to_reals(pixels.row), fresh,
                        &paths);
            cut = cut & not_mask(fresh);
            continue; /* a cap of 0 cuts at once */
        }
        advance(&scene, &paths);
    }
}
