/* intersect.cl: what the paths of all lanes meet next.
 *
 * In:    paths, geometry.   Out: for each lane the closest hit, as intersect_closest_one (traverse_single.cl) has it.
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
static void keep_closer(vbool found, vrefined t, vuint slot, vuint sphere, vbool enters, Hit *hit) {
    const vbool closer = found & (vbool_of_refined(t < hit->t) |
                                (vbool_of_refined(t == hit->t) & vbool_of_uint(sphere < hit->sphere)));
    hit->t = choose_refined(closer, t, hit->t);
    hit->slot = choose_uint(closer, slot, hit->slot);
    hit->sphere = choose_uint(closer, sphere, hit->sphere);
    hit->enters = (closer & enters) | (vbool_not(closer) & hit->enters);
}

#if NUMERICS_ROBUST
/* The spheres being left, met again from inside. */
static void intersect_own_sphere(const Geometry *geometry, const Path *path, Hit *hit) {
    const vbool inward = path->alive & path->inward;
    if (!any_lane(inward)) return;
    const vuint slot = choose_uint(inward, path->own_slot, splat_uint(0));
    const vuint lane = slot % TREE_WIDTH;
    const vuint place = (slot - lane) * 4u + lane;
    const Point *origin = &path->origin;
    const LANED(Roots) roots = LANED(sphere_roots)(
        origin->high.x, origin->high.y, origin->high.z, origin->low.x, origin->low.y, origin->low.z, path->direction.x,
        path->direction.y, path->direction.z, gather_real(geometry->leaves, place),
        gather_real(geometry->leaves, place + (uint)TREE_WIDTH),
        gather_real(geometry->leaves, place + (uint)(2 * TREE_WIDTH)),
        gather_real(geometry->leaves, place + (uint)(3 * TREE_WIDTH)));
    keep_closer(inward, LANED(chord)(roots), slot, gather_uint(geometry->slot_sphere, slot),
                      splat(0) != splat(0), hit);
}
#endif

/* One leaf's spheres, one at a time, against all lanes of `active`. The margin is that of intersect_leaf_one in traverse_single.cl. */
static void intersect_leaf(const Geometry *geometry, const Path *path, vbool active, vreal cull_margin,
                            uint leaf_number, Hit *hit) {
    const Point *origin = &path->origin;
    const Vec3 direction = path->direction;
    __global const real *leaf = geometry->leaves + leaf_number * (4 * TREE_WIDTH);
    for (uint lane = 0; lane < TREE_WIDTH; ++lane) {
        if (leaf[3 * TREE_WIDTH + lane] <= 0) continue;
        const uint slot = leaf_number * TREE_WIDTH + lane;
        const vreal radius = splat(leaf[3 * TREE_WIDTH + lane]);
        const Vec3 centre = vec3(splat(leaf[lane]), splat(leaf[TREE_WIDTH + lane]), splat(leaf[2 * TREE_WIDTH + lane]));
        const Vec3 oc = subtract3(centre, origin->high);
        const vreal p = dot3(oc, direction);
        const Vec3 across = madd3(-p, direction, oc);
#if NUMERICS_ROBUST
        const vreal margin = fma(splat(R(64.0) * ROUNDOFF), fabs(p) + radius, cull_margin);
        const vreal reach = radius + margin;
        const vreal room = fma(reach, reach, -dot3(across, across));
        const vreal outside = at_least(at_least(-p, p - bound_of(hit)) - margin, splat(0));
        const vbool candidate =
            (room >= outside * outside) & active & vbool_of_uint(path->own_slot != splat_uint(slot));
        if (!any_lane(candidate)) continue;
        const LANED(Roots) roots = LANED(sphere_roots)(origin->high.x, origin->high.y, origin->high.z, origin->low.x,
                                                       origin->low.y, origin->low.z, direction.x, direction.y,
                                                       direction.z, centre.x, centre.y, centre.z, radius);
        vrefined t;
        vbool enters;
        const vbool found = LANED(choose_root)(roots, radius, origin->error, &t, &enters) & candidate;
#else
        const vreal discriminant = fma(radius, radius, -dot3(across, across));
        const vreal half_chord = sqrt(at_least(discriminant, splat(0)));
        const vbool enters = p - half_chord > splat(PLAIN_T_MIN);
        const vreal t = choose(enters, p - half_chord, p + half_chord);
        const vbool found = (discriminant >= splat(0)) & (t > splat(PLAIN_T_MIN)) & active;
#endif
        keep_closer(found, t, splat_uint(slot), splat_uint(geometry->slot_sphere[slot]), enters, hit);
    }
}

/* How far the rounding of the rays' origins, and their slack, can move a distance. */
static vreal cull_margin(const Point *origin) {
    return fma(fabs(origin->high.x) + fabs(origin->high.y) + fabs(origin->high.z), splat(R(4.0) * ROUNDOFF),
               origin->error);
}

static Hit intersect_closest(const Scene *scene, const Path *path) {
    const Geometry *geometry = &scene->geometry;
    Hit hit;
    hit.t = splat_refined(REAL_LARGE);
    hit.slot = splat_uint(NO_SLOT);
    hit.sphere = splat_uint(NO_SPHERE);
    hit.enters = splat(0) != splat(0);
    const vreal margin = cull_margin(&path->origin);
#if NUMERICS_ROBUST
    intersect_own_sphere(geometry, path, &hit);
#endif
    for (uint leaf = 0; leaf < geometry->first_leaves; ++leaf)
        intersect_leaf(geometry, path, path->alive, margin, leaf, &hit);
#if EFFECT_TREE
    traverse_packet(geometry, &scene->flat, path, margin, bound_of(&hit), &hit);
#endif
    hit.met = vbool_of_uint(hit.slot != splat_uint(NO_SLOT));
    return hit;
}
#else
static Hit intersect_closest(const Scene *scene, const Path *path) {
    Ray_one ray;
    ray.high[0] = path->origin.high.x;
    ray.high[1] = path->origin.high.y;
    ray.high[2] = path->origin.high.z;
    ray.low[0] = path->origin.low.x;
    ray.low[1] = path->origin.low.y;
    ray.low[2] = path->origin.low.z;
    ray.direction[0] = path->direction.x;
    ray.direction[1] = path->direction.y;
    ray.direction[2] = path->direction.z;
    ray.origin_error = path->origin.error;
    ray.cull_margin = cull_margin_one(&ray);
    ray.own_slot = path->own_slot;
    ray.inward = path->inward;
    const Hit_one found = intersect_closest_one(&scene->geometry, &ray);
    Hit hit;
    hit.t = found.t;
    hit.met = found.slot != NO_SLOT;
    hit.enters = found.enters;
    hit.slot = found.slot;
    return hit;
}
#endif
