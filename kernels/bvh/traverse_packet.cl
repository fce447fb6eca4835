/* traverse_packet.cl: the closest hits of the rays of all lanes.
 *
 * In:    rays, the geometry.   Out: the closest hit of each ray, the same as traverse_single.cl finds.
 * Knows: node.cl, hit.cl, flat_tree.cl.   Does not know: materials, what made the rays.
 *
 * What a ray does next depends on what it met, and a processor that guesses wrong throws away more work than a box
 * test is. So rays take turns, one step for all: first every ray that stands at a node tests it, then the leaves met
 * there, then the spheres found there, then each ray chooses the node to go to. Within a step nothing depends on the
 * step before of the same ray: there is no branch to guess, and memory is fetched for many rays at a time. */
#if ACCELERATION_TREE

/* Lane `lane` is to visit a node, a leaf or a sphere's slot. */
typedef struct Visit {
    uint lane, what;
} Visit;

/* Notes a visit, which counts only where it is `wanted`: so nothing branches, and there must be room for one more.
 * Returns the number of visits. */
FORCE_INLINE static uint add_visit(Visit *visits, uint count, uint lane, uint what, int wanted) {
    visits[count].lane = lane;
    visits[count].what = what;
    return count + (wanted != 0);
}

/* Notes the visits of `lane` to `first` plus each bit of a mask, of which there are mostly `usual` at most: those are noted
 * without asking whether there are as many. */
FORCE_INLINE static uint add_visits(Visit *visits, uint count, uint lane, uint first, child_mask mask, uint usual) {
    for (uint i = 0; i < usual; ++i, mask = without_lowest_bit(mask))
        count = add_visit(visits, count, lane, first + lowest_bit(mask), mask != 0);
    for (; mask != 0; mask = without_lowest_bit(mask))
        count = add_visit(visits, count, lane, first + lowest_bit(mask), 1);
    return count;
}

#define FOUND_MAX 64u
#define VISITS_MAX 64u
#define VISITS_MOST (VISITS_MAX + LANE_COUNT * TREE_WIDTH + 2)

/* The rays of all lanes, and what each has met. */
typedef struct LaneRays {
    LaneReals high[3], low[3], direction[3];
    LaneReals origin_error, cull_margin;
    LaneUints own_slot;
#if EFFECT_OPACITY
    LaneUints passes;
#endif
#if EFFECT_MOTION
    LaneReals time;
#endif
    LaneRefineds t;
    LaneUints slot, enters;
    LaneReals bound;
#if EFFECT_TRIANGLES
    /* What triangles need of them: Shear, and the row that a turned x is in. */
    LaneReals turned_origin[3], turned_low[3], turned_direction[3], slope[3], doubt;
    LaneUints row;
#endif
} LaneRays;

static Ray_one ray_of_lane(const LaneRays *rays, uint lane) {
    Ray_one ray;
    ray.origin.high = vec3_one(rays->high[0].of[lane], rays->high[1].of[lane], rays->high[2].of[lane]);
    ray.origin.low = vec3_one(rays->low[0].of[lane], rays->low[1].of[lane], rays->low[2].of[lane]);
    ray.origin.error = rays->origin_error.of[lane];
    ray.direction = vec3_one(rays->direction[0].of[lane], rays->direction[1].of[lane], rays->direction[2].of[lane]);
    ray.cull_margin = rays->cull_margin.of[lane];
    ray.own_slot = rays->own_slot.of[lane];
    ray.inward = 0; /* intersect_own_sphere has seen to that */
#if EFFECT_OPACITY
    ray.passes = (int)rays->passes.of[lane];
#endif
#if EFFECT_MOTION
    ray.time = rays->time.of[lane];
#endif
    return ray;
}

#if SPHERES_MET
static void intersect_slot_of_lane(const Geometry *geometry, LaneRays *rays, uint lane, uint slot) {
    const Ray_one ray = ray_of_lane(rays, lane);
    const Sphere_one sphere = sphere_for_ray_one(geometry, &ray, slot);
    Hit_one hit;
    hit.t = rays->t.of[lane];
    hit.slot = rays->slot.of[lane];
    hit.enters = (int)rays->enters.of[lane];
    hit.bound = rays->bound.of[lane];
    intersect_sphere_one(geometry, &ray, 1, &sphere, slot, &hit);
    rays->t.of[lane] = hit.t;
    rays->slot.of[lane] = hit.slot;
    rays->enters.of[lane] = (uint)hit.enters;
    rays->bound.of[lane] = hit.bound;
}
#endif

#define LEAF_BATCH 32u

#if EFFECT_TRIANGLES
/* The triangle in each lane's slot, turned as its ray is. `row`: of the turned x. */
static Triangle load_turned(const Geometry *geometry, vuint slot, vuint row) {
    const vuint lane = slot % TREE_WIDTH;
    const vuint place = (slot - lane - geometry->first_triangles * TREE_WIDTH) * 9u + lane;
    const vuint x = place + row;
    const vbool last = vbool_of_uint(row == splat_uint(2 * TREE_WIDTH)), first = vbool_of_uint(row == splat_uint(0));
    const vuint y = place + choose_uint(last, splat_uint(0), row + splat_uint(TREE_WIDTH));
    const vuint z = place + choose_uint(first, splat_uint(2 * TREE_WIDTH), row - splat_uint(TREE_WIDTH));
    const uint to_b = 3 * TREE_WIDTH, to_c = 6 * TREE_WIDTH;
    Triangle turned;
    turned.a = vec3(gather_split_real(geometry->triangles, 0, x), gather_split_real(geometry->triangles, 0, y),
                    gather_split_real(geometry->triangles, 0, z));
    turned.b = vec3(gather_split_real(geometry->triangles, to_b, x), gather_split_real(geometry->triangles, to_b, y),
                    gather_split_real(geometry->triangles, to_b, z));
    turned.c = vec3(gather_split_real(geometry->triangles, to_c, x), gather_split_real(geometry->triangles, to_c, y),
                    gather_split_real(geometry->triangles, to_c, z));
    return turned;
}

/* Three numbers of each of these lanes. */
static Vec3 gather_lanes(const LaneReals *numbers, vuint lanes) {
    return vec3(gather_real(numbers[0].of, lanes), gather_real(numbers[1].of, lanes), gather_real(numbers[2].of, lanes));
}

static Hit_one hit_of_lane(const LaneRays *rays, uint lane) {
    Hit_one hit;
    hit.t = rays->t.of[lane];
    hit.slot = rays->slot.of[lane];
    hit.enters = (int)rays->enters.of[lane];
    hit.bound = rays->bound.of[lane];
    return hit;
}

static void set_hit_of_lane(const Hit_one *hit, uint lane, LaneRays *rays) {
    rays->t.of[lane] = hit->t;
    rays->slot.of[lane] = hit->slot;
    rays->enters.of[lane] = (uint)hit->enters;
    rays->bound.of[lane] = hit->bound;
}

#if ROBUST_SHAPES
/* Decides about those that triangle_decide leaves open, few of a million. */
static void intersect_doubtful(const Geometry *geometry, const Visit *visits, uint count, LaneRays *rays) {
    for (uint i = 0; i < count; ++i) {
        const uint lane = visits[i].lane, slot = visits[i].what;
        const Ray_one ray = ray_of_lane(rays, lane);
        const Shear_one shear = shear_of_one(&ray);
        const Triangle_one triangle = load_triangle_one(geometry, slot);
        Hit_one hit = hit_of_lane(rays, lane);
        intersect_left_triangle_one(geometry, &ray, &shear, 1, &triangle, slot, &hit);
        set_hit_of_lane(&hit, lane, rays);
    }
}
#endif

/* Decides about triangles that may be met, as many as there are lanes at a time. */
ON_CHAINS static void intersect_found_triangles(const Geometry *geometry, Visit *found, uint count, LaneRays *rays) {
    uint open = 0; /* of `found`, which those take over that have been asked */
    for (uint begin = 0; begin < count; begin += LANE_COUNT) {
        LaneUints lanes, slots, decided, enter, doubtful;
        LaneRefineds distances;
        for (uint i = 0; i < LANE_COUNT; ++i) {
            const Visit visit = found[min(begin + i, count - 1)]; /* the last one again and again */
            lanes.of[i] = visit.lane;
            slots.of[i] = visit.what;
        }
        Shear shear;
        shear.direction = gather_lanes(rays->turned_direction, lanes.all);
        shear.origin = gather_lanes(rays->turned_origin, lanes.all);
        shear.low = gather_lanes(rays->turned_low, lanes.all);
        shear.error = gather_real(rays->origin_error.of, lanes.all);
        shear.doubt = gather_real(rays->doubt.of, lanes.all);
        const Triangle turned = load_turned(geometry, slots.all, gather_uint(rays->row.of, lanes.all));
        vrefined t;
        vbool enters, unsure;
        const vbool met = triangle_decide(&shear, &turned, &t, &enters, &unsure);
        distances.all = t;
        decided.all = choose_uint(met & vbool_not(unsure), splat_uint(1), splat_uint(0));
        enter.all = choose_uint(enters, splat_uint(1), splat_uint(0));
        doubtful.all = choose_uint(unsure, splat_uint(1), splat_uint(0));
        for (uint i = 0; i < LANE_COUNT && begin + i < count; ++i) {
            const uint lane = lanes.of[i], slot = slots.of[i];
            Hit_one hit = hit_of_lane(rays, lane);
            keep_closer_one(geometry, (int)decided.of[i], distances.of[i], slot, (int)enter.of[i], &hit);
            set_hit_of_lane(&hit, lane, rays);
            open = add_visit(found, open, lane, slot, doubtful.of[i] != 0);
        }
    }
#if ROBUST_SHAPES
    if (open > 0) intersect_doubtful(geometry, found, open, rays);
#endif
}

static LeafShear shear_of_lane(const LaneRays *rays, uint lane) {
    LeafShear shear;
    shear.origin[0] = rays->turned_origin[0].of[lane];
    shear.origin[1] = rays->turned_origin[1].of[lane];
    shear.origin[2] = rays->turned_origin[2].of[lane];
    shear.slope[0] = rays->slope[0].of[lane];
    shear.slope[1] = rays->slope[1].of[lane];
    shear.slope[2] = rays->slope[2].of[lane];
    shear.margin = rays->cull_margin.of[lane];
    set_rows(&shear, rays->row.of[lane]);
    return shear;
}

/* intersect_leaves, below, for those leaves that hold triangles. */
ON_CHAINS static void intersect_triangle_leaves(const Geometry *geometry, const Visit *visits, uint count, LaneRays *rays) {
    Visit found[FOUND_MAX + TREE_WIDTH];
    child_mask met[LEAF_BATCH];
    uint found_count = 0;
    for (uint begin = 0; begin < count; begin += LEAF_BATCH) {
        const uint end = min(begin + LEAF_BATCH, count);
        for (uint i = begin; i < end; ++i) {
            const LeafShear shear = shear_of_lane(rays, visits[i].lane);
            met[i - begin] = triangle_candidates(geometry, &shear, visits[i].what, rays->bound.of[visits[i].lane]);
        }
        for (uint i = begin; i < end; ++i) {
            const uint lane = visits[i].lane, leaf = visits[i].what;
            const child_mask left = without_known(met[i - begin], leaf, rays->own_slot.of[lane], rays->slot.of[lane]);
            found_count = add_visits(found, found_count, lane, leaf * TREE_WIDTH, left, 1);
            if (found_count < FOUND_MAX && i + 1 < count) continue;
            intersect_found_triangles(geometry, found, found_count, rays);
            found_count = 0;
        }
    }
}
#endif

#if EFFECT_TRIANGLES
#define SPHERE_LEAVES intersect_sphere_leaves
#else
#define SPHERE_LEAVES intersect_leaves
#endif

#if SPHERES_MET
/* Visits leaves and decides about the spheres that may be met there. Of a batch, all leaves are tested before anything
 * depends on it: a branch that is guessed wrong then throws away no test. */
static void SPHERE_LEAVES(const Geometry *geometry, const Visit *visits, uint count, LaneRays *rays) {
    Visit found[FOUND_MAX + TREE_WIDTH];
    child_mask met[LEAF_BATCH];
    uint found_count = 0;
    for (uint begin = 0; begin < count; begin += LEAF_BATCH) {
        const uint end = min(begin + LEAF_BATCH, count);
        for (uint i = begin; i < end; ++i) {
            const Ray_one ray = ray_of_lane(rays, visits[i].lane);
            met[i - begin] = leaf_candidates(geometry, &ray, visits[i].what, rays->bound.of[visits[i].lane]);
        }
        for (uint i = begin; i < end; ++i) {
            const uint lane = visits[i].lane, leaf = visits[i].what;
            const child_mask left = without_known(met[i - begin], leaf, rays->own_slot.of[lane], rays->slot.of[lane]);
            found_count = add_visits(found, found_count, lane, leaf * TREE_WIDTH, left, 1);
            if (found_count < FOUND_MAX && i + 1 < count) continue;
            for (uint k = 0; k < found_count; ++k) intersect_slot_of_lane(geometry, rays, found[k].lane, found[k].what);
            found_count = 0;
        }
    }
}
#endif

#if SPHERES_MET && EFFECT_TRIANGLES
/* A leaf holds one kind: those of each are visited together. */
static void intersect_leaves(const Geometry *geometry, const Visit *visits, uint count, LaneRays *rays) {
    Visit spheres[VISITS_MOST], triangles[VISITS_MOST];
    uint sphere_count = 0, triangle_count = 0;
    for (uint i = 0; i < count; ++i) {
        const int flat = visits[i].what >= geometry->first_triangles;
        sphere_count = add_visit(spheres, sphere_count, visits[i].lane, visits[i].what, !flat);
        triangle_count = add_visit(triangles, triangle_count, visits[i].lane, visits[i].what, flat);
    }
    intersect_sphere_leaves(geometry, spheres, sphere_count, rays);
    intersect_triangle_leaves(geometry, triangles, triangle_count, rays);
}
#elif EFFECT_TRIANGLES
#define intersect_leaves intersect_triangle_leaves
#endif

/* What box tests need of the rays of all lanes. */
typedef struct LaneBoxRays {
    LaneReals inverse[3], near_offset[3], far_offset[3];
    LaneUints near_row[3];
} LaneBoxRays;

/* Axis by axis without a loop, here and below: one is not always unrolled, and the rays then pass through memory. */
static void store_box_axis(BoxAxis axis, uint number, LaneBoxRays *boxes) {
    boxes->inverse[number].all = axis.inverse;
    boxes->near_offset[number].all = axis.near_offset;
    boxes->far_offset[number].all = axis.far_offset;
    boxes->near_row[number].all = choose_uint(axis.inverse < splat(0), splat_uint((number + 3) * TREE_WIDTH),
                                              splat_uint(number * TREE_WIDTH));
}

static void store_box_axes(const BoxAxis *axes, LaneBoxRays *boxes) {
    store_box_axis(axes[0], 0, boxes);
    store_box_axis(axes[1], 1, boxes);
    store_box_axis(axes[2], 2, boxes);
}

static void load_box_axis(const LaneBoxRays *boxes, uint lane, uint axis, BoxRay *box) {
    box->inverse[axis] = boxes->inverse[axis].of[lane];
    box->near_offset[axis] = boxes->near_offset[axis].of[lane];
    box->far_offset[axis] = boxes->far_offset[axis].of[lane];
    box->near_row[axis] = boxes->near_row[axis].of[lane];
    box->far_row[axis] = (2 * axis + 3) * TREE_WIDTH - box->near_row[axis];
}

static BoxRay box_ray_of_lane(const LaneBoxRays *boxes, uint lane) {
    BoxRay box;
    load_box_axis(boxes, lane, 0, &box);
    load_box_axis(boxes, lane, 1, &box);
    load_box_axis(boxes, lane, 2, &box);
    return box;
}

/* Box tests of the rays of all lanes at once, which differ in which plane of a pair they meet first. */
typedef struct PacketBoxRay {
    vreal inverse[3], low_offset[3], high_offset[3];
    vreal bound; /* below 0: the lane is off */
} PacketBoxRay;

static void set_packet_box_axis(BoxAxis axis, uint number, PacketBoxRay *box) {
    const vbool backwards = axis.inverse < splat(0);
    box->inverse[number] = axis.inverse;
    box->low_offset[number] = choose(backwards, axis.far_offset, axis.near_offset);
    box->high_offset[number] = choose(backwards, axis.near_offset, axis.far_offset);
}

static PacketBoxRay packet_box_ray(const BoxAxis *axes, vbool active, vreal bound) {
    PacketBoxRay box;
    set_packet_box_axis(axes[0], 0, &box);
    set_packet_box_axis(axes[1], 1, &box);
    set_packet_box_axis(axes[2], 2, &box);
    box.bound = choose(active, bound, splat(-1));
    return box;
}

/* The lanes whose rays meet one box, of which planes[0], planes[stride], ... are the six planes. */
FORCE_INLINE static vbool meets_box(const PacketBoxRay *box, const real *planes, uint stride) {
    const vreal low_x = loose_fma(splat(planes[0]), box->inverse[0], box->low_offset[0]);
    const vreal low_y = loose_fma(splat(planes[stride]), box->inverse[1], box->low_offset[1]);
    const vreal low_z = loose_fma(splat(planes[2 * stride]), box->inverse[2], box->low_offset[2]);
    const vreal high_x = loose_fma(splat(planes[3 * stride]), box->inverse[0], box->high_offset[0]);
    const vreal high_y = loose_fma(splat(planes[4 * stride]), box->inverse[1], box->high_offset[1]);
    const vreal high_z = loose_fma(splat(planes[5 * stride]), box->inverse[2], box->high_offset[2]);
    const vreal near =
        larger(larger(smaller(low_x, high_x), smaller(low_y, high_y)), larger(smaller(low_z, high_z), splat(0)));
    const vreal far =
        smaller(smaller(larger(low_x, high_x), larger(low_y, high_y)), smaller(larger(low_z, high_z), box->bound));
    return near <= far * SLAB_TOLERANCE;
}

/* The only group of a tree: each of its boxes against the rays of all lanes. Returns the number of visits. */
static uint visit_lone_group(const FlatTree *flat, const PacketBoxRay *box, Visit *visits) {
    vuint met = splat_uint(0);
    for (uint k = 0; k < flat->leaf_count; ++k)
        met |= choose_uint(meets_box(box, (const real *)flat->planes[0] + k, TREE_WIDTH), splat_uint(1u << k),
                           splat_uint(0));
    /* The first of each lane, the second of each lane, and so on: most have two at most. */
    uint count = 0;
    while (any_lane(vbool_of_uint(met != splat_uint(0)))) {
        LaneUints left;
        left.all = met;
        for (uint lane = 0; lane < LANE_COUNT; ++lane)
            count = add_visit(visits, count, lane, flat->first_leaf + lowest_bit(left.of[lane]), left.of[lane] != 0);
        met &= met - 1u;
    }
    return count;
}

/* The boxes of one group against the ray of each of `lanes`, first all tests and then the visits. Returns the number of
 * visits, of which there have been `count`. */
FORCE_INLINE static uint visit_group(const FlatTree *flat, uint group, uint lanes, const LaneBoxRays *boxes,
                                     const LaneRays *rays, Visit *visits, uint count) {
    const uint first = flat->first_leaf + group * TREE_WIDTH;
    uint tested[LANE_COUNT], tested_count = 0;
    child_mask met[LANE_COUNT];
    for (; lanes != 0; lanes &= lanes - 1u) {
        const uint lane = lowest_bit(lanes);
        const BoxRay box = box_ray_of_lane(boxes, lane);
        tested[tested_count] = lane;
        met[tested_count++] = test_group(flat, group, &box, rays->bound.of[lane]);
    }
    for (uint i = 0; i < tested_count; ++i) count = add_visits(visits, count, tested[i], first, met[i], 2);
    return count;
}

/* The leaves of a small tree: TREE_WIDTH boxes at a time, against each ray that meets the box around them. */
static void traverse_flat(const Geometry *geometry, const BoxAxis *axes, vbool active, vreal bound, LaneRays *rays) {
    const FlatTree *flat = &geometry->flat;
    const PacketBoxRay packet = packet_box_ray(axes, active, bound);
    Visit visits[VISITS_MAX + LANE_COUNT * TREE_WIDTH + 2];
    uint count = 0;
    if (flat->leaf_count <= TREE_WIDTH)
        count = visit_lone_group(flat, &packet, visits);
    else {
        LaneBoxRays boxes;
        store_box_axes(axes, &boxes);
        for (uint group = 0; group * TREE_WIDTH < flat->leaf_count; ++group) {
            const uint lanes = lane_bits(meets_box(&packet, flat->around[group], 1));
            count = visit_group(flat, group, lanes, &boxes, rays, visits, count);
            if (count < VISITS_MAX) continue;
            intersect_leaves(geometry, visits, count, rays);
            count = 0;
        }
    }
    intersect_leaves(geometry, visits, count, rays);
}

/* How far a walk through the tree has come: for each level the node entered, which of its child nodes are still to
 * be entered, and where the ray enters them. Nothing is sorted: the nearest child is looked for when it is wanted,
 * by a few steps without a branch. */
typedef struct Walk {
    uint depth; /* levels that have children left */
    uint node[TREE_DEPTH_MAX];
    child_mask left[TREE_DEPTH_MAX];
    vreal_node entry[TREE_DEPTH_MAX];
} Walk;

/* Returns which children are leaves that the ray meets before `bound`; nodes are left for later. */
static child_mask enter_node(const Geometry *geometry, const BoxRay *box, uint node, real bound, Walk *walk) {
    const uint level = walk->depth;
    const child_mask met = test_node(geometry, box, node, bound, &walk->entry[level]);
    const child_mask leaves = leaf_children(geometry, node);
    walk->node[level] = node;
    walk->left[level] = met & ~leaves;
    walk->depth = level + ((met & ~leaves) != 0);
    return met & leaves;
}

/* Takes the nearest child of the deepest level, of which there is one. Returns whether it is worth a visit, that is,
 * entered before `bound`; if not, nor is any other of its level, and they are gone. */
static int take_nearest(const Geometry *geometry, real bound, Walk *walk, uint *child) {
    const uint level = walk->depth - 1;
    const child_mask left = walk->left[level];
    real nearest;
    const uint lane = nearest_child(left, walk->entry[level], &nearest);
    *child = *place_in(geometry->children, walk->node[level] * TREE_WIDTH + lane);
    const int worth = nearest <= bound * SLAB_TOLERANCE;
    const child_mask rest = worth ? without_bit(left, lane) : 0;
    walk->left[level] = rest;
    walk->depth = level + (rest != 0);
    return worth;
}

static void traverse_nodes(const Geometry *geometry, const BoxAxis *axes, vbool active, LaneRays *rays) {
    LaneUints alive;
    alive.all = choose_uint(active, splat_uint(1), splat_uint(0));
    LaneBoxRays stored;
    store_box_axes(axes, &stored);
    BoxRay boxes[LANE_COUNT];
    Walk walks[LANE_COUNT];
    uint walking[LANE_COUNT + 1], walking_count = 0; /* lanes that are not through */
    Visit nodes[LANE_COUNT + 1], leaves[LANE_COUNT * TREE_WIDTH + 1];
    uint node_count = 0;
    for (uint lane = 0; lane < LANE_COUNT; ++lane) {
        boxes[lane] = box_ray_of_lane(&stored, lane);
        walks[lane].depth = 0;
        nodes[node_count].lane = walking[walking_count] = lane;
        nodes[node_count].what = 0;
        node_count += alive.of[lane];
        walking_count += alive.of[lane];
    }
    for (;;) {
        uint leaf_count = 0;
        for (uint i = 0; i < node_count; ++i) {
            const uint lane = nodes[i].lane;
            const uint first = nodes[i].what * TREE_WIDTH;
            child_mask met = enter_node(geometry, &boxes[lane], nodes[i].what, rays->bound.of[lane], &walks[lane]);
            /* One leaf or none is the rule. */
            leaves[leaf_count].lane = lane;
            leaves[leaf_count].what = *place_in(geometry->children, first + lowest_bit(met) % TREE_WIDTH) & ~CHILD_LEAF;
            read_leaf_ahead(geometry, leaves[leaf_count].what);
            leaf_count += met != 0;
            for (met = without_lowest_bit(met); met != 0; met = without_lowest_bit(met)) {
                leaves[leaf_count].lane = lane;
                leaves[leaf_count].what = *place_in(geometry->children, first + lowest_bit(met)) & ~CHILD_LEAF;
                read_leaf_ahead(geometry, leaves[leaf_count].what);
                ++leaf_count;
            }
        }
        intersect_leaves(geometry, leaves, leaf_count, rays);
        uint left = 0;
        node_count = 0;
        for (uint i = 0; i < walking_count; ++i) {
            const uint lane = walking[i];
            if (walks[lane].depth == 0) continue;
            walking[left++] = lane;
            nodes[node_count].lane = lane;
            node_count += take_nearest(geometry, rays->bound.of[lane], &walks[lane], &nodes[node_count].what);
        }
        walking_count = left;
        if (left == 0) return;
    }
}

#if EFFECT_TRIANGLES
static void store_shear(const Shear *shear, LaneRays *rays) {
    rays->turned_origin[0].all = shear->origin.x;
    rays->turned_origin[1].all = shear->origin.y;
    rays->turned_origin[2].all = shear->origin.z;
    rays->turned_low[0].all = shear->low.x;
    rays->turned_low[1].all = shear->low.y;
    rays->turned_low[2].all = shear->low.z;
    rays->turned_direction[0].all = shear->direction.x;
    rays->turned_direction[1].all = shear->direction.y;
    rays->turned_direction[2].all = shear->direction.z;
    rays->slope[0].all = shear->slope.x;
    rays->slope[1].all = shear->slope.y;
    rays->slope[2].all = shear->slope.z;
    rays->doubt.all = shear->doubt;
    rays->row.all = choose_uint(shear->along_x, splat_uint(TREE_WIDTH),
                                choose_uint(shear->along_y, splat_uint(2 * TREE_WIDTH), splat_uint(0)));
}
#endif

/* The spheres below the first leaves, against what the rays have hit so far. */
ON_CHAINS static void traverse_packet(const Geometry *geometry, const Ray *ray, WITH_SHEAR(const Shear *shear) vbool active, Hit *hit) {
    if (geometry->leaf_count == geometry->first_leaves) return;
    LaneRays rays;
    rays.high[0].all = ray->origin.high.x;
    rays.high[1].all = ray->origin.high.y;
    rays.high[2].all = ray->origin.high.z;
    rays.low[0].all = ray->origin.low.x;
    rays.low[1].all = ray->origin.low.y;
    rays.low[2].all = ray->origin.low.z;
    rays.direction[0].all = ray->direction.x;
    rays.direction[1].all = ray->direction.y;
    rays.direction[2].all = ray->direction.z;
    rays.origin_error.all = ray->origin.error;
    rays.cull_margin.all = ray->cull_margin;
    rays.own_slot.all = ray->own_slot;
#if EFFECT_OPACITY
    rays.passes.all = choose_uint(ray->passes, splat_uint(1), splat_uint(0));
#endif
#if EFFECT_MOTION
    rays.time.all = ray->time;
#endif
    rays.t.all = hit->t;
    rays.slot.all = hit->slot;
    rays.enters.all = choose_uint(hit->enters, splat_uint(1), splat_uint(0));
    rays.bound.all = hit->bound;
#if EFFECT_TRIANGLES
    store_shear(shear, &rays);
#endif
    BoxAxis axes[3];
    axes[0] = box_axis(ray->origin.high.x, ray->direction.x);
    axes[1] = box_axis(ray->origin.high.y, ray->direction.y);
    axes[2] = box_axis(ray->origin.high.z, ray->direction.z);
    if (geometry->flat.leaf_count > 0)
        traverse_flat(geometry, axes, active, hit->bound, &rays);
    else
        traverse_nodes(geometry, axes, active, &rays);
    hit->t = rays.t.all;
    hit->slot = rays.slot.all;
    hit->enters = vbool_of_uint(rays.enters.all != splat_uint(0));
    hit->bound = rays.bound.all;
}
#endif

#if EFFECT_TRIANGLES
static Vec3 vertex_for_all(__global const real *leaf) {
    return vec3(splat(leaf[0]), splat(leaf[TREE_WIDTH]), splat(leaf[2 * TREE_WIDTH]));
}

/* One leaf's triangles, one at a time, against all lanes. */
static void intersect_triangle_leaf(const Geometry *geometry, const Ray *ray, const Shear *shear, vbool active, uint leaf_number,
                                    Hit *hit) {
    __global const real *leaf = place_in(geometry->triangles, (leaf_number - geometry->first_triangles) * (9 * TREE_WIDTH));
    for (uint lane = 0; lane < TREE_WIDTH; ++lane) {
        if (*place_in(geometry->slot_sphere, leaf_number * TREE_WIDTH + lane) == NO_SPHERE) break; /* the rest is empty */
        const vuint slot = splat_uint(leaf_number * TREE_WIDTH + lane);
        Triangle triangle;
        triangle.a = vertex_for_all(leaf + lane);
        triangle.b = vertex_for_all(leaf + 3 * TREE_WIDTH + lane);
        triangle.c = vertex_for_all(leaf + 6 * TREE_WIDTH + lane);
        const Triangle turned = turn_triangle(shear, &triangle);
        vbool candidate = active & triangle_is_candidate(shear, hit->bound, &turned);
#if SAMPLES_LAMPS
        candidate = candidate & vbool_of_uint(hit->slot != slot);
#endif
#if !OWN_SHAPE_IS_MET
        candidate = candidate & vbool_of_uint(ray->own_slot != slot);
#endif
        if (any_lane(candidate)) intersect_triangle(geometry, ray, shear, candidate, &triangle, slot, hit);
    }
}
#endif

/* One leaf's spheres, one at a time, against all lanes. */
ON_CHAINS static void intersect_leaf(const Geometry *geometry, const Ray *ray, WITH_SHEAR(const Shear *shear) vbool active,
                           uint leaf_number, Hit *hit) {
#if EFFECT_TRIANGLES
    if (leaf_number >= geometry->first_triangles) {
        intersect_triangle_leaf(geometry, ray, shear, active, leaf_number, hit);
        return;
    }
#endif
#if SPHERES_MET
    __global const real *leaf = place_in(geometry->leaves, leaf_number * (4 * TREE_WIDTH));
    for (uint lane = 0; lane < TREE_WIDTH; ++lane) {
        if (leaf[3 * TREE_WIDTH + lane] <= 0) break; /* the rest of the leaf is empty */
        const vuint slot = splat_uint(leaf_number * TREE_WIDTH + lane);
        Sphere sphere;
        sphere.centre = vec3(splat(leaf[lane]), splat(leaf[TREE_WIDTH + lane]), splat(leaf[2 * TREE_WIDTH + lane]));
        sphere.radius = splat(leaf[3 * TREE_WIDTH + lane]);
#if EFFECT_MOTION
        __global const real *motion = place_in(geometry->leaf_motions, leaf_number * (3 * TREE_WIDTH)) + lane;
        sphere.centre = madd3(ray->time, vec3(splat(motion[0]), splat(motion[TREE_WIDTH]), splat(motion[2 * TREE_WIDTH])),
                              sphere.centre);
#endif
        vbool wanted = active;
#if SAMPLES_LAMPS
        wanted = wanted & vbool_of_uint(hit->slot != slot);
#endif
#if EFFECT_CAPSULES
        __global const real *axes = place_in(geometry->leaf_axes, leaf_number * (6 * TREE_WIDTH)) + lane;
        sphere.axis = vec3(splat(axes[0]), splat(axes[TREE_WIDTH]), splat(axes[2 * TREE_WIDTH]));
        vbool candidate = capsule_is_candidate(ray, hit->bound, &sphere);
#else
        vbool candidate = sphere_is_candidate(ray, hit->bound, &sphere);
#endif
#if !OWN_SHAPE_IS_MET
        candidate = candidate & vbool_of_uint(ray->own_slot != slot);
#endif
        candidate = candidate & wanted;
#if EFFECT_CAPSULES
        if (any_lane(candidate)) choose_ball(ray, vbool_none, &sphere);
#endif
        if (any_lane(candidate)) intersect_sphere(geometry, ray, candidate, &sphere, slot, hit);
    }
#endif
}

/* The closest hit of every ray that is `active`, if it is closer than what the ray has hit already. The few huge
 * spheres, which most rays meet, are tried against all lanes at once; then each lane searches the tree within the bound
 * that they leave. */
FORCE_INLINE ON_CHAINS static Hit intersect_closer(const Geometry *geometry, const Ray *ray, vbool active, Hit hit) {
#if SPHERES_MET
    intersect_own_sphere(geometry, ray, active, &hit);
#endif
#if EFFECT_TRIANGLES
    const Shear at_triangles = shear_at_triangles(geometry, ray);
    const Shear *const shear = &at_triangles;
#endif
    for (uint leaf = 0; leaf < geometry->first_leaves; ++leaf)
        intersect_leaf(geometry, ray, WITH_SHEAR(shear) active, leaf, &hit);
#if ACCELERATION_TREE
    traverse_packet(geometry, ray, WITH_SHEAR(shear) active, &hit);
#endif
    return hit;
}

/* The closest hit of every ray that is `active`. */
ON_CHAINS static Hit intersect_closest(const Geometry *geometry, const Ray *ray, vbool active) {
    return intersect_closer(geometry, ray, active, no_hit(REAL_LARGE));
}
