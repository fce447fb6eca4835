/* pilot.cl: paths from the camera or from lights, vertex by vertex, for an estimate of what samples may not find.
 *
 * Appended to a render's program where light may be found by chance alone (host/render/pilot.c, which says what the vertices
 * are for).
 * In:    the packed scene. Of each path its pixel and sample, and, if it does not start at the camera, where and how it does.
 * Out:   for each segment PILOT_REALS numbers and PILOT_UINTS whole numbers, as pilot_types.h has them.
 * Knows: pilot_types.h, path.cl, bounce.cl.   Does not know: what values pixels get. The numbers are of a seed of their own, so the same for
 *        every render of a scene. */
#define PILOT_SEED_LOW 0x6c696768u
#define PILOT_SEED_HIGH 0x74736f75u
#define PILOT_REPLICATES 4u

/* A path of lights begins as one that the camera has sent on, so that it meets what only other rays than the camera's meet. */
static void path_init_from_light(__global const PackedCamera *camera, SampleKey key, __global const real *starts,
                                 vuint number, vbool fresh, Path *path) {
    const vuint place = number * (uint)PILOT_START_REALS;
    const Vec3 low = vec3(gather_real(starts + 3, place), gather_real(starts + 4, place), gather_real(starts + 5, place));
    path_init(camera, key, vec3(gather_real(starts, place), gather_real(starts + 1, place), gather_real(starts + 2, place)),
              vec3(gather_real(starts + 6, place), gather_real(starts + 7, place), gather_real(starts + 8, place)), fresh,
              path);
    path->origin.low = choose3(fresh, low, path->origin.low);
    path->origin.error = choose(fresh, splat(0), path->origin.error);
    path->own_slot = choose_uint(fresh, splat_uint(NO_SLOT), path->own_slot);
    path->inward = path->inward & vbool_not(fresh);
    path->depth = choose_uint(fresh, splat_uint(1), path->depth);
}

/* The vertices that a ray to a lamp can light. */
static vbool stands_lit(const Path *path, vbool moving) {
#if SAMPLES_LAMPS
    return moving & is_lit_lobe(&path->lobe);
#else
    return vbool_none;
#endif
}

/* Those of them whose lobe is narrow, so that light may find few ways on from there. */
static vbool stands_narrowly_lit(const Path *path, vbool lit) {
#if SAMPLES_LAMPS
    return lit & is_narrow_lobe(&path->lobe);
#else
    return vbool_none;
#endif
}

/* One segment of one lane. */
static void store_segment(const LaneReals *values, uint lane, __global real *records) {
    for (uint i = 0; i < (uint)PILOT_REALS; ++i) records[i] = values[i].of[lane];
}

/* `numbers`: a pixel and a sample for each path. `starts`: only if not `from_camera`. A camera's path ends at the first
 * vertex with a wide lobe that a ray to a lamp can light, another if its first is one. */
__kernel VECTORS_WRITTEN void pilot(SCENE_PARAMETERS uint path_count, uint segments, uint from_camera,
                                    __global const uint *numbers, __global const real *starts, __global real *records,
                                    __global uint *marks) {
    const uint first = get_global_id(0) * LANE_COUNT;
    if (first >= path_count) return;
    const Scene scene = scene_init(SCENE_ARGUMENTS);
    const vuint wanted = splat_uint(first) + LANE_NUMBERS;
    const vbool fresh = vbool_of_uint(wanted < splat_uint(path_count));
    const vuint number = choose_uint(fresh, wanted, splat_uint(first));
    const vuint pixel = gather_uint(numbers, number * 2u), sample = gather_uint(numbers + 1, number * 2u);
    const SampleKey key = sample_key(PILOT_SEED_LOW, PILOT_SEED_HIGH, pixel, sample, PILOT_REPLICATES);
    Path path;
    path_none(&path);
    if (from_camera) {
        const vuint row = pixel / width;
        path_init_from_camera(camera, pixel_center, key, uint_to_real(pixel - row * width), uint_to_real(row), fresh, &path);
    } else {
        path_init_from_light(camera, key, starts, number, fresh, &path);
    }
    path.evenly = 1;
    for (uint s = 0; s < segments; ++s) {
        const vbool moving = path.alive;
        if (!any_lane(moving)) break;
        const Vec3 origin = path.origin.high, direction = path.direction;
        trace_bounce(&scene, &path);
#if SAMPLES_LAMPS
        path.wants_lamps = vbool_none;
#endif
        const vbool scattered = moving & path.latest.scattered;
        const vbool met = moving & path.latest.met;
        const vbool lit = stands_lit(&path, met | scattered);
        /* What meets nothing has no other point; of paths that end, kernels keep none. */
        const Vec3 point = choose3(met | scattered, path.origin.high, origin);
        const LaneReals values[PILOT_REALS] = {
            [PILOT_POINT].all = point.x,
            [PILOT_POINT + 1].all = point.y,
            [PILOT_POINT + 2].all = point.z,
            [PILOT_DIRECTION].all = direction.x,
            [PILOT_DIRECTION + 1].all = direction.y,
            [PILOT_DIRECTION + 2].all = direction.z,
            [PILOT_DISTANCE].all = to_real(path.latest.distance),
            [PILOT_THROUGHPUT].all = path.throughput.x,
            [PILOT_THROUGHPUT + 1].all = path.throughput.y,
            [PILOT_THROUGHPUT + 2].all = path.throughput.z,
            [PILOT_ODDS].all = path.odds,
            [PILOT_TIME].all = path_time(&path)};
        LaneUints shapes, lanes;
        shapes.all = gather_split_uint(scene.geometry.slot_sphere, 0, choose_uint(met, path.own_slot, splat_uint(0)));
        const uint is_moving = lane_bits(moving), is_met = lane_bits(met), goes_on = lane_bits(path.alive);
        const uint is_lit = lane_bits(lit), in_medium = lane_bits(scattered);
        lanes.all = number;
        for (uint lane = 0; lane < LANE_COUNT; ++lane) {
            if (!(is_moving >> lane & 1u)) continue;
            const size_t place = (size_t)lanes.of[lane] * segments + s;
            store_segment(values, lane, records + place * PILOT_REALS);
            marks[place * PILOT_UINTS + PILOT_SHAPE] = is_met >> lane & 1u ? shapes.of[lane] : NO_SPHERE;
            marks[place * PILOT_UINTS + PILOT_FLAGS] =
                PILOT_TRACED | (is_met >> lane & 1u) * PILOT_MET | (goes_on >> lane & 1u) * PILOT_GOES_ON | (is_lit >> lane & 1u) * PILOT_LIT |
                (in_medium >> lane & 1u) * PILOT_IN_MEDIUM;
        }
        if (from_camera || s == 0) path.alive = path.alive & (vbool_not(lit) | stands_narrowly_lit(&path, lit));
    }
}
