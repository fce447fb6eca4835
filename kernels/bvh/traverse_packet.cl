/* traverse_packet.cl: the tree for the paths of all lanes at once.
 *
 * In:    paths and what they have met so far (huge spheres, the sphere being left).
 * Out:   the closest hit of each, the same as intersect_closest_one (traverse_single.cl) finds.
 * Knows: traverse_single.cl's steps for one ray.   Does not know: what rays are for.
 *
 * What a ray does next depends on what it met, and a processor that guesses wrong throws away more work than a box
 * test is. So rays take turns, a round for all: first every ray that stands at a node tests it, then the leaves met
 * there, then what they found is refined, then each ray chooses the node to go to. Within a step nothing depends on
 * the step before of the same ray: no branch to guess, and memory is fetched for many rays at a time.
 *
 * A tree of few leaves needs no walk: the boxes of all its leaves are tested, one after the other, against all
 * lanes. */
#if EFFECT_TREE

/* Lane `lane` is to visit a node, a leaf or a sphere's slot. */
typedef struct Visit {
    uint lane, what;
} Visit;

#define BATCH_LEAVES 32u /* one bit each */
#define BATCHES_MAX 3u
#define FOUND_MAX 64u

/* Some leaves and their boxes. */
typedef struct FlatBatch {
    uint count;
    uint leaf[BATCH_LEAVES];
    real planes[BATCH_LEAVES][6]; /* low x, y, z, high x, y, z */
} FlatBatch;

/* The leaves of a tree that has few, below the first ones; no batches: it has too many. */
typedef struct FlatTree {
    uint batch_count;
    FlatBatch batches[BATCHES_MAX];
} FlatTree;

static void flatten_tree(const Geometry *geometry, FlatTree *flat) {
    const uint wanted = geometry->leaf_count - geometry->first_leaves;
    flat->batch_count = 0;
    if (wanted > BATCHES_MAX * BATCH_LEAVES) return;
    uint count = 0;
    for (uint node = 0; count < wanted; ++node) {
        for (uint lane = 0; lane < TREE_WIDTH; ++lane) {
            __global const real *plane = geometry->boxes + node * (6 * TREE_WIDTH) + lane;
            const uint child = geometry->children[node * TREE_WIDTH + lane];
            if ((child & CHILD_LEAF) == 0 || plane[0] > plane[3 * TREE_WIDTH]) continue;
            FlatBatch *batch = &flat->batches[count / BATCH_LEAVES];
            const uint place = count % BATCH_LEAVES;
            batch->leaf[place] = child & ~CHILD_LEAF;
            for (uint row = 0; row < 6; ++row) batch->planes[place][row] = plane[row * TREE_WIDTH];
            batch->count = place + 1;
            ++count;
        }
    }
    flat->batch_count = (wanted + BATCH_LEAVES - 1) / BATCH_LEAVES;
}

/* The rays of all lanes, and what each has met. */
typedef struct LaneRays {
    real high[3][LANE_COUNT], low[3][LANE_COUNT], direction[3][LANE_COUNT];
    real origin_error[LANE_COUNT], cull_margin[LANE_COUNT];
    uint own_slot[LANE_COUNT];
    refined t[LANE_COUNT];
    uint slot[LANE_COUNT], enters[LANE_COUNT];
    real bound[LANE_COUNT];
} LaneRays;

/* Written out: a loop over axes is not always unrolled, and then the ray passes through memory. */
static Ray_one ray_of_lane(const LaneRays *rays, uint lane) {
    Ray_one ray;
    ray.high[0] = rays->high[0][lane];
    ray.high[1] = rays->high[1][lane];
    ray.high[2] = rays->high[2][lane];
    ray.low[0] = rays->low[0][lane];
    ray.low[1] = rays->low[1][lane];
    ray.low[2] = rays->low[2][lane];
    ray.direction[0] = rays->direction[0][lane];
    ray.direction[1] = rays->direction[1][lane];
    ray.direction[2] = rays->direction[2][lane];
    ray.origin_error = rays->origin_error[lane];
    ray.cull_margin = rays->cull_margin[lane];
    ray.own_slot = rays->own_slot[lane];
    ray.inward = 0; /* that has been seen to */
    return ray;
}

static void intersect_slot_of_lane(const Geometry *geometry, LaneRays *rays, uint lane, uint slot) {
    const Ray_one ray = ray_of_lane(rays, lane);
    Hit_one hit;
    hit.t = rays->t[lane];
    hit.slot = rays->slot[lane];
    hit.enters = (int)rays->enters[lane];
    hit.bound = rays->bound[lane];
    intersect_slot_one(geometry, &ray, slot, &hit);
    rays->t[lane] = hit.t;
    rays->slot[lane] = hit.slot;
    rays->enters[lane] = (uint)hit.enters;
    rays->bound[lane] = hit.bound;
}

/* Visits leaves and decides about the spheres that may be met there. */
static void intersect_leaves(const Geometry *geometry, const Visit *visits, uint count, LaneRays *rays) {
    Visit found[FOUND_MAX + TREE_WIDTH];
    uint found_count = 0;
    for (uint i = 0; i < count; ++i) {
        const uint lane = visits[i].lane, first = visits[i].what * TREE_WIDTH;
        const Ray_one ray = ray_of_lane(rays, lane);
        child_mask candidates = leaf_candidates(geometry, &ray, visits[i].what, rays->bound[lane]);
        /* One candidate or none is the rule: noted without asking which. */
        found[found_count].lane = lane;
        found[found_count].what = first + lowest_bit(candidates);
        found_count += candidates != 0;
        for (candidates = without_lowest_bit(candidates); candidates != 0; candidates = without_lowest_bit(candidates)) {
            found[found_count].lane = lane;
            found[found_count].what = first + lowest_bit(candidates);
            ++found_count;
        }
        if (found_count < FOUND_MAX && i + 1 < count) continue;
        for (uint k = 0; k < found_count; ++k) intersect_slot_of_lane(geometry, rays, found[k].lane, found[k].what);
        found_count = 0;
    }
}

/* The leaves of one batch, against all lanes; a bound below 0 switches a lane off. */
static void traverse_batch(const Geometry *geometry, const FlatBatch *batch, const LANED(BoxAxis) *axes, vreal bound,
                        LaneRays *rays) {
    /* Lanes differ in which plane of a pair they meet first. */
    vreal low_offset[3], high_offset[3];
    for (uint axis = 0; axis < 3; ++axis) {
        const vbool backwards = axes[axis].inverse < splat(0);
        low_offset[axis] = choose(backwards, axes[axis].far_offset, axes[axis].near_offset);
        high_offset[axis] = choose(backwards, axes[axis].near_offset, axes[axis].far_offset);
    }
    vuint met = splat_uint(0);
    for (uint k = 0; k < batch->count; ++k) {
        const real *planes = batch->planes[k];
        const vreal low_x = fma(splat(planes[0]), axes[0].inverse, low_offset[0]);
        const vreal low_y = fma(splat(planes[1]), axes[1].inverse, low_offset[1]);
        const vreal low_z = fma(splat(planes[2]), axes[2].inverse, low_offset[2]);
        const vreal high_x = fma(splat(planes[3]), axes[0].inverse, high_offset[0]);
        const vreal high_y = fma(splat(planes[4]), axes[1].inverse, high_offset[1]);
        const vreal high_z = fma(splat(planes[5]), axes[2].inverse, high_offset[2]);
        const vreal near = larger(larger(smaller(low_x, high_x), smaller(low_y, high_y)),
                                  larger(smaller(low_z, high_z), splat(0)));
        const vreal far = smaller(smaller(larger(low_x, high_x), larger(low_y, high_y)),
                                  smaller(larger(low_z, high_z), bound));
        met |= choose_uint(near <= far * SLAB_TOLERANCE, splat_uint(1u << k), splat_uint(0));
    }
    /* The first of each lane, the second of each lane, and so on: most have two at most. */
    Visit visits[LANE_COUNT * BATCH_LEAVES + 1];
    uint count = 0;
    while (any_lane(vbool_of_uint(met != splat_uint(0)))) {
        uint left[LANE_COUNT];
        store_lanes(met, left);
        for (uint lane = 0; lane < LANE_COUNT; ++lane) {
            visits[count].lane = lane;
            visits[count].what = batch->leaf[lowest_bit(left[lane]) % BATCH_LEAVES];
            count += left[lane] != 0;
        }
        met &= met - 1u;
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
    wide entry[TREE_DEPTH_MAX];
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
    const wide entry = choose_children(left, walk->entry[level], REAL_MAX);
    const real nearest = least_of_children(entry);
    const uint lane = lowest_bit(child_mask_of(entry == (wide)nearest));
    *child = geometry->children[walk->node[level] * TREE_WIDTH + lane];
    const int worth = nearest <= bound * SLAB_TOLERANCE;
    const child_mask rest = worth ? without_bit(left, lane) : 0;
    walk->left[level] = rest;
    walk->depth = level + (rest != 0);
    return worth;
}

static void traverse_nodes(const Geometry *geometry, const LANED(BoxAxis) *axes, const uint *alive,
                             LaneRays *rays) {
    real inverse[3][LANE_COUNT], near_offset[3][LANE_COUNT], far_offset[3][LANE_COUNT];
    for (uint axis = 0; axis < 3; ++axis) {
        store_lanes(axes[axis].inverse, inverse[axis]);
        store_lanes(axes[axis].near_offset, near_offset[axis]);
        store_lanes(axes[axis].far_offset, far_offset[axis]);
    }
    BoxRay boxes[LANE_COUNT];
    Walk walks[LANE_COUNT];
    uint walking[LANE_COUNT + 1], walking_count = 0; /* lanes that are not through */
    Visit nodes[LANE_COUNT + 1], leaves[LANE_COUNT * TREE_WIDTH + 1];
    uint node_count = 0;
    for (uint lane = 0; lane < LANE_COUNT; ++lane) {
        for (uint axis = 0; axis < 3; ++axis)
            set_box_axis(&boxes[lane], axis, inverse[axis][lane], near_offset[axis][lane], far_offset[axis][lane]);
        walks[lane].depth = 0;
        nodes[node_count].lane = walking[walking_count] = lane;
        nodes[node_count].what = 0;
        node_count += alive[lane];
        walking_count += alive[lane];
    }
    for (;;) {
        uint leaf_count = 0;
        for (uint i = 0; i < node_count; ++i) {
            const uint lane = nodes[i].lane;
            const uint first = nodes[i].what * TREE_WIDTH;
            child_mask met = enter_node(geometry, &boxes[lane], nodes[i].what, rays->bound[lane], &walks[lane]);
            /* One leaf or none is the rule. */
            leaves[leaf_count].lane = lane;
            leaves[leaf_count].what = geometry->children[first + lowest_bit(met) % TREE_WIDTH] & ~CHILD_LEAF;
            leaf_count += met != 0;
            for (met = without_lowest_bit(met); met != 0; met = without_lowest_bit(met)) {
                leaves[leaf_count].lane = lane;
                leaves[leaf_count].what = geometry->children[first + lowest_bit(met)] & ~CHILD_LEAF;
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
            node_count += take_nearest(geometry, rays->bound[lane], &walks[lane], &nodes[node_count].what);
        }
        walking_count = left;
        if (left == 0) return;
    }
}

/* The spheres below the first leaves, against what the paths have met so far. */
static void traverse_packet(const Geometry *geometry, const FlatTree *flat, const Path *path, vreal margin, vreal bound,
                         Hit *hit) {
    if (geometry->leaf_count == geometry->first_leaves) return;
    LaneRays rays;
    uint alive[LANE_COUNT];
    store_lanes(path->origin.high.x, rays.high[0]);
    store_lanes(path->origin.high.y, rays.high[1]);
    store_lanes(path->origin.high.z, rays.high[2]);
    store_lanes(path->origin.low.x, rays.low[0]);
    store_lanes(path->origin.low.y, rays.low[1]);
    store_lanes(path->origin.low.z, rays.low[2]);
    store_lanes(path->direction.x, rays.direction[0]);
    store_lanes(path->direction.y, rays.direction[1]);
    store_lanes(path->direction.z, rays.direction[2]);
    store_lanes(path->origin.error, rays.origin_error);
    store_lanes(margin, rays.cull_margin);
    store_lanes(path->own_slot, rays.own_slot);
    store_lanes(hit->t, rays.t);
    store_lanes(hit->slot, rays.slot);
    store_lanes(choose_uint(hit->enters, splat_uint(1), splat_uint(0)), rays.enters);
    store_lanes(bound, rays.bound);
    store_lanes(choose_uint(path->alive, splat_uint(1), splat_uint(0)), alive);
    LANED(BoxAxis) axes[3];
    axes[0] = LANED(box_axis)(path->origin.high.x, path->direction.x);
    axes[1] = LANED(box_axis)(path->origin.high.y, path->direction.y);
    axes[2] = LANED(box_axis)(path->origin.high.z, path->direction.z);
    if (flat->batch_count > 0) {
        for (uint batch = 0; batch < flat->batch_count; ++batch)
            traverse_batch(geometry, &flat->batches[batch], axes, choose(path->alive, load_lanes(rays.bound), splat(-1)), &rays);
    } else
        traverse_nodes(geometry, axes, alive, &rays);
    hit->t = load_lanes(rays.t);
    hit->slot = load_lanes(rays.slot);
    hit->enters = vbool_of_uint(load_lanes(rays.enters) != splat_uint(0));
}
#endif
