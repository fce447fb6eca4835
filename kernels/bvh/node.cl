/* node.cl: a node's children, a small tree's leaves and what a leaf holds, TREE_WIDTH of them at once, against one ray.
 *
 * In:    a ray, packed nodes and leaves.   Out: which of them the ray may meet before a bound, as a child_mask.
 * Knows: how nodes and leaves are packed; flat_tree.cl; the interface of shape/.   Does not know: when nodes are visited.
 *
 * The tests are conservative and in `real`: what they cannot rule out is decided by sphere_intersect, one sphere at a
 * time. */

typedef vreal vreal_node; /* for code that has other lanes */

/* The same ray in every lane. */
static Ray ray_for_all(const Ray_one *one) {
    Ray ray;
    ray.origin.high = vec3(splat(one->origin.high.x), splat(one->origin.high.y), splat(one->origin.high.z));
    ray.origin.low = vec3(splat(one->origin.low.x), splat(one->origin.low.y), splat(one->origin.low.z));
    ray.origin.error = splat(one->origin.error);
    ray.direction = vec3(splat(one->direction.x), splat(one->direction.y), splat(one->direction.z));
    ray.cull_margin = splat(one->cull_margin);
    ray.own_slot = splat_uint(one->own_slot);
    ray.inward = (vbool)(one->inward ? -1 : 0);
#if EFFECT_OPACITY
    ray.passes = (vbool)(one->passes ? -1 : 0);
#endif
#if EFFECT_MOTION
    ray.time = splat(one->time);
#endif
    return ray;
}

/* A whole row, by its address: rows are aligned to their own size, and an offset that the compiler knows not to wrap
 * makes it one load. */
static vreal row_of(__global const real *rows, uint row) { return *(__global const vreal *)(rows + (size_t)row); }

#if EFFECT_TRIANGLES
/* One ray at the triangles of leaves, whose rows are chosen so that they come turned. */
typedef struct LeafShear {
    real origin[3], slope[3], margin;
    uint row[3]; /* of the first vertex's turned x, y and z, in reals from the leaf's first */
} LeafShear;

/* The row of the turned x: turn3 by numbers. */
static uint turned_row(const Shear_one *shear) {
    return (shear->along_x ? 1u : shear->along_y ? 2u : 0u) * (uint)TREE_WIDTH;
}

/* What follows from the first. */
static void set_rows(LeafShear *shear, uint row) {
    shear->row[0] = row;
    shear->row[1] = row == 2 * TREE_WIDTH ? 0 : row + TREE_WIDTH;
    shear->row[2] = row == 0 ? 2 * TREE_WIDTH : row - TREE_WIDTH;
}

static LeafShear leaf_shear(const Shear_one *one) {
    LeafShear shear;
    shear.origin[0] = one->origin.x;
    shear.origin[1] = one->origin.y;
    shear.origin[2] = one->origin.z;
    shear.slope[0] = one->slope.x;
    shear.slope[1] = one->slope.y;
    shear.slope[2] = one->slope.z;
    shear.margin = one->margin;
    set_rows(&shear, turned_row(one));
    return shear;
}

static Vec3 vertex_of_leaf(__global const real *leaf, const LeafShear *shear, uint first) {
    return vec3(row_of(leaf, first + shear->row[0]), row_of(leaf, first + shear->row[1]), row_of(leaf, first + shear->row[2]));
}

/* The triangles of a leaf that the ray may meet before `bound`. An empty lane has its vertices at NaN, so no
 * comparison holds. */
FORCE_INLINE static child_mask triangle_candidates(const Geometry *geometry, const LeafShear *one, uint leaf_number,
                                                   real bound) {
    __global const real *leaf = place_in(geometry->triangles, (leaf_number - geometry->first_triangles) * (9 * TREE_WIDTH));
    Shear shear;
    shear.origin = vec3(splat(one->origin[0]), splat(one->origin[1]), splat(one->origin[2]));
    shear.slope = vec3(splat(one->slope[0]), splat(one->slope[1]), splat(one->slope[2]));
    shear.margin = splat(one->margin);
    Triangle turned;
    turned.a = vertex_of_leaf(leaf, one, 0);
    turned.b = vertex_of_leaf(leaf, one, 3 * TREE_WIDTH);
    turned.c = vertex_of_leaf(leaf, one, 6 * TREE_WIDTH);
    child_mask mask = lane_bits(triangle_is_candidate(&shear, splat(bound), &turned));
#ifdef __FAST_RELAXED_MATH__
    /* Here a compiler may take a NaN for a number. */
    const vuint shapes = *(__global const vuint *)place_in(geometry->slot_sphere, leaf_number * TREE_WIDTH);
    mask &= lane_bits(vbool_of_uint(shapes != splat_uint(NO_SPHERE)));
#endif
    return mask;
}
#endif

#if SPHERES_MET
/* The spheres of a leaf that the ray may meet before `bound`, without a branch. */
FORCE_INLINE static child_mask leaf_candidates(const Geometry *geometry, const Ray_one *one, uint leaf_number,
                                               real bound) {
    __global const real *leaf = place_in(geometry->leaves, leaf_number * (4 * TREE_WIDTH));
    const Ray ray = ray_for_all(one);
    Sphere sphere;
    sphere.centre.x = row_of(leaf, 0);
    sphere.centre.y = row_of(leaf, TREE_WIDTH);
    sphere.centre.z = row_of(leaf, 2 * TREE_WIDTH);
    sphere.radius = row_of(leaf, 3 * TREE_WIDTH);
#if EFFECT_MOTION
    __global const real *motion = place_in(geometry->leaf_motions, leaf_number * (3 * TREE_WIDTH));
    sphere.centre.x = fma(ray.time, row_of(motion, 0), sphere.centre.x);
    sphere.centre.y = fma(ray.time, row_of(motion, TREE_WIDTH), sphere.centre.y);
    sphere.centre.z = fma(ray.time, row_of(motion, 2 * TREE_WIDTH), sphere.centre.z);
#endif
    /* An empty lane has its centre at NaN, so no comparison holds. */
#if EFFECT_CAPSULES
    __global const real *axes = place_in(geometry->leaf_axes, leaf_number * (6 * TREE_WIDTH));
    sphere.axis = vec3(row_of(axes, 0), row_of(axes, TREE_WIDTH), row_of(axes, 2 * TREE_WIDTH));
    child_mask mask = lane_bits(capsule_is_candidate(&ray, splat(bound), &sphere));
#else
    child_mask mask = lane_bits(sphere_is_candidate(&ray, splat(bound), &sphere));
#endif
#ifdef __FAST_RELAXED_MATH__
    mask &= lane_bits(sphere.radius > splat(0)); /* here a compiler may take a NaN for a number */
#endif
    return mask;
}
#endif

/* Leaves out of a leaf's candidates the sphere or triangle that the ray starts from, if it is not met that way, and the one in
 * `known_slot`: the ray has met it already, or is sent to it. */
static child_mask without_known(child_mask candidates, uint leaf_number, uint own_slot, uint known_slot) {
#if !OWN_SHAPE_IS_MET
    const uint own = own_slot - leaf_number * TREE_WIDTH;
    candidates &= ~(own < TREE_WIDTH ? (child_mask)1 << own : (child_mask)0);
#endif
#if SAMPLES_LAMPS
    return known_slot / TREE_WIDTH == leaf_number ? without_bit(candidates, known_slot % TREE_WIDTH) : candidates;
#else
    return candidates; /* nothing is met twice */
#endif
}

/* Asks for a leaf that will be visited soon: many leaves are then on their way at a time. */
static void read_leaf_ahead(const Geometry *geometry, uint leaf_number) {
#if EFFECT_TRIANGLES
    if (leaf_number >= geometry->first_triangles) {
        __global const real *ahead =
            place_in(geometry->triangles, (leaf_number - geometry->first_triangles) * (9 * TREE_WIDTH));
        for (uint i = 0; i < 9 * TREE_WIDTH; i += LINE_BYTES / sizeof(real)) READ_AHEAD(ahead + i);
        return;
    }
#endif
    __global const real *leaf = place_in(geometry->leaves, leaf_number * (4 * TREE_WIDTH));
    for (uint i = 0; i < 4 * TREE_WIDTH; i += LINE_BYTES / sizeof(real)) READ_AHEAD(leaf + i);
}

#if ACCELERATION_TREE
/* The three axes of box_ray.cl, and which of the six rows of a node hold the planes that are met first and last. */
typedef struct BoxRay {
    real inverse[3], near_offset[3], far_offset[3];
    uint near_row[3], far_row[3]; /* in reals from the node's first */
} BoxRay;

static void set_box_axis(BoxRay *box, uint axis, real inverse, real near_offset, real far_offset) {
    box->inverse[axis] = inverse;
    box->near_offset[axis] = near_offset;
    box->far_offset[axis] = far_offset;
    box->near_row[axis] = (inverse < 0 ? axis + 3 : axis) * TREE_WIDTH;
    box->far_row[axis] = (inverse < 0 ? axis : axis + 3) * TREE_WIDTH;
}

static BoxRay box_ray(const Ray_one *ray) {
    const BoxAxis_one x = box_axis_one(ray->origin.high.x, ray->direction.x);
    const BoxAxis_one y = box_axis_one(ray->origin.high.y, ray->direction.y);
    const BoxAxis_one z = box_axis_one(ray->origin.high.z, ray->direction.z);
    BoxRay box;
    set_box_axis(&box, 0, x.inverse, x.near_offset, x.far_offset);
    set_box_axis(&box, 1, y.inverse, y.near_offset, y.far_offset);
    set_box_axis(&box, 2, z.inverse, z.near_offset, z.far_offset);
    return box;
}

/* 1/d errs by 5u at most (6u in the embedded profile), which scales a side of a box, and the products by u more. */
#define SLAB_TOLERANCE (R(1.0) + R(16.0) * ROUNDOFF)

/* The boxes that the ray meets before `bound`, and where it enters them, by the planes that it meets first and last. */
FORCE_INLINE static child_mask test_boxes(const BoxRay *box, vreal near_x, vreal near_y, vreal near_z, vreal far_x,
                                          vreal far_y, vreal far_z, real bound, vreal *entry) {
    const vreal enter_x = loose_fma(near_x, splat(box->inverse[0]), splat(box->near_offset[0]));
    const vreal enter_y = loose_fma(near_y, splat(box->inverse[1]), splat(box->near_offset[1]));
    const vreal enter_z = loose_fma(near_z, splat(box->inverse[2]), splat(box->near_offset[2]));
    const vreal leave_x = loose_fma(far_x, splat(box->inverse[0]), splat(box->far_offset[0]));
    const vreal leave_y = loose_fma(far_y, splat(box->inverse[1]), splat(box->far_offset[1]));
    const vreal leave_z = loose_fma(far_z, splat(box->inverse[2]), splat(box->far_offset[2]));
    const vreal enter_xy = larger(enter_x, enter_y);
    const vreal enter_z0 = larger(enter_z, splat(0));
    const vreal near = larger(enter_xy, enter_z0);
    const vreal leave_xy = smaller(leave_x, leave_y);
    const vreal leave_zb = smaller(leave_z, splat(bound));
    const vreal far = smaller(leave_xy, leave_zb);
    *entry = near;
    return lane_bits(near <= far * SLAB_TOLERANCE);
}

/* The children of `node` that the ray meets before `bound`, and where it enters them. */
static child_mask test_node(const Geometry *geometry, const BoxRay *box, uint node, real bound, vreal *entry) {
    __global const real *planes = place_in(geometry->node_boxes, node * (6 * TREE_WIDTH));
    return test_boxes(box, row_of(planes, box->near_row[0]), row_of(planes, box->near_row[1]),
                      row_of(planes, box->near_row[2]), row_of(planes, box->far_row[0]), row_of(planes, box->far_row[1]),
                      row_of(planes, box->far_row[2]), bound, entry);
}

#ifdef FLAT_GROUPS_MAX
/* row_of, of the work-item's own copy. */
static vreal flat_row_of(const real *rows, uint row) { return *(const vreal *)(rows + (size_t)row); }

/* The leaves of a group that the ray meets before `bound`. */
FORCE_INLINE static child_mask test_group(const FlatTree *flat, uint group, const BoxRay *box, real bound) {
    const real *planes = (const real *)flat->planes[group];
    vreal entry;
    return test_boxes(box, flat_row_of(planes, box->near_row[0]), flat_row_of(planes, box->near_row[1]),
                      flat_row_of(planes, box->near_row[2]), flat_row_of(planes, box->far_row[0]),
                      flat_row_of(planes, box->far_row[1]), flat_row_of(planes, box->far_row[2]), bound, &entry);
}
#endif

/* Which children of a node are leaves. */
static child_mask leaf_children(const Geometry *geometry, uint node) {
    const vuint words = *(__global const vuint *)place_in(geometry->children, node * TREE_WIDTH);
    return lane_bits(vbool_of_uint((words & splat_uint(CHILD_LEAF)) != splat_uint(0)));
}

/* `inside` for the children in the mask, `outside` for the others. */
static vreal choose_children(child_mask mask, vreal inside, real outside) {
    const vbool chosen = vbool_of_uint((splat_uint(mask) & (splat_uint(1) << LANE_NUMBERS)) != splat_uint(0));
    return choose(chosen, inside, splat(outside));
}

/* The least of all lanes. */
static real least_of_children(vreal x) {
#if TREE_WIDTH == 16
    const JOIN(REAL, 8) eight = x.lo < x.hi ? x.lo : x.hi;
    const JOIN(REAL, 4) four = eight.lo < eight.hi ? eight.lo : eight.hi;
#elif TREE_WIDTH == 8
    const JOIN(REAL, 4) four = x.lo < x.hi ? x.lo : x.hi;
#elif TREE_WIDTH == 4
    const JOIN(REAL, 4) four = x;
#endif
#if TREE_WIDTH >= 4
    const JOIN(REAL, 2) two = four.lo < four.hi ? four.lo : four.hi;
#else
    const JOIN(REAL, 2) two = x;
#endif
    return two.x < two.y ? two.x : two.y;
}

/* The first of the children in the mask, of which there is one, that is entered first, and where. */
static uint nearest_child(child_mask mask, vreal entry, real *nearest) {
    const vreal entries = choose_children(mask, entry, REAL_MAX);
    *nearest = least_of_children(entries);
    return lowest_bit(lane_bits(entries == splat(*nearest)));
}
#endif
