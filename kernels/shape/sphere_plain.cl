/* sphere_plain.cl: where a ray meets a sphere, with --numerics plain: the book's least distance, and nothing else.
 *
 * A cheap choice that is wrong for spheres that are huge, tiny, far or nested: a path may meet the surface it leaves
 * (acne), pass through a thin shell, or miss a small sphere. docs/NUMERICS.md maps where. It stands here as the
 * yardstick of what robustness costs.
 *
 * In and out: the interface of a shape, explained in sphere_robust.cl.
 * Knows: ray.cl.   Does not know: trees, materials. Read once for each number of lanes. */
#define PLAIN_T_MIN R(1e-3)

#if SPHERES_MET
#undef OWN_SHAPE_IS_MET
#define OWN_SHAPE_IS_MET 1
#define Sphere LANED(Sphere)
#define sphere_roots LANED(sphere_roots)
#define sphere_is_candidate LANED(sphere_is_candidate)
#define sphere_intersect LANED(sphere_intersect)
#define sphere_exit LANED(sphere_exit)
#define sphere_power LANED(sphere_power)
#define sphere_surface LANED(sphere_surface)

typedef struct Sphere {
    Vec3 centre;
    vreal radius; /* above 0 */
#if EFFECT_CAPSULES
    Vec3 axis; /* the members of sphere_robust.cl, without low */
    vbool is_capsule, inside, beyond;
#endif
} Sphere;

/* The perpendicular form in `real`; a root counts from PLAIN_T_MIN on. Returns whether the line meets the sphere. */
FORCE_INLINE static vbool sphere_roots(const Ray *ray, const Sphere *sphere, vreal *near, vreal *far) {
    const Vec3 oc = subtract3(sphere->centre, ray->origin.high);
    const vreal p = dot3(oc, ray->direction);
    const Vec3 l = madd3(-p, ray->direction, oc);
    const vreal discriminant = fma(sphere->radius, sphere->radius, -dot3(l, l));
    const vreal half_chord = square_root(larger(discriminant, splat(0)));
    *near = p - half_chord;
    *far = p + half_chord;
    return discriminant >= splat(0);
}

FORCE_INLINE static vbool sphere_intersect(const Ray *ray, const Sphere *sphere, vrefined *t, vbool *enters) {
    vreal near, far;
    const vbool meets = sphere_roots(ray, sphere, &near, &far);
#if EFFECT_CAPSULES
    *enters = (near > splat(PLAIN_T_MIN)) & vbool_not(sphere->inside);
#else
    *enters = near > splat(PLAIN_T_MIN);
#endif
    *t = choose(*enters, near, far);
    return meets & (*t > splat(PLAIN_T_MIN));
}

/* The sphere being left is met like any other. */
FORCE_INLINE static vbool sphere_is_candidate(const Ray *ray, vreal bound, const Sphere *sphere) {
    vrefined t;
    vbool enters;
    const vbool meets = sphere_intersect(ray, sphere, &t, &enters);
    return meets & (t <= bound);
}

FORCE_INLINE static vbool sphere_exit(const Ray *ray, const Sphere *sphere, vrefined *t) {
    *t = splat_refined(0);
    return vbool_none;
}

FORCE_INLINE static vreal sphere_power(const Point *origin, const Sphere *sphere, Vec3 *to_centre) {
    *to_centre = subtract3(sphere->centre, origin->high);
    return dot3(*to_centre, *to_centre) - sphere->radius * sphere->radius;
}

/* As the book has it: the rounded point, and the normal from it. */
FORCE_INLINE static void sphere_surface(const Ray *ray, const Sphere *sphere, vuint slot, vrefined t, vbool enters,
                                        Point *point, Vec3 *normal) {
    point->high = madd3(t, ray->direction, ray->origin.high);
    point->low = zero3();
    point->error = splat(0);
    *normal = scale3(divide(splat(1), sphere->radius), subtract3(point->high, sphere->centre));
}
#endif
