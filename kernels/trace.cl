/* trace.cl: the bounce loop, in lane code, and the kernel around it.
 *
 * In:    the packed scene; a chunk: a range of pixels times a range of samples.
 * Out:   for each pixel sample its radiance, and in a fourth number the ray segments traced, plus 1/2 for a path
 *        that the depth cap cut.
 *
 * One lane: a work-item traces one pixel sample. Eight lanes: a work-item takes `samples_per_item` pixel samples of
 * the chunk, eight at a time; a lane whose path has ended takes the next. What is computed for a pixel sample
 * depends on neither. */

typedef struct Scene {
    Geometry geometry;
    __global const PackedSky *sky;
    __global const real *materials; /* PackedMaterial */
    __global const uint *kinds;     /* PackedMaterialKind */
    __global const uint *looks;     /* PackedSphereLook */
    __global const real *albedos;
} Scene;

/* The packed structs as the gathers see them: arrays of their only type. */
#define LOOK_UINTS ((uint)(sizeof(PackedSphereLook) / sizeof(uint)))
#define MATERIAL_UINTS ((uint)(sizeof(PackedMaterialKind) / sizeof(uint)))
#define MATERIAL_REALS ((uint)(sizeof(PackedMaterial) / sizeof(real)))
#define MATERIAL_EMIT 4u
#define MATERIAL_FUZZ 8u
#define MATERIAL_INDEX 9u

/* The paths that a work-item follows, one a lane. */
typedef struct Paths {
    Point origin;
    Vec3 direction;
    Vec3 throughput, radiance;
    SampleKey key;
    uints depth;   /* ray segments traced */
    uints own_slot;
    masks inward;
    masks alive;
    /* Of the latest segment, for follow.cl. */
    masks met, entered;
    refineds distance;
} Paths;

/* What the paths meet, gathered lane by lane. */
typedef struct Meeting {
    refineds t;
    masks met, enters;
    uints slot;
} Meeting;

#if LANE_COUNT > 1
/* The leaves before the tree (all of them, in a list): one sphere at a time against all lanes. The margin is that of
 * test_leaf in tree.cl. */
static void meet_first_leaves(const Geometry *geometry, const Paths *paths, Meeting *meeting) {
    const Point *origin = &paths->origin;
    const Vec3 direction = paths->direction;
#if NUMERICS_ROBUST
    const reals ray_margin = fma(fabs(origin->high.x) + fabs(origin->high.y) + fabs(origin->high.z),
                                 splat(R(4.0) * ROUNDOFF), origin->slack);
#endif
    uints best_sphere = splat_uint(NO_SPHERE);
    for (uint slot = 0; slot < geometry->first_leaves * TREE_WIDTH; ++slot) {
        const uint lane = slot % TREE_WIDTH;
        __global const real *leaf = geometry->leaves + (slot - lane) * 4;
        if (leaf[3 * TREE_WIDTH + lane] <= 0) continue;
        const reals radius = splat(leaf[3 * TREE_WIDTH + lane]);
        const Vec3 centre = vec3(splat(leaf[lane]), splat(leaf[TREE_WIDTH + lane]), splat(leaf[2 * TREE_WIDTH + lane]));
        const Vec3 oc = subtract3(centre, origin->high);
        const reals p = dot3(oc, direction);
        const Vec3 across = madd3(-p, direction, oc);
#if NUMERICS_ROBUST
        const reals margin = fma(splat(R(32.0) * ROUNDOFF), fabs(p) + radius, ray_margin);
        const reals reach = radius + margin;
        const reals room = fma(reach, reach, -dot3(across, across));
        const reals behind = at_least(-p - margin, splat(0));
        const masks candidate =
            (room >= behind * behind) & paths->alive & mask_of_uint(paths->own_slot != splat_uint(slot));
        if (!any_lane(candidate)) continue;
        const LANED(Roots) roots = LANED(sphere_roots)(origin->high.x, origin->high.y, origin->high.z, origin->low.x,
                                                       origin->low.y, origin->low.z, direction.x, direction.y,
                                                       direction.z, centre.x, centre.y, centre.z, radius);
        refineds t;
        masks enters;
        const masks hit = LANED(choose_root)(roots, radius, origin->slack, &t, &enters) & candidate;
#else
        const reals discriminant = fma(radius, radius, -dot3(across, across));
        const reals half_chord = sqrt(at_least(discriminant, splat(0)));
        const masks enters = p - half_chord > splat(PLAIN_T_MIN);
        const reals t = choose(enters, p - half_chord, p + half_chord);
        const masks hit = (discriminant >= splat(0)) & (t > splat(PLAIN_T_MIN)) & paths->alive;
#endif
        const uints sphere = splat_uint(geometry->slot_sphere[slot]);
        const masks closer = hit & (mask_of_refined(t < meeting->t) |
                                    (mask_of_refined(t == meeting->t) & mask_of_uint(sphere < best_sphere)));
        meeting->t = choose_refined(closer, t, meeting->t);
        meeting->slot = choose_uint(closer, splat_uint(slot), meeting->slot);
        meeting->enters = (closer & enters) | (not_mask(closer) & meeting->enters);
        best_sphere = choose_uint(closer, sphere, best_sphere);
    }
}
#endif

static Meeting meet(const Geometry *geometry, const Paths *paths) {
    real high_x[LANE_COUNT], high_y[LANE_COUNT], high_z[LANE_COUNT];
    real low_x[LANE_COUNT], low_y[LANE_COUNT], low_z[LANE_COUNT];
    real direction_x[LANE_COUNT], direction_y[LANE_COUNT], direction_z[LANE_COUNT], slack[LANE_COUNT];
    uint own_slot[LANE_COUNT], slot[LANE_COUNT];
    real inward[LANE_COUNT], alive[LANE_COUNT], enters[LANE_COUNT];
    refined t[LANE_COUNT];
    Meeting meeting;
    meeting.t = splat_refined(REAL_LARGE);
    meeting.slot = splat_uint(NO_SLOT);
    meeting.enters = splat(0) != splat(0);
#if LANE_COUNT > 1
    meet_first_leaves(geometry, paths, &meeting);
#endif
#if LANE_COUNT > 1 && EFFECT_TREE
    real inverse[3][LANE_COUNT], near_offset[3][LANE_COUNT], far_offset[3][LANE_COUNT];
    const LANED(BoxAxis) x = LANED(box_axis)(paths->origin.high.x, paths->direction.x);
    const LANED(BoxAxis) y = LANED(box_axis)(paths->origin.high.y, paths->direction.y);
    const LANED(BoxAxis) z = LANED(box_axis)(paths->origin.high.z, paths->direction.z);
    store_lanes(x.inverse, inverse[0]);
    store_lanes(y.inverse, inverse[1]);
    store_lanes(z.inverse, inverse[2]);
    store_lanes(x.near_offset, near_offset[0]);
    store_lanes(y.near_offset, near_offset[1]);
    store_lanes(z.near_offset, near_offset[2]);
    store_lanes(x.far_offset, far_offset[0]);
    store_lanes(y.far_offset, far_offset[1]);
    store_lanes(z.far_offset, far_offset[2]);
#endif
    store_lanes(paths->origin.high.x, high_x);
    store_lanes(paths->origin.high.y, high_y);
    store_lanes(paths->origin.high.z, high_z);
    store_lanes(paths->origin.low.x, low_x);
    store_lanes(paths->origin.low.y, low_y);
    store_lanes(paths->origin.low.z, low_z);
    store_lanes(paths->direction.x, direction_x);
    store_lanes(paths->direction.y, direction_y);
    store_lanes(paths->direction.z, direction_z);
    store_lanes(paths->origin.slack, slack);
    store_lanes(paths->own_slot, own_slot);
    store_lanes(choose(paths->inward, splat(1), splat(0)), inward);
    store_lanes(choose(paths->alive, splat(1), splat(0)), alive);
    store_lanes(meeting.t, t);
    store_lanes(meeting.slot, slot);
    store_lanes(choose(meeting.enters, splat(1), splat(0)), enters);
    for (uint lane = 0; lane < LANE_COUNT; ++lane) {
        if (alive[lane] == 0) continue;
        Ray ray;
        ray.high[0] = high_x[lane];
        ray.high[1] = high_y[lane];
        ray.high[2] = high_z[lane];
        ray.low[0] = low_x[lane];
        ray.low[1] = low_y[lane];
        ray.low[2] = low_z[lane];
        ray.direction[0] = direction_x[lane];
        ray.direction[1] = direction_y[lane];
        ray.direction[2] = direction_z[lane];
        ray.slack = slack[lane];
        ray.own_slot = own_slot[lane];
        ray.inward = inward[lane] != 0;
        Hit hit = no_hit(t[lane]);
        hit.slot = slot[lane];
        hit.enters = enters[lane] != 0;
        meet_own_sphere(geometry, &ray, &hit);
#if LANE_COUNT == 1
        search_spheres(geometry, &ray, 0, &hit);
#elif EFFECT_TREE
        BoxRay box;
        set_box_axis(&box, 0, inverse[0][lane], near_offset[0][lane], far_offset[0][lane]);
        set_box_axis(&box, 1, inverse[1][lane], near_offset[1][lane], far_offset[1][lane]);
        set_box_axis(&box, 2, inverse[2][lane], near_offset[2][lane], far_offset[2][lane]);
        search_tree(geometry, &ray, &box, margin_of_ray(&ray), 0, &hit);
#endif
        t[lane] = hit.t;
        slot[lane] = hit.slot;
        enters[lane] = hit.enters ? 1 : 0;
    }
    meeting.t = load_lanes(t);
    meeting.slot = load_lanes(slot);
    meeting.enters = load_lanes(enters) != splat(0);
    meeting.met = mask_of_uint(meeting.slot != splat_uint(NO_SLOT));
    return meeting;
}

/* The sphere and the material at each lane's slot; lanes that met nothing get those of slot 0. */
static void look_up(const Scene *scene, const Meeting *meeting, Vec3 *centre, reals *radius, Surface *surface,
                    Vec3 *emitted) {
    const uints slot = choose_uint(meeting->met, meeting->slot, splat_uint(0));
    const uints lane = slot % TREE_WIDTH;
    const uints place = (slot - lane) * 4u + lane;
    *centre = vec3(gather_reals(scene->geometry.leaves, place),
                   gather_reals(scene->geometry.leaves, place + (uint)TREE_WIDTH),
                   gather_reals(scene->geometry.leaves, place + (uint)(2 * TREE_WIDTH)));
    *radius = gather_reals(scene->geometry.leaves, place + (uint)(3 * TREE_WIDTH));
    const uints sphere = gather_uints(scene->geometry.slot_sphere, slot);
    const uints material = gather_uints(scene->looks, sphere * LOOK_UINTS);
    const uints colour = gather_uints(scene->looks, sphere * LOOK_UINTS + 1u);
    const uints numbers = material * MATERIAL_REALS;
    const uints kinds = material * MATERIAL_UINTS;
    surface->albedo = vec3(gather_reals(scene->materials, numbers), gather_reals(scene->materials, numbers + 1u),
                           gather_reals(scene->materials, numbers + 2u));
    const masks own_colour = mask_of_uint(colour != splat_uint(NO_ALBEDO));
    if (any_lane(own_colour)) {
        const uints entry = choose_uint(own_colour, colour, splat_uint(0)) * 4u;
        const Vec3 albedo = vec3(gather_reals(scene->albedos, entry), gather_reals(scene->albedos, entry + 1u),
                                 gather_reals(scene->albedos, entry + 2u));
        surface->albedo = choose3(own_colour, albedo, surface->albedo);
    }
    surface->kind = gather_uints(scene->kinds, kinds);
    *emitted = zero3();
#if EFFECT_EMISSION
    *emitted = vec3(gather_reals(scene->materials, numbers + MATERIAL_EMIT),
                    gather_reals(scene->materials, numbers + (MATERIAL_EMIT + 1u)),
                    gather_reals(scene->materials, numbers + (MATERIAL_EMIT + 2u)));
#endif
#if EFFECT_LAMBERTIAN
    surface->lobe = gather_uints(scene->kinds, kinds + 1u);
#endif
#if EFFECT_METAL
    surface->fuzz = gather_reals(scene->materials, numbers + MATERIAL_FUZZ);
#endif
#if EFFECT_METAL || EFFECT_DIELECTRIC
    surface->variant = gather_uints(scene->kinds, kinds + 2u);
#endif
#if EFFECT_DIELECTRIC
    surface->refraction_index = gather_reals(scene->materials, numbers + MATERIAL_INDEX);
    surface->total_reflection = gather_uints(scene->kinds, kinds + 3u);
#endif
}

/* One segment of every living path: intersect, collect radiance, scatter. */
static void advance(const Scene *scene, Paths *paths) {
    const Meeting meeting = meet(&scene->geometry, paths);
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
        __global const PackedMaterialKind *kinds, __global const PackedSphereLook *looks,                    \
        __global const real *albedos, __global const real *boxes, __global const uint *children,             \
        __global const real *leaves, __global const uint *slot_sphere, uint first_leaves, uint leaf_count,   \
        uint pixel_center, uint max_depth, uint seed_low, uint seed_high, uint replicates, uint width
#define SCENE_ARGUMENTS                                                                                      \
    sky, materials, kinds, looks, albedos, boxes, children, leaves, slot_sphere, first_leaves, leaf_count

static Scene begin_scene(__global const PackedSky *sky, __global const PackedMaterial *materials,
                         __global const PackedMaterialKind *kinds, __global const PackedSphereLook *looks,
                         __global const real *albedos, __global const real *boxes, __global const uint *children,
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
    scene.looks = (__global const uint *)looks;
    scene.albedos = albedos;
    return scene;
}

/* Sets the lanes of `fresh` to the beginning of the path of their pixel sample; row and column are whole numbers. */
static void begin_paths(__global const PackedCamera *camera, uint pixel_center, SampleKey key, reals column, reals row,
                        masks fresh, Paths *paths) {
    Vec3 origin, direction;
    camera_ray(camera, pixel_center, key, column, row, &origin, &direction);
    paths->origin.high = choose3(fresh, origin, paths->origin.high);
    paths->origin.low = choose3(fresh, zero3(), paths->origin.low);
    paths->origin.slack = choose(fresh, splat(0), paths->origin.slack);
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
    paths->own_slot = choose_uint(fresh, splat_uint(NO_SLOT), paths->own_slot);
    paths->inward = paths->inward & not_mask(fresh);
    paths->alive = paths->alive | fresh;
}

__kernel void trace(SCENE_PARAMETERS, uint first_pixel, uint first_sample, uint samples_per_pixel, uint sample_count,
                    uint samples_per_item, __global real *samples) {
    const Scene scene = begin_scene(SCENE_ARGUMENTS);
    const uint item = get_global_id(0);
    uint next = item * samples_per_item;
    const uint end = min(next + samples_per_item, sample_count);
    /* The pixel sample `next` stands for, counted along: division is slow, in lanes above all. */
    const uint first = first_pixel + next / samples_per_pixel;
    uint sample = next % samples_per_pixel, row = first / width, column = first % width;

    Paths paths;
    paths.alive = splat(0) != splat(0);
    paths.depth = splat_uint(0);
    masks taken = paths.alive; /* lanes whose result is still to be written */
    uint number[LANE_COUNT];   /* of the pixel sample within the chunk */
    for (;;) {
        /* Paths that reached the cap end here, black for what is missing. */
        const masks cut = paths.alive & mask_of_uint(paths.depth >= splat_uint(max_depth));
        const masks ended = taken & (not_mask(paths.alive) | cut);
        if (any_lane(ended)) {
            real red[LANE_COUNT], green[LANE_COUNT], blue[LANE_COUNT], count[LANE_COUNT], done[LANE_COUNT];
            store_lanes(paths.radiance.x, red);
            store_lanes(paths.radiance.y, green);
            store_lanes(paths.radiance.z, blue);
            store_lanes(uint_to_reals(paths.depth) + choose(cut, splat(R(0.5)), splat(0)), count);
            store_lanes(choose(ended, splat(1), splat(0)), done);
            for (uint lane = 0; lane < LANE_COUNT; ++lane) {
                if (done[lane] == 0) continue;
                __global real *sample = samples + (size_t)number[lane] * 4;
                sample[0] = red[lane];
                sample[1] = green[lane];
                sample[2] = blue[lane];
                sample[3] = count[lane];
            }
            taken = taken & not_mask(ended);
            paths.alive = paths.alive & not_mask(cut);
        }

        /* Lanes that are free take the next pixel samples, once half of them are. */
        if (next < end) {
            real busy[LANE_COUNT];
            store_lanes(choose(taken, splat(1), splat(0)), busy);
            uint busy_count = 0;
            for (uint lane = 0; lane < LANE_COUNT; ++lane) busy_count += busy[lane] != 0;
            if (busy_count <= LANE_COUNT / 2) {
                uint pixels[LANE_COUNT], sample_numbers[LANE_COUNT];
                real rows[LANE_COUNT], columns[LANE_COUNT], fresh_lane[LANE_COUNT];
                for (uint lane = 0; lane < LANE_COUNT; ++lane) {
                    const int takes = busy[lane] == 0 && next < end;
                    fresh_lane[lane] = takes ? 1 : 0;
                    pixels[lane] = row * width + column;
                    sample_numbers[lane] = first_sample + sample;
                    rows[lane] = (real)row;
                    columns[lane] = (real)column;
                    if (!takes) continue;
                    number[lane] = next++;
                    if (++sample < samples_per_pixel) continue;
                    sample = 0;
                    if (++column < width) continue;
                    column = 0;
                    ++row;
                }
                const masks fresh = load_lanes(fresh_lane) != splat(0);
                const SampleKey key = sample_key(seed_low, seed_high, load_lanes(pixels), load_lanes(sample_numbers), replicates);
                begin_paths(camera, pixel_center, key, load_lanes(columns), load_lanes(rows), fresh, &paths);
                taken = taken | fresh;
                continue; /* a cap of 0 cuts at once */
            }
        }
        if (!any_lane(taken)) return;
        advance(&scene, &paths);
    }
}
