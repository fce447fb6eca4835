/* capsule_plain.cl: where a ray meets a capsule, with --numerics plain: the ball on its axis that the ray meets, in `real`.
 *
 * Balls far away or nearly along the ray stand off their places, so outlines fray. It is here as the yardstick of what robustness
 * costs.
 *
 * In and out: the interface of capsule_robust.cl.
 * Knows: sphere_plain.cl.   Does not know: trees, materials. Read once for each number of lanes. */
#if EFFECT_CAPSULES
#define has_axis LANED(has_axis)
#define be_sphere LANED(be_sphere)
#define capsule_is_candidate LANED(capsule_is_candidate)
#define stand_on_axis LANED(stand_on_axis)
#define choose_ball LANED(choose_ball)
#define ball_at_origin LANED(ball_at_origin)

static vbool has_axis(const Sphere *sphere) {
    return (sphere->axis.x != splat(0)) | (sphere->axis.y != splat(0)) | (sphere->axis.z != splat(0));
}

static void be_sphere(Sphere *sphere) {
    sphere->axis = zero3();
    sphere->is_capsule = sphere->inside = sphere->beyond = vbool_none;
}

static void stand_on_axis(vreal place, Vec3 first, Sphere *capsule) {
    const vreal within = at_most(at_least(place, splat(0)), splat(1));
    capsule->centre = choose3(capsule->is_capsule, madd3(within, capsule->axis, first), first);
    capsule->beyond = capsule->is_capsule & (within > splat(R(0.5)));
}

/* First the ball that the line enters first; where that lies behind, the one that it leaves last. */
FORCE_INLINE static void choose_ball(const Ray *ray, vbool own, Sphere *capsule) {
    capsule->is_capsule = has_axis(capsule);
    capsule->inside = capsule->beyond = vbool_none;
    if (!any_lane(capsule->is_capsule)) return;
    const Vec3 axis = capsule->axis, d = ray->direction, first = capsule->centre;
    const Vec3 m = subtract3(first, ray->origin.high);
    const vreal inverse = divide(splat(1), choose(capsule->is_capsule, dot3(axis, axis), splat(1)));
    const vreal of_d = dot3(d, axis) * inverse, of_m = dot3(m, axis) * inverse;
    const Vec3 p = madd3(-of_d, axis, d), q = madd3(-of_m, axis, m);
    const vreal sine2 = dot3(p, p);
    const vbool parallel = vbool_not(sine2 > splat(R(1e-12)));
    const vreal inverse2 = divide(splat(1), choose(parallel, splat(1), sine2));
    const vreal closest = dot3(p, q) * inverse2;
    const Vec3 l = madd3(-closest, p, q);
    const vreal half_chord = square_root(at_least(fma(capsule->radius, capsule->radius, -dot3(l, l)) * inverse2, splat(0)));
    const vreal upward = choose(of_d > splat(0), splat(1), splat(0));
    stand_on_axis(choose(parallel, splat(1) - upward, fma(closest - half_chord, of_d, -of_m)), first, capsule);
    vreal near, far;
    sphere_roots(ray, capsule, &near, &far);
    const vbool inside = capsule->is_capsule & vbool_not(near > splat(PLAIN_T_MIN));
    if (!any_lane(inside)) return;
    const Sphere entered = *capsule;
    stand_on_axis(choose(parallel, upward, fma(closest + half_chord, of_d, -of_m)), first, capsule);
    capsule->centre = choose3(inside, capsule->centre, entered.centre);
    capsule->beyond = (inside & capsule->beyond) | (vbool_not(inside) & entered.beyond);
    capsule->inside = inside;
}

#if MEDIA_IN_CAPSULES
static void ball_at_origin(const Ray *ray, Sphere *capsule) {
    const Vec3 first = capsule->centre, way = subtract3(ray->origin.high, first);
    capsule->is_capsule = has_axis(capsule);
    const vreal length2 = choose(capsule->is_capsule, dot3(capsule->axis, capsule->axis), splat(1));
    stand_on_axis(divide(dot3(way, capsule->axis), length2), first, capsule);
}
#endif

FORCE_INLINE static vbool capsule_is_candidate(const Ray *ray, vreal bound, const Sphere *capsule) {
    Sphere ball = *capsule;
    choose_ball(ray, vbool_none, &ball);
    return sphere_is_candidate(ray, bound, &ball);
}
#endif
