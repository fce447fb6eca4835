/* traverse_single.cl: the one interface to the spheres: intersect_closest_one and intersect_any_one, for one ray.
 *
 * In:    a ray; packed leaves, and nodes when EFFECT_TREE.
 * Out:   the hit of least (distance, sphere index), so list and tree, and any order of visits, agree to the bit.
 * Knows: nodes, leaves, slots.   Does not know: materials, what made the ray.
 *
 * Boxes and spheres are tested TREE_WIDTH at a time, conservatively in `real`; what cannot be ruled out is decided
 * by sphere_robust.cl, one sphere at a time. traverse_packet.cl walks the same tree for many rays, by the same steps. */

typedef struct Geometry {
    __global const real *boxes;
    __global const uint *children;
    __global const real *leaves;
    __global const uint *slot_sphere;
    uint first_leaves, leaf_count;
} Geometry;

typedef struct Ray_one {
    real high[3], low[3]; /* origin, an unevaluated sum */
    real direction[3];    /* |d| = 1 within 4 ROUNDOFF */
    real origin_error;           /* bound on the distance of the origin from its true place */
    real cull_margin;          /* bound on what the rounding of the origin does to a distance: cull_margin_one */
    uint own_slot;        /* the sphere being left, or NO_SLOT */
    int inward;           /* it is left into its inside */
} Ray_one;

typedef struct Hit_one {
    refined t;
    uint slot;  /* NO_SLOT: nothing was met */
    int enters; /* from outside to inside */
    real bound; /* not below t: what prunes */
} Hit_one;

/* t rounded up to a real. */
static real upper_bound(refined t) { return (real)t * (R(1.0) + R(4.0) * ROUNDOFF); }

static void keep_closer_one(const Geometry *geometry, refined t, uint slot, int enters, Hit_one *best) {
    if (t < best->t || (t == best->t && best->slot != NO_SLOT &&
                        geometry->slot_sphere[slot] < geometry->slot_sphere[best->slot])) {
        best->t = t;
        best->slot = slot;
        best->enters = enters;
        best->bound = upper_bound(t);
    }
}

/* How far the rounding of a ray's origin, and its slack, can move what leaf_candidates computes. */
static real cull_margin_one(const Ray_one *ray) {
    return fma(fabs(ray->high[0]) + fabs(ray->high[1]) + fabs(ray->high[2]), R(4.0) * ROUNDOFF, ray->origin_error);
}

/* The spheres of a leaf that the ray may meet before `bound`; the rest of them it surely does not. TREE_WIDTH at a
 * time, without a branch. */
FORCE_INLINE static child_mask leaf_candidates(const Geometry *geometry, const Ray_one *ray, uint leaf_number, real bound) {
    __global const real *leaf = geometry->leaves + leaf_number * (4 * TREE_WIDTH);
    const wide ocx = load_wide(0, leaf) - ray->high[0];
    const wide ocy = load_wide(1, leaf) - ray->high[1];
    const wide ocz = load_wide(2, leaf) - ray->high[2];
    const wide radius = load_wide(3, leaf);
    const wide dx = (wide)ray->direction[0], dy = (wide)ray->direction[1], dz = (wide)ray->direction[2];
    const wide p = fma(ocx, dx, fma(ocy, dy, ocz * dz));
    const wide lx = fma(-p, dx, ocx), ly = fma(-p, dy, ocy), lz = fma(-p, dz, ocz);
#if NUMERICS_ROBUST
    /* The sphere is met before `bound` only if sqrt(r^2 - l^2) >= max(-p, p - bound); p and l err by less than half
     * of margin = 64 u (|p| + r) + ray->cull_margin (u = ROUNDOFF, |d|^2 = 1 within 28 u). docs/NUMERICS.md proves that
     * nothing is ruled out wrongly. */
    const wide margin = fma((wide)(R(64.0) * ROUNDOFF), fabs(p) + radius, (wide)ray->cull_margin);
    const wide reach = radius + margin;
    const wide room = fma(reach, reach, -fma(lx, lx, fma(ly, ly, lz * lz)));
    const wide behind = -p, beyond = p - bound;
    wide outside = (behind > beyond ? behind : beyond) - margin;
    outside = outside > (wide)0 ? outside : (wide)0;
    const child_mask candidates = child_mask_of((room >= outside * outside) & (radius > (wide)0));
    /* The sphere being left is not met from outside, and from inside it has been (intersect_own_sphere_one). */
    const child_mask own = ray->own_slot / TREE_WIDTH == leaf_number ? (child_mask)1 << ray->own_slot % TREE_WIDTH : 0;
    return candidates & ~own;
#else
    const wide discriminant = fma(radius, radius, -fma(lx, lx, fma(ly, ly, lz * lz)));
    const wide half_chord = sqrt(discriminant > (wide)0 ? discriminant : (wide)0);
    const wide near = p - half_chord, far = p + half_chord;
    const wide t = near > (wide)PLAIN_T_MIN ? near : far;
    return child_mask_of((discriminant >= (wide)0) & (t > (wide)PLAIN_T_MIN) & (t <= (wide)bound) & (radius > (wide)0));
#endif
}

/* Decides about a candidate. */
FORCE_INLINE static void intersect_slot_one(const Geometry *geometry, const Ray_one *ray, uint slot, Hit_one *best) {
    const uint lane = slot % TREE_WIDTH;
    __global const real *leaf = geometry->leaves + (slot - lane) * 4;
    const real x = leaf[lane], y = leaf[TREE_WIDTH + lane], z = leaf[2 * TREE_WIDTH + lane];
    const real radius = leaf[3 * TREE_WIDTH + lane];
#if NUMERICS_ROBUST
    const Roots_one roots =
        sphere_roots_one(ray->high[0], ray->high[1], ray->high[2], ray->low[0], ray->low[1], ray->low[2],
                       ray->direction[0], ray->direction[1], ray->direction[2], x, y, z, radius);
    refined t;
    int enters;
    if (choose_root_one(roots, radius, ray->origin_error, &t, &enters)) keep_closer_one(geometry, t, slot, enters, best);
#else
    /* The perpendicular form in `real`; a root counts from PLAIN_T_MIN on (sphere_plain.cl says what that costs). */
    const real ocx = x - ray->high[0], ocy = y - ray->high[1], ocz = z - ray->high[2];
    const real dx = ray->direction[0], dy = ray->direction[1], dz = ray->direction[2];
    const real p = fma(ocx, dx, fma(ocy, dy, ocz * dz));
    const real lx = fma(-p, dx, ocx), ly = fma(-p, dy, ocy), lz = fma(-p, dz, ocz);
    const real discriminant = fma(radius, radius, -fma(lx, lx, fma(ly, ly, lz * lz)));
    const real half_chord = sqrt(discriminant > 0 ? discriminant : 0);
    const real near = p - half_chord, far = p + half_chord;
    const int enters = near > PLAIN_T_MIN;
    keep_closer_one(geometry, enters ? near : far, slot, enters, best);
#endif
}

FORCE_INLINE static void intersect_leaf_one(const Geometry *geometry, const Ray_one *ray, uint leaf_number, Hit_one *best) {
    for (child_mask candidates = leaf_candidates(geometry, ray, leaf_number, best->bound); candidates != 0;
         candidates = without_lowest_bit(candidates))
        intersect_slot_one(geometry, ray, leaf_number * TREE_WIDTH + lowest_bit(candidates), best);
}

#if EFFECT_TREE
/* The three axes of box_ray.cl, and which of the six rows of a node hold the planes that are met first and last. */
typedef struct BoxRay {
    real inverse[3], near_offset[3], far_offset[3];
    uint near_row[3], far_row[3]; /* in vreal from the node's first */
} BoxRay;

static void set_box_axis(BoxRay *box, uint axis, real inverse, real near_offset, real far_offset) {
    box->inverse[axis] = inverse;
    box->near_offset[axis] = near_offset;
    box->far_offset[axis] = far_offset;
    box->near_row[axis] = (inverse < 0 ? axis + 3 : axis) * TREE_WIDTH;
    box->far_row[axis] = (inverse < 0 ? axis : axis + 3) * TREE_WIDTH;
}

static BoxRay box_ray(const Ray_one *ray) {
    BoxRay box;
    for (uint axis = 0; axis < 3; ++axis) {
        const BoxAxis_one found = box_axis_one(ray->high[axis], ray->direction[axis]);
        set_box_axis(&box, axis, found.inverse, found.near_offset, found.far_offset);
    }
    return box;
}

/* A whole row, by its address: rows are aligned to their own size, and an offset that the compiler knows not to wrap
 * makes it one load. */
static wide row_of(__global const real *planes, uint row) { return *(__global const wide *)(planes + (size_t)row); }

/* 1/d errs by 5u at most, which scales a side of a box, and the products by u more. */
#define SLAB_TOLERANCE (R(1.0) + R(16.0) * ROUNDOFF)

/* The children of `node` that the ray meets before `bound`, and where it enters them. */
static child_mask test_node(const Geometry *geometry, const BoxRay *box, uint node, real bound, wide *entry) {
    __global const real *planes = geometry->boxes + node * (6 * TREE_WIDTH);
    /* Written out, axis by axis: a loop is not always unrolled. */
    const wide enter_x = fma(row_of(planes, box->near_row[0]), (wide)box->inverse[0], (wide)box->near_offset[0]);
    const wide enter_y = fma(row_of(planes, box->near_row[1]), (wide)box->inverse[1], (wide)box->near_offset[1]);
    const wide enter_z = fma(row_of(planes, box->near_row[2]), (wide)box->inverse[2], (wide)box->near_offset[2]);
    const wide leave_x = fma(row_of(planes, box->far_row[0]), (wide)box->inverse[0], (wide)box->far_offset[0]);
    const wide leave_y = fma(row_of(planes, box->far_row[1]), (wide)box->inverse[1], (wide)box->far_offset[1]);
    const wide leave_z = fma(row_of(planes, box->far_row[2]), (wide)box->inverse[2], (wide)box->far_offset[2]);
    const wide enter_xy = enter_x > enter_y ? enter_x : enter_y;
    const wide enter_z0 = enter_z > (wide)0 ? enter_z : (wide)0;
    const wide near = enter_xy > enter_z0 ? enter_xy : enter_z0;
    const wide leave_xy = leave_x < leave_y ? leave_x : leave_y;
    const wide leave_zb = leave_z < (wide)bound ? leave_z : (wide)bound;
    const wide far = leave_xy < leave_zb ? leave_xy : leave_zb;
    *entry = near;
    return child_mask_of(near <= far * SLAB_TOLERANCE);
}

/* Which children of a node are leaves. */
static child_mask leaf_children(const Geometry *geometry, uint node) {
    const WIDE(uint) words = JOIN(vload, TREE_WIDTH)(node, geometry->children);
    return child_mask_of(JOIN(convert_, WIDE(REAL_MASK))((words & (WIDE(uint))CHILD_LEAF) != (WIDE(uint))0));
}

#define STACK_SIZE (TREE_DEPTH_MAX * (TREE_WIDTH - 1) + 1)

FORCE_INLINE static void traverse_tree_one(const Geometry *geometry, const Ray_one *ray, int any, Hit_one *best) {
    const BoxRay box = box_ray(ray);
    uint stack_child[STACK_SIZE];
    real stack_entry[STACK_SIZE];
    real entries[TREE_WIDTH];
    uint top = 0;
    uint node = 0;
    for (;;) {
        wide entry;
        child_mask met = test_node(geometry, &box, node, best->bound, &entry);
        JOIN(vstore, TREE_WIDTH)(entry, 0, entries);
        /* Leaves at once, in any order: to sort them costs more than it spares. */
        const child_mask leaves = leaf_children(geometry, node);
        for (child_mask now = met & leaves; now != 0; now = without_lowest_bit(now)) {
            const uint child = geometry->children[node * TREE_WIDTH + lowest_bit(now)];
            intersect_leaf_one(geometry, ray, child & ~CHILD_LEAF, best);
            if (any && best->slot != NO_SLOT) return;
        }
        /* Nodes onto the stack, the nearest on top. */
        met &= ~leaves;
        const uint base = top;
        for (; met != 0; met = without_lowest_bit(met)) {
            const uint lane = lowest_bit(met);
            const real lane_entry = entries[lane];
            uint place = top;
            while (place > base && stack_entry[place - 1] < lane_entry) {
                stack_entry[place] = stack_entry[place - 1];
                stack_child[place] = stack_child[place - 1];
                --place;
            }
            stack_entry[place] = lane_entry;
            stack_child[place] = geometry->children[node * TREE_WIDTH + lane];
            ++top;
        }
        do {
            if (top == 0) return;
            --top;
        } while (stack_entry[top] > best->bound * SLAB_TOLERANCE);
        node = stack_child[top];
    }
}
#endif

/* Everything but the sphere being left. `best` brings a bound and perhaps a hit along. */
static void traverse_one(const Geometry *geometry, const Ray_one *ray, int any, Hit_one *best) {
#if EFFECT_TREE
    for (uint leaf = 0; leaf < geometry->first_leaves; ++leaf) intersect_leaf_one(geometry, ray, leaf, best);
    traverse_tree_one(geometry, ray, any, best);
#else
    for (uint leaf = 0; leaf < geometry->leaf_count; ++leaf) intersect_leaf_one(geometry, ray, leaf, best);
#endif
}

/* Nothing met yet, within `limit`. */
static Hit_one no_hit_one(refined limit) {
    Hit_one hit;
    hit.t = limit;
    hit.slot = NO_SLOT;
    hit.enters = 0;
    hit.bound = upper_bound(limit);
    return hit;
}

/* The sphere being left, met again from inside. Plain numerics meet it like any other. */
static void intersect_own_sphere_one(const Geometry *geometry, const Ray_one *ray, Hit_one *best) {
#if NUMERICS_ROBUST
    if (ray->own_slot == NO_SLOT || !ray->inward) return;
    const uint lane = ray->own_slot % TREE_WIDTH;
    __global const real *leaf = geometry->leaves + (ray->own_slot - lane) * 4;
    const Roots_one roots =
        sphere_roots_one(ray->high[0], ray->high[1], ray->high[2], ray->low[0], ray->low[1], ray->low[2],
                       ray->direction[0], ray->direction[1], ray->direction[2], leaf[lane], leaf[TREE_WIDTH + lane],
                       leaf[2 * TREE_WIDTH + lane], leaf[3 * TREE_WIDTH + lane]);
    keep_closer_one(geometry, chord_one(roots), ray->own_slot, 0, best);
#endif
}

/* The closest hit: least (t, sphere index). */
FORCE_INLINE static Hit_one intersect_closest_one(const Geometry *geometry, const Ray_one *ray) {
    Hit_one best = no_hit_one(REAL_LARGE);
    intersect_own_sphere_one(geometry, ray, &best);
    traverse_one(geometry, ray, 0, &best);
    return best;
}

/* Whether anything lies within distance `limit`; which one is left open. */
static int intersect_any_one(const Geometry *geometry, const Ray_one *ray, refined limit) {
    Hit_one best = no_hit_one(limit);
    Hit_one own = best;
    intersect_own_sphere_one(geometry, ray, &own);
    if (own.slot != NO_SLOT && own.t < limit) return 1;
    traverse_one(geometry, ray, 1, &best);
    return best.slot != NO_SLOT;
}
