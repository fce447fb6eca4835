/* capsule_robust.cl: where a ray meets a capsule, all points within a radius of a line between two ends: a ball on that
 * line is chosen, and what remains is the code of spheres (sphere_robust.cl).
 *
 * In:    a ray, and a Sphere around the first end with the axis from there to the other; no axis: a sphere.
 * Out:   capsule_is_candidate  may the ray meet it before `bound`? Quick; what it rules out is surely not met.
 *        choose_ball           the ball on the axis that the ray meets first, from outside, or leaves last, from inside.
 *        ball_at_origin        the one that is closest to the ray's origin.
 *        Spheres stay as they are, to the bit.
 * Knows: sphere_robust.cl, wide.cl.   Does not know: trees, materials. Read once for each number of lanes.
 *
 * Where a line enters a ball is a convex function of the ball's place on the axis, so the ball that is entered first stands
 * at the place where the line enters the cylinder, or at an end where that lies beyond it. The ball touches the capsule
 * there from inside, so an error of the place counts as its square. */
#if EFFECT_CAPSULES
#define has_axis LANED(has_axis)
#define be_sphere LANED(be_sphere)
#define capsule_is_candidate LANED(capsule_is_candidate)
#define stand_on_axis LANED(stand_on_axis)
#define within_axis LANED(within_axis)
#define as_wide LANED(as_wide)
#define choose_ball LANED(choose_ball)
#define ball_at_origin LANED(ball_at_origin)

#undef AXIS_PARALLEL
#define AXIS_PARALLEL R(1e-20) /* the squared sine below which a ray counts as parallel to an axis */

static vbool has_axis(const Sphere *sphere) {
    return (sphere->axis.x != splat(0)) | (sphere->axis.y != splat(0)) | (sphere->axis.z != splat(0));
}

/* Nothing else than a sphere: what is added to -0 keeps all its bits. */
static void be_sphere(Sphere *sphere) {
    sphere->axis = zero3();
    sphere->low = vec3(splat(R(-0.0)), splat(R(-0.0)), splat(R(-0.0)));
    sphere->is_capsule = sphere->inside = sphere->beyond = sphere->at_wall = vbool_none;
}

/* By the ball around the point of the axis that is nearest to the ray's line; all of the capsule lies within a radius of
 * where its ends project to. p, l and the place err by less than margin = 96 u (|p| + |along| + r) + the ray's own margin
 * (u = ROUNDOFF); of the hits in tests/hard/test_capsules.c none is ruled out. */
FORCE_INLINE static vbool capsule_is_candidate(const Ray *ray, vreal bound, const Sphere *capsule) {
    const Vec3 to_end = subtract3(capsule->centre, ray->origin.high), axis = capsule->axis;
    const vreal p = loose_dot3(to_end, ray->direction), along = loose_dot3(axis, ray->direction);
    const Vec3 l = loose_madd3(-p, ray->direction, to_end), across = loose_madd3(-along, ray->direction, axis);
    const vreal square = larger(loose_dot3(across, across), splat(R(1e-37)));
    const vreal nearest = loose_divide(-loose_dot3(l, across), square);
    const vreal place = smaller(larger(nearest, splat(0)), splat(1));
    const Vec3 off = loose_madd3(place, across, l);
    const vreal margin =
        loose_fma(splat(R(96.0) * ROUNDOFF), fabs(p) + fabs(along) + capsule->radius, ray->cull_margin);
    const vreal reach = capsule->radius + margin;
    const vreal room = loose_fma(reach, reach, -loose_dot3(off, off));
    const vreal first = p + smaller(along, splat(0)), last = p + larger(along, splat(0));
    return (room >= splat(0)) & (last + reach >= splat(0)) & (first - reach <= bound);
}

static WideVec as_wide(Vec3 v) {
    WideVec w;
    w.x = wide(v.x);
    w.y = wide(v.y);
    w.z = wide(v.z);
    return w;
}

static Wide within_axis(Wide place) {
    const Wide from = wide_choose(wide_above_0(place), place, wide(splat(0)));
    return wide_choose(wide_above_0(wide_add_real(from, splat(-1))), wide(splat(1)), from);
}

/* Moves the centre of what has an axis to a place on it, from 0 to 1. */
static void stand_on_axis(Wide place, Sphere *capsule) {
    const vbool moves = has_axis(capsule);
    Vec3 high, low;
    wide_split(wide_add_real(wide_multiply(place, wide(capsule->axis.x)), capsule->centre.x), &high.x, &low.x);
    wide_split(wide_add_real(wide_multiply(place, wide(capsule->axis.y)), capsule->centre.y), &high.y, &low.y);
    wide_split(wide_add_real(wide_multiply(place, wide(capsule->axis.z)), capsule->centre.z), &high.z, &low.z);
    capsule->centre = choose3(moves, high, capsule->centre);
    capsule->low = choose3(moves, low, vec3(splat(R(-0.0)), splat(R(-0.0)), splat(R(-0.0))));
    capsule->beyond = moves & wide_above_0(wide_add_real(place, splat(R(-0.5))));
}

/* `left`: the ray leaves it into its inside. Notation: m, from the origin to the first end; q, the part of m across the axis,
 * and p that of the direction; the line is closest to the axis at t = q.p / p.p. Inside is decided as of spheres, by the
 * power of the origin in the ball closest to it. */
FORCE_INLINE static void choose_ball(const Ray *ray, vbool left, Sphere *capsule) {
    capsule->is_capsule = has_axis(capsule);
    capsule->inside = capsule->beyond = capsule->at_wall = vbool_none;
    capsule->low = vec3(splat(R(-0.0)), splat(R(-0.0)), splat(R(-0.0)));
    if (!any_lane(capsule->is_capsule)) return;
    const WideVec d = as_wide(ray->direction), axis = as_wide(capsule->axis);
    const vreal r = capsule->radius;
    WideVec m;
    m.x = wide_difference(capsule->centre.x, ray->origin.high.x, ray->origin.low.x);
    m.y = wide_difference(capsule->centre.y, ray->origin.high.y, ray->origin.low.y);
    m.z = wide_difference(capsule->centre.z, ray->origin.high.z, ray->origin.low.z);
    const Wide one = wide(splat(1)), nothing = wide(splat(0));
    const Wide inverse = wide_divide(one, wide_choose(capsule->is_capsule, wide_dot(axis, axis), one));
    const Wide of_d = wide_multiply(wide_dot(d, axis), inverse), of_m = wide_multiply(wide_dot(m, axis), inverse);
    const Wide less_d = wide_negative(of_d), less_m = wide_negative(of_m);
    const WideVec p = wide_madd3(less_d, axis, d), q = wide_madd3(less_m, axis, m);
    const WideVec from_axis = wide_madd3(within_axis(less_m), axis, m);
    const Wide square = wide_multiply(wide(r), wide(r));
    const vreal power = wide_near(wide_add(wide_dot(from_axis, from_axis), wide_negative(square)));
    capsule->inside = (left & ray->inward) | (vbool_not(left) & (power < R(-2.0) * r * ray->origin.error));
    const Wide sine2 = wide_dot(p, p);
    const vbool parallel = vbool_not(wide_above_0(wide_add_real(sine2, -splat(AXIS_PARALLEL))));
    const Wide inverse2 = wide_divide(one, wide_choose(parallel, one, sine2));
    const Wide closest = wide_multiply(wide_dot(p, q), inverse2);
    const WideVec l = wide_madd3(wide_negative(closest), p, q);
    const Wide room = wide_multiply(wide_add(square, wide_negative(wide_dot(l, l))), inverse2);
    const Wide half_chord = wide_root(wide_choose(wide_above_0(room), room, nothing));
    const Wide t = wide_add(closest, wide_choose(capsule->inside, half_chord, wide_negative(half_chord)));
    const vbool last = parallel & ((wide_above_0(of_d) & capsule->inside) | (wide_below_0(of_d) & vbool_not(capsule->inside)));
    const Wide end = wide_choose(last, one, nothing);
    const Wide place = wide_madd(t, of_d, less_m);
    const vbool between = wide_above_0(place) & wide_below_0(wide_add_real(place, splat(-1)));
    capsule->at_wall = capsule->is_capsule & wide_above_0(room) & between & vbool_not(parallel);
    stand_on_axis(wide_choose(parallel, end, within_axis(place)), capsule);
    capsule->inside = capsule->inside & capsule->is_capsule;
}

static void ball_at_origin(const Ray *ray, Sphere *capsule) {
    const WideVec axis = as_wide(capsule->axis);
    WideVec way;
    way.x = wide_negative(wide_difference(capsule->centre.x, ray->origin.high.x, ray->origin.low.x));
    way.y = wide_negative(wide_difference(capsule->centre.y, ray->origin.high.y, ray->origin.low.y));
    way.z = wide_negative(wide_difference(capsule->centre.z, ray->origin.high.z, ray->origin.low.z));
    const Wide length2 = wide_choose(has_axis(capsule), wide_dot(axis, axis), wide(splat(1)));
    stand_on_axis(within_axis(wide_divide(wide_dot(way, axis), length2)), capsule);
}
#endif
