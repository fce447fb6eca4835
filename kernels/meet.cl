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
    uints slot, sphere;
} Meeting;

/* Not below the distance met so far. */
static reals bound_of(const Meeting *meeting) { return to_real(meeting->t) * (R(1.0) + R(4.0) * ROUNDOFF); }

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

/* One leaf's spheres, one at a time, against all lanes of `active`. The margin is that of test_leaf in tree.cl. */
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

#if EFFECT_TREE
/* The whole tree, for lanes that go much the same way: one walk for all. Lanes may not differ in the sign of any
 * direction component: *signs has one lane's. */
static void search_tree_lanes(const Geometry *geometry, const Paths *paths, masks active, reals ray_margin,
                              const LANED(BoxAxis) *x, const LANED(BoxAxis) *y, const LANED(BoxAxis) *z,
                              const BoxRay *signs, Meeting *meeting) {
    uint stack[STACK_SIZE];
    reals stack_entry[STACK_SIZE];
    uint top = 0;
    uint node = 0;
    for (;;) {
        __global const real *planes = geometry->boxes + node * (6 * TREE_WIDTH);
        const reals bound = bound_of(meeting);
        for (uint child = 0; child < TREE_WIDTH; ++child) {
            const reals enter_x = fma(splat(planes[signs->near_row[0] + child]), x->inverse, x->near_offset);
            const reals enter_y = fma(splat(planes[signs->near_row[1] + child]), y->inverse, y->near_offset);
            const reals enter_z = fma(splat(planes[signs->near_row[2] + child]), z->inverse, z->near_offset);
            const reals leave_x = fma(splat(planes[signs->far_row[0] + child]), x->inverse, x->far_offset);
            const reals leave_y = fma(splat(planes[signs->far_row[1] + child]), y->inverse, y->far_offset);
            const reals leave_z = fma(splat(planes[signs->far_row[2] + child]), z->inverse, z->far_offset);
            const reals near = at_least(at_least(enter_x, enter_y), at_least(enter_z, splat(0)));
            const reals far = at_most(at_most(leave_x, leave_y), at_most(leave_z, bound));
            const masks met = (near <= far * (R(1.0) + R(16.0) * ROUNDOFF)) & active;
            if (!any_lane(met)) continue;
            stack[top] = geometry->children[node * TREE_WIDTH + child];
            stack_entry[top] = choose(met, near, splat(REAL_LARGE));
            ++top;
        }
        for (;;) {
            if (top == 0) return;
            --top;
            if (!any_lane(stack_entry[top] <= bound_of(meeting))) continue;
            const uint child = stack[top];
            if ((child & CHILD_LEAF) == 0) {
                node = child;
                break;
            }
            test_leaf_lanes(geometry, paths, active, ray_margin, child & ~CHILD_LEAF, meeting);
        }
    }
}
#endif
#endif

/* Lanes that begin: rays of one pixel, or of its neighbours. With fewer than this, each goes alone. */
#define TOGETHER_MIN 4u

#if LANE_COUNT == 1 || EFFECT_TREE
/* Each lane by itself, from what `meeting` has. */
static void search_lane_by_lane(const Geometry *geometry, const Paths *paths, Meeting *meeting) {
    real high_x[LANE_COUNT], high_y[LANE_COUNT], high_z[LANE_COUNT];
    real low_x[LANE_COUNT], low_y[LANE_COUNT], low_z[LANE_COUNT];
    real direction_x[LANE_COUNT], direction_y[LANE_COUNT], direction_z[LANE_COUNT], slack[LANE_COUNT];
    uint own_slot[LANE_COUNT], slot[LANE_COUNT];
    real alone[LANE_COUNT], enters[LANE_COUNT];
    refined t[LANE_COUNT];
    masks single = paths->alive;
#if LANE_COUNT == 1
    real inward[LANE_COUNT];
    store_lanes(choose(paths->inward, splat(1), splat(0)), inward);
#else
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
    /* Paths that begin walk the tree together, if there are enough of them and they go into one octant. */
    const masks begin = paths->alive & mask_of_uint(paths->depth == splat_uint(0));
    real begins[LANE_COUNT];
    store_lanes(choose(begin, splat(1), splat(0)), begins);
    uint count = 0, first = 0;
    for (uint lane = 0; lane < LANE_COUNT; ++lane) {
        if (begins[lane] == 0) continue;
        first = lane;
        ++count;
    }
    if (count >= TOGETHER_MIN) {
        BoxRay signs;
        set_box_axis(&signs, 0, inverse[0][first], 0, 0);
        set_box_axis(&signs, 1, inverse[1][first], 0, 0);
        set_box_axis(&signs, 2, inverse[2][first], 0, 0);
        const masks other = (x.inverse * signs.inverse[0] < splat(0)) | (y.inverse * signs.inverse[1] < splat(0)) |
                            (z.inverse * signs.inverse[2] < splat(0));
        if (!any_lane(begin & other)) {
            const Vec3 high = paths->origin.high;
            const reals ray_margin = fma(fabs(high.x) + fabs(high.y) + fabs(high.z), splat(R(4.0) * ROUNDOFF),
                                         paths->origin.slack);
            search_tree_lanes(geometry, paths, begin, ray_margin, &x, &y, &z, &signs, meeting);
            single = single & not_mask(begin);
        }
    }
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
    store_lanes(choose(single, splat(1), splat(0)), alone);
    store_lanes(meeting->t, t);
    store_lanes(meeting->slot, slot);
    store_lanes(choose(meeting->enters, splat(1), splat(0)), enters);
    for (uint lane = 0; lane < LANE_COUNT; ++lane) {
        if (alone[lane] == 0) continue;
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
        Hit hit = no_hit(t[lane]);
        hit.slot = slot[lane];
        hit.enters = enters[lane] != 0;
#if LANE_COUNT == 1
        ray.inward = inward[lane] != 0;
        meet_own_sphere(geometry, &ray, &hit);
        search_spheres(geometry, &ray, 0, &hit);
#else
        ray.inward = 0; /* already met */
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
    meeting->t = load_lanes(t);
    meeting->slot = load_lanes(slot);
    meeting->enters = load_lanes(enters) != splat(0);
}
#endif

static Meeting meet(const Geometry *geometry, const Paths *paths) {
    Meeting meeting;
    meeting.t = splat_refined(REAL_LARGE);
    meeting.slot = splat_uint(NO_SLOT);
    meeting.sphere = splat_uint(NO_SPHERE);
    meeting.enters = splat(0) != splat(0);
#if LANE_COUNT > 1
    const Vec3 high = paths->origin.high;
    const reals ray_margin = fma(fabs(high.x) + fabs(high.y) + fabs(high.z), splat(R(4.0) * ROUNDOFF),
                                 paths->origin.slack);
#if NUMERICS_ROBUST
    meet_own_spheres(geometry, paths, &meeting);
#endif
    for (uint leaf = 0; leaf < geometry->first_leaves; ++leaf)
        test_leaf_lanes(geometry, paths, paths->alive, ray_margin, leaf, &meeting);
#endif
#if LANE_COUNT == 1 || EFFECT_TREE
    search_lane_by_lane(geometry, paths, &meeting);
#endif
    meeting.met = mask_of_uint(meeting.slot != splat_uint(NO_SLOT));
    return meeting;
}
