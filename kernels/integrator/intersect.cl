/* intersect.cl: what the paths of all lanes meet next.
 *
 * In:    paths, geometry.   Out: for each lane the closest hit, as intersect_closest (traverse_single.cl) has it.
 *
 * The few huge spheres, which most rays meet, are tried against all lanes at once; then each lane searches the tree
 * with the bound that gave it. */

/* The packed tables, as the functions that read them want them. */
typedef struct Scene {
    Geometry geometry;
#if LANE_COUNT > 1 && EFFECT_TREE
    FlatTree flat;
#endif
    __global const PackedSky *sky;
    __global const real *materials; /* PackedMaterial */
    __global const uint *kinds;     /* PackedMaterialKind */
    __global const uint *slot_material;
    __global const real *slot_albedo;
} Scene;

#if LANE_COUNT > 1
/* Keeps what is least in (distance, sphere index), lane by lane. */
static void keep_closer_lanes(masks hit, refineds t, uints slot, uints sphere, masks enters, Meeting *meeting) {
    const masks closer = hit & (mask_of_refined(t < meeting->t) |
                                (mask_of_refined(t == meeting->t) & mask_of_uint(sphere < meeting->sphere)));
    meeting->t = choose_refined(closer, t, meeting->t);
    meeting->slot = choose_uint(closer, slot, meeting->slot);
    meeting->sphere = choose_uint(closer, sphere, meeting->sphere);
    meeting->enters = (closer & enters) | (not_mask(closer) & meeting->enters);
}

#if NUMERICS_ROBUST
/* The spheres being left, met again from inside. */
static void meet_own_spheres(const Geometry *geometry, const Paths *paths, Meeting *meeting) {
    const masks inward = paths->alive & paths->inward;
    if (!any_lane(inward)) return;
    const uints slot = choose_uint(inward, paths->own_slot, splat_uint(0));
    const uints lane = slot % TREE_WIDTH;
    const uints place = (slot - lane) * 4u + lane;
    const Point *origin = &paths->origin;
    const LANED(Roots) roots = LANED(sphere_roots)(
        origin->high.x, origin->high.y, origin->high.z, origin->low.x, origin->low.y, origin->low.z, paths->direction.x,
        paths->direction.y, paths->direction.z, gather_reals(geometry->leaves, place),
        gather_reals(geometry->leaves, place + (uint)TREE_WIDTH),
        gather_reals(geometry->leaves, place + (uint)(2 * TREE_WIDTH)),
        gather_reals(geometry->leaves, place + (uint)(3 * TREE_WIDTH)));
    keep_closer_lanes(inward, LANED(chord)(roots), slot, gather_uints(geometry->slot_sphere, slot),
                      splat(0) != splat(0), meeting);
}
#endif

/* One leaf's spheres, one at a time, against all lanes of `active`. The margin is that of test_leaf in traverse_single.cl. */
static void test_leaf_lanes(const Geometry *geometry, const Paths *paths, masks active, reals ray_margin,
                            uint leaf_number, Meeting *meeting) {
    const Point *origin = &paths->origin;
    const Vec3 direction = paths->direction;
    __global const real *leaf = geometry->leaves + leaf_number * (4 * TREE_WIDTH);
    for (uint lane = 0; lane < TREE_WIDTH; ++lane) {
        if (leaf[3 * TREE_WIDTH + lane] <= 0) continue;
        const uint slot = leaf_number * TREE_WIDTH + lane;
        const reals radius = splat(leaf[3 * TREE_WIDTH + lane]);
        const Vec3 centre = vec3(splat(leaf[lane]), splat(leaf[TREE_WIDTH + lane]), splat(leaf[2 * TREE_WIDTH + lane]));
        const Vec3 oc = subtract3(centre, origin->high);
        const reals p = dot3(oc, direction);
        const Vec3 across = madd3(-p, direction, oc);
#if NUMERICS_ROBUST
        const reals margin = fma(splat(R(64.0) * ROUNDOFF), fabs(p) + radius, ray_margin);
        const reals reach = radius + margin;
        const reals room = fma(reach, reach, -dot3(across, across));
        const reals outside = at_least(at_least(-p, p - bound_of(meeting)) - margin, splat(0));
        const masks candidate =
            (room >= outside * outside) & active & mask_of_uint(paths->own_slot != splat_uint(slot));
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
        const masks hit = (discriminant >= splat(0)) & (t > splat(PLAIN_T_MIN)) & active;
#endif
        keep_closer_lanes(hit, t, splat_uint(slot), splat_uint(geometry->slot_sphere[slot]), enters, meeting);
    }
}

/* How far the rounding of the rays' origins, and their slack, can move a distance. */
static reals margin_of_origins(const Point *origin) {
    return fma(fabs(origin->high.x) + fabs(origin->high.y) + fabs(origin->high.z), splat(R(4.0) * ROUNDOFF),
               origin->slack);
}

static Meeting meet(const Scene *scene, const Paths *paths) {
    const Geometry *geometry = &scene->geometry;
    Meeting meeting;
    meeting.t = splat_refined(REAL_LARGE);
    meeting.slot = splat_uint(NO_SLOT);
    meeting.sphere = splat_uint(NO_SPHERE);
    meeting.enters = splat(0) != splat(0);
    const reals margin = margin_of_origins(&paths->origin);
#if NUMERICS_ROBUST
    meet_own_spheres(geometry, paths, &meeting);
#endif
    for (uint leaf = 0; leaf < geometry->first_leaves; ++leaf)
        test_leaf_lanes(geometry, paths, paths->alive, margin, leaf, &meeting);
#if EFFECT_TREE
    search_trees(geometry, &scene->flat, paths, margin, bound_of(&meeting), &meeting);
#endif
    meeting.met = mask_of_uint(meeting.slot != splat_uint(NO_SLOT));
    return meeting;
}
#else
static Meeting meet(const Scene *scene, const Paths *path) {
    Ray ray;
    ray.high[0] = path->origin.high.x;
    ray.high[1] = path->origin.high.y;
    ray.high[2] = path->origin.high.z;
    ray.low[0] = path->origin.low.x;
    ray.low[1] = path->origin.low.y;
    ray.low[2] = path->origin.low.z;
    ray.direction[0] = path->direction.x;
    ray.direction[1] = path->direction.y;
    ray.direction[2] = path->direction.z;
    ray.slack = path->origin.slack;
    ray.margin = margin_of_origin(&ray);
    ray.own_slot = path->own_slot;
    ray.inward = path->inward;
    const Hit hit = intersect_closest(&scene->geometry, &ray);
    Meeting meeting;
    meeting.t = hit.t;
    meeting.met = hit.slot != NO_SLOT;
    meeting.enters = hit.enters;
    meeting.slot = hit.slot;
    return meeting;
}
#endif
