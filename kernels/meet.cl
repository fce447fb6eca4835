/* meet.cl: what the paths of all lanes meet next.
 *
 * In:    paths, geometry.   Out: for each lane the closest hit, as intersect_closest (tree.cl) has it.
 *
 * The few huge spheres, which most rays meet, are tried against all lanes at once; then each lane searches the tree
 * with the bound that gave it. */

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
