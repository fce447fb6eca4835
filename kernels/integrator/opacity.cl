/* opacity.cl: surfaces that let a share of all paths straight on, and what paths and rays to lights meet behind them.
 *
 * In:    rays; a number for each path and segment.   Out: the first hit that stops the path, the rest of the ray that leads there, and
 *        what such surfaces leave of light along a ray.
 * Knows: the closest hit, the shapes by one function each, path_state.cl.   Does not know: what surfaces scatter, where lamps are.
 *
 * A surface of opacity o lets a path on with the probability 1 - o, as if there were none: no segment ends there, nothing is seen or
 * scattered, and the path keeps its vertex. One number u decides for all surfaces of a segment: the path goes on while u is below the
 * product of what they let through. So a path passes the first n of them with just that probability. A ray to a light brings that
 * product of its light, which has the same mean without chance.
 *
 * The rest of a ray leaves the surface on the other side, by the rule by which light leaves glass: without an epsilon. */
#if EFFECT_OPACITY
/* Below this share rays to lights end: 2^-64. */
#define LEFT_MIN R(0x1p-64)

/* Takes the rays of the lanes `passing` on to where they have met something, and beyond. */
static void go_behind(const Geometry *geometry, const Hit *hit, vbool passing, Ray *ray) {
    const vuint slot = choose_uint(passing, hit->slot, splat_uint(0));
    Point point = ray->origin;
    Vec3 outward = ray->direction;
#if SPHERES_MET && EFFECT_TRIANGLES
    const vbool round = vbool_not(is_triangle(geometry, slot));
    const Sphere sphere = sphere_for_ray(geometry, ray, choose_uint(round, slot, splat_uint(0)));
    sphere_surface(ray, &sphere, slot, hit->t, hit->enters, &point, &outward);
#elif SPHERES_MET
    const Sphere sphere = sphere_for_ray(geometry, ray, slot);
    sphere_surface(ray, &sphere, slot, hit->t, hit->enters, &point, &outward);
#endif
#if EFFECT_TRIANGLES
#if SHARES_KNOWN
    Shares shares;
#endif
    surface_of_triangle(geometry, ray, hit, passing, WITH_SHARES(&shares) &point, &outward);
#endif
    ray->origin.high = choose3(passing, point.high, ray->origin.high);
    ray->origin.low = choose3(passing, point.low, ray->origin.low);
    ray->origin.error = choose(passing, point.error, ray->origin.error);
    ray->cull_margin = cull_margin_of(&ray->origin);
    ray->own_slot = choose_uint(passing, slot, ray->own_slot);
    ray->inward = (passing & hit->enters) | (vbool_not(passing) & ray->inward);
    ray->passes = ray->passes | passing;
}

static void choose_hit(vbool mask, const Hit *from, Hit *to) {
    to->t = choose_refined(mask, from->t, to->t);
    to->slot = choose_uint(mask, from->slot, to->slot);
    to->enters = (mask & from->enters) | (vbool_not(mask) & to->enters);
    to->bound = choose(mask, from->bound, to->bound);
}

/* The last piece of a ray: what is left of it behind the last surface that let it through, and its hit. */
typedef struct Piece {
    Ray ray;
    Hit hit;
} Piece;

/* What stops the paths, from where their rays begin. Bounce b is that of `first_dimension(path->depth)`. */
static Hit intersect_opaque(const Geometry *geometry, const Path *path, const Ray *ray, vbool moving, Piece *last) {
    const vuint dimension = first_dimension(path->depth) + BOUNCE_OPACITY;
    Hit hit = no_hit(REAL_LARGE);
    vrefined behind = splat_refined(0);
    vreal left = splat(1), number = splat(0);
    vbool open = moving;
    last->ray = *ray;
    last->hit = hit;
    for (uint surfaces = 0;; ++surfaces) {
        const Hit next = intersect_closest(geometry, &last->ray, open);
        choose_hit(open, &next, &last->hit);
        choose_hit(open, &next, &hit);
        const vbool met = open & is_hit(&next);
        hit.t = choose_refined(met, behind + next.t, hit.t);
        const vreal share = let_through(geometry, choose_uint(met, next.slot, splat_uint(0)));
        open = met & (share > splat(0));
        if (!any_lane(open)) return hit;
        /* Together a number of 48 bits, so that many surfaces let through what they should. */
        if (surfaces == 0)
            number = fma(uniform(path->key, dimension + OPACITY_REFILL), splat(R(0x1p-24)), sample_1d(path->key, dimension));
        left = choose(open, left * share, left);
        open = open & (number < left) & (left > splat(LEFT_MIN));
        if (!any_lane(open)) return hit;
        behind = choose_refined(open, behind + next.t, behind);
        go_behind(geometry, &next, open, &last->ray);
    }
}

#if SAMPLES_CAUSTICS
/* The lanes of `active` whose ray comes to `expected`, which is known to lie on it; *weight: what surfaces before that leave. Behind one
 * of them, distances are rounded anew: then the shape tells, and the side that it is met from. */
static vbool sees_through(const Geometry *geometry, const Ray *ray, vbool active, const Hit *expected, Vec3 *weight) {
    Ray rest = *ray;
    Hit goal = *expected;
    vbool seen = vbool_none;
    Vec3 left = *weight;
    for (uint surfaces = 0;; ++surfaces) {
        const Hit first = intersect_closer(geometry, &rest, active, goal);
        vbool there = active & vbool_of_uint(first.slot == goal.slot);
        if (surfaces == 0) there = there & vbool_of_refined(first.t == goal.t);
        else there = there & ((first.enters & expected->enters) | vbool_not(first.enters | expected->enters));
        seen = seen | there;
        const vbool other = active & vbool_of_uint(first.slot != goal.slot);
        const vreal share = let_through(geometry, choose_uint(other, first.slot, splat_uint(0)));
        active = other & (share > splat(0)) & (left.x + left.y + left.z > splat(LEFT_MIN));
        if (!any_lane(active)) break;
        left = choose3(active, scale3(share, left), left);
        goal.t = choose_refined(active, goal.t - first.t, goal.t);
        goal.bound = choose(active, upper_bound(goal.t), goal.bound);
        go_behind(geometry, &first, active, &rest);
    }
    *weight = choose3(seen, left, *weight);
    return seen;
}
#endif

/* A lamp in a slot is seen by what its surface stops. */
#define SEEN_OF_LAMP(scene, slot, radiance) scale3(splat(1) - let_through(&(scene)->geometry, slot), radiance)
#define WITH_LEFT(weight) weight,
#define PIECE(name) Piece name;
#define LAST_RAY(ray, last) (&(last).ray)
#define LAST_HIT(hit, last) (&(last).hit)
#else
#define SEEN_OF_LAMP(scene, slot, radiance) radiance
#define WITH_LEFT(weight)
#define PIECE(name)
#define LAST_RAY(ray, last) &ray
#define LAST_HIT(hit, last) &hit
#define intersect_opaque(geometry, path, ray, moving, last) intersect_closest(geometry, ray, moving)
#endif
