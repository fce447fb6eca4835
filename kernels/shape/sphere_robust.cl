/* sphere_robust.cl: where a ray meets a sphere, right to a few units in the last place of the answer, for every ratio
 * of radius to distance. docs/NUMERICS.md proves the bounds.
 *
 * In:    a ray whose origin is the unevaluated sum high + low, a sphere as it is stored.
 * Out:   the interface of a shape, the same in sphere_plain.cl:
 *          sphere_is_candidate  may the ray meet the sphere before `bound`? Quick; what it rules out is surely not met.
 *          OWN_SHAPE_IS_MET     0 or 1: the sphere being left is a candidate like any other
 *          sphere_intersect     does the ray meet it, at which distance, and from outside or inside?
 *          sphere_exit          where does a ray meet the sphere that it has left into its inside?
 *          sphere_power         how far is a point outside a sphere, as a square?
 *          sphere_surface       the point that was met, as an origin for the next ray, and the outward unit normal
 * Knows: ray.cl.   Does not know: trees, materials. Read once for each number of lanes.
 *
 * Notation: oc = centre - origin; the centre projects to distance p along the ray; l = oc - p d is the part of oc
 * across the ray; s = sqrt((r^2 - l.l) / d.d) is half the chord; the roots are p - s and p + s.
 * l instead of oc.oc - r^2: E. Haines, J. Guenther and T. Akenine-Moeller, "Precision Improvements for Ray/Sphere
 * Intersection", Ray Tracing Gems, 2019. */
#if SPHERES_MET
#undef OWN_SHAPE_IS_MET
#define OWN_SHAPE_IS_MET 0
#define Sphere LANED(Sphere)
#define Roots LANED(Roots)
#define sphere_is_candidate LANED(sphere_is_candidate)
#define sphere_roots LANED(sphere_roots)
#define sphere_intersect LANED(sphere_intersect)
#define sphere_exit LANED(sphere_exit)
#define sphere_power LANED(sphere_power)
#define sphere_surface LANED(sphere_surface)
#define compensated_power LANED(compensated_power)
#define sum_error LANED(sum_error)
#define multiply_add_exactly LANED(multiply_add_exactly)

typedef struct Sphere {
    Vec3 centre;
    vreal radius; /* above 0 */
#if EFFECT_CAPSULES
    Vec3 axis;         /* of a capsule: from its first end, where the centre is at first, to the other; else 0 */
    Vec3 low;          /* what the centre of the ball chosen has beyond a real; of spheres -0 */
    vbool is_capsule;  /* the ball was chosen on an axis (capsule_robust.cl) */
    vbool inside;      /* the ray begins inside the capsule, and the ball is the one that it leaves last */
    vbool beyond;      /* the ball is closer to the other end */
    vbool at_wall;     /* the line meets the capsule between its ends, and the ball where that does */
#endif
} Sphere;

/* The sphere is met before `bound` only if sqrt(r^2 - l^2) >= max(-p, p - bound); p and l err by less than half of
 * margin = 64 u (|p| + r) + the ray's own margin (u = ROUNDOFF, |d|^2 = 1 within 28 u).
 * The sphere being left, which callers leave out, is not met from outside, and from inside sphere_exit meets it. */
FORCE_INLINE static vbool sphere_is_candidate(const Ray *ray, vreal bound, const Sphere *sphere) {
    const Vec3 oc = subtract3(sphere->centre, ray->origin.high);
    const vreal p = loose_dot3(oc, ray->direction);
    const Vec3 l = loose_madd3(-p, ray->direction, oc);
    const vreal margin = loose_fma(splat(R(64.0) * ROUNDOFF), fabs(p) + sphere->radius, ray->cull_margin);
    const vreal reach = sphere->radius + margin;
    const vreal room = loose_fma(reach, reach, -loose_dot3(l, l));
    const vreal outside = larger(larger(-p, p - bound) - margin, splat(0));
    return room >= outside * outside;
}

/* A ball that was chosen on a capsule's axis has a centre that is finer than a real, and whether the ray begins inside was
 * decided with it. */
#if EFFECT_CAPSULES
#define CENTRE_REFINED(a) (to_refined(c.a) + to_refined(sphere->low.a))
#define CENTRE_ERROR(a, error) ((error) + sphere->low.a)
#define BEGINS_INSIDE(within) (sphere->inside | ((within) & vbool_not(sphere->is_capsule)))
#else
#define CENTRE_REFINED(a) to_refined(c.a)
#define CENTRE_ERROR(a, error) error
#define BEGINS_INSIDE(within) within
#endif

typedef struct Roots {
    vrefined near, far;
    vrefined middle;     /* p: negative when the sphere's centre lies behind */
    vrefined half_chord; /* s */
    vbool meets;         /* the line meets the sphere; else the rest means nothing */
#if !REFINE_IS_DOUBLE
    Vec3 across; /* l */
#endif
} Roots;

#if REFINE_IS_DOUBLE
/* In double, from float inputs, every step is right to about 1e-15 of its largest term: a sphere of radius 1e6 a
 * unit away gets its near root to 1e-9. */
FORCE_INLINE static Roots sphere_roots(const Ray *ray, const Sphere *sphere) {
    const Point *o = &ray->origin;
    const Vec3 d = ray->direction, c = sphere->centre;
    const vrefined dx = to_refined(d.x), dy = to_refined(d.y), dz = to_refined(d.z);
    const vrefined ocx = CENTRE_REFINED(x) - (to_refined(o->high.x) + to_refined(o->low.x));
    const vrefined ocy = CENTRE_REFINED(y) - (to_refined(o->high.y) + to_refined(o->low.y));
    const vrefined ocz = CENTRE_REFINED(z) - (to_refined(o->high.z) + to_refined(o->low.z));
    /* d.d = 1 + e with |e| of a few ROUNDOFF: 1 / d.d = 1 - e + e e, to the cube of e */
    const vrefined e = fma(dx, dx, fma(dy, dy, fma(dz, dz, splat_refined(-1))));
    const vrefined inverse = fma(e, e - splat_refined(1), splat_refined(1));
    const vrefined p = fma(ocx, dx, fma(ocy, dy, ocz * dz)) * inverse;
    const vrefined lx = fma(-p, dx, ocx), ly = fma(-p, dy, ocy), lz = fma(-p, dz, ocz);
    const vrefined r = to_refined(sphere->radius);
    const vrefined discriminant = fma(r, r, -fma(lx, lx, fma(ly, ly, lz * lz)));
    Roots roots;
    roots.meets = vbool_of_refined(discriminant >= splat_refined(0));
    const vrefined s = square_root_refined(choose_refined(roots.meets, discriminant, splat_refined(0)) * inverse);
    roots.near = p - s;
    roots.far = p + s;
    roots.middle = p;
    roots.half_chord = s;
    return roots;
}
#else
/* The error of sum = a + b, exactly (D. Knuth, The Art of Computer Programming 2, 4.2.2). */
static vreal sum_error(vreal a, vreal b, vreal sum) {
    const vreal b_part = sum - a;
    const vreal a_part = sum - b_part;
    return (a - a_part) + (b - b_part);
}

/* (oc + e).(oc + e) - radius^2 by a compensated sum (T. Ogita, S. Rump and S. Oishi, "Accurate Sum and Dot Product",
 * 2005); what is of second order in e is left out. */
FORCE_INLINE static vreal compensated_power(Vec3 oc, Vec3 e, vreal radius) {
    const vreal xx = oc.x * oc.x, yy = oc.y * oc.y, zz = oc.z * oc.z, rr = radius * radius;
    const vreal a = xx - rr, b = a + yy, sum = b + zz;
    const vreal products =
        (fma(oc.x, oc.x, -xx) + fma(oc.y, oc.y, -yy)) + (fma(oc.z, oc.z, -zz) - fma(radius, radius, -rr));
    const vreal sums = (sum_error(xx, -rr, a) + sum_error(a, yy, b)) + sum_error(b, zz, sum);
    const vreal cross = splat(2) * fma(oc.x, e.x, fma(oc.y, e.y, oc.z * e.z));
    return sum + ((products + sums) + cross);
}

/* The same in float by error-free transforms: oc as an unevaluated sum, its projection removed twice, so that l is
 * right to an ulp of itself and not of oc; and oc.oc - r^2 by a compensated sum for the root that p and s would cancel
 * to. */
FORCE_INLINE static Roots sphere_roots(const Ray *ray, const Sphere *sphere) {
    const Vec3 high = ray->origin.high, low = ray->origin.low, d = ray->direction, c = sphere->centre;
    const vreal radius = sphere->radius;
    const Vec3 oc = subtract3(c, high);
    const vreal ex = CENTRE_ERROR(x, sum_error(c.x, -high.x, oc.x) - low.x);
    const vreal ey = CENTRE_ERROR(y, sum_error(c.y, -high.y, oc.y) - low.y);
    const vreal ez = CENTRE_ERROR(z, sum_error(c.z, -high.z, oc.z) - low.z);
    const vreal inverse = splat(2) - dot3(d, d);
    const vreal p1 = dot3(oc, d) * inverse;
    Vec3 l = add3(madd3(-p1, d, oc), vec3(ex, ey, ez));
    const vreal p2 = dot3(l, d) * inverse;
    l = madd3(-p2, d, l);
    const vreal impact = square_root(dot3(l, l));
    const vreal discriminant = (radius - impact) * (radius + impact);
    Roots roots;
    roots.meets = discriminant >= splat(0);
    const vreal s = square_root(choose(roots.meets, discriminant, splat(0)) * inverse);
    const vreal p = p1 + p2;
    /* The root away from zero adds up; the other one is (oc.oc - r^2) / d.d over it. */
    const vbool ahead = p >= splat(0);
    const vreal outer = p1 + (p2 + choose(ahead, s, -s));
    const vreal power = compensated_power(oc, vec3(ex, ey, ez), radius);
    const vreal quotient = choose(outer != splat(0), divide(power * inverse, outer), splat(0));
    const vreal difference = p1 + (p2 - choose(ahead, s, -s));
    const vreal inner = choose(fabs(difference) < R(0.5) * fabs(p), quotient, difference);
    roots.near = choose(ahead, inner, outer);
    roots.far = choose(ahead, outer, inner);
    roots.middle = p;
    roots.half_chord = s;
    roots.across = l;
    return roots;
}
#endif

/* Which root counts, for a sphere that is not the one being left. The origin's error bounds how far it may lie off
 * its true place: the power of the origin (near * far) tells outside from inside beyond that; outside and moving
 * towards the centre the ray enters at the near root, and an entry that rounding put behind the origin counts as 0. */
FORCE_INLINE static vbool sphere_intersect(const Ray *ray, const Sphere *sphere, vrefined *t, vbool *enters) {
    const Roots roots = sphere_roots(ray, sphere);
    const vbool inside = BEGINS_INSIDE(
        vbool_of_refined(roots.near * roots.far < to_refined(sphere->radius * ray->origin.error) * splat_refined(-2)));
    const vbool ahead = vbool_of_refined(roots.middle > splat_refined(0));
    const vrefined entry =
        choose_refined(vbool_of_refined(roots.near > splat_refined(0)), roots.near, splat_refined(0));
    *t = choose_refined(inside, roots.far, entry);
    *enters = vbool_not(inside);
#if EFFECT_CAPSULES
    /* Nearly along the axis a line touches the ball so slightly that rounding could take it off. */
    return (roots.meets | sphere->at_wall) & (inside | ahead);
#else
    return roots.meets & (inside | ahead);
#endif
}

/* At the end of the chord: 2 p, since the origin is on the sphere; of a capsule it is on another ball than the end. */
FORCE_INLINE static vbool sphere_exit(const Ray *ray, const Sphere *sphere, vrefined *t) {
    const Roots roots = sphere_roots(ray, sphere);
#if EFFECT_CAPSULES
    const vrefined length = choose_refined(sphere->is_capsule, roots.far, roots.middle + roots.middle);
#else
    const vrefined length = roots.middle + roots.middle;
#endif
    *t = choose_refined(vbool_of_refined(length > splat_refined(0)), length, splat_refined(0));
    return vbool_all;
}

/* The square of the distance from a point to a sphere's centre, less the square of the radius: the power of the point,
 * right to a few units in the last place however close to the surface it lies. `to_centre`: from the point. */
#if REFINE_IS_DOUBLE
FORCE_INLINE static vreal sphere_power(const Point *origin, const Sphere *sphere, Vec3 *to_centre) {
    const Vec3 high = origin->high, low = origin->low, c = sphere->centre;
    const vrefined x = to_refined(c.x) - (to_refined(high.x) + to_refined(low.x));
    const vrefined y = to_refined(c.y) - (to_refined(high.y) + to_refined(low.y));
    const vrefined z = to_refined(c.z) - (to_refined(high.z) + to_refined(low.z));
    const vrefined r = to_refined(sphere->radius);
    *to_centre = vec3(to_real(x), to_real(y), to_real(z));
    return to_real(fma(x, x, fma(y, y, fma(z, z, -r * r))));
}
#else
FORCE_INLINE static vreal sphere_power(const Point *origin, const Sphere *sphere, Vec3 *to_centre) {
    const Vec3 high = origin->high, low = origin->low, c = sphere->centre;
    const Vec3 oc = subtract3(c, high);
    const Vec3 e = vec3(sum_error(c.x, -high.x, oc.x) - low.x, sum_error(c.y, -high.y, oc.y) - low.y,
                        sum_error(c.z, -high.z, oc.z) - low.z);
    *to_centre = add3(oc, e);
    return compensated_power(oc, e, sphere->radius);
}
#endif

/* The normal comes from the point relative to the centre, never from the rounded point. */
#if REFINE_IS_DOUBLE
FORCE_INLINE static void sphere_surface(const Ray *ray, const Sphere *sphere, vuint slot, vrefined t, vbool enters,
                                        Point *point, Vec3 *normal) {
    const Point *origin = &ray->origin;
    const Vec3 direction = ray->direction, centre = sphere->centre;
    const vrefined x = fma(t, to_refined(direction.x), to_refined(origin->high.x) + to_refined(origin->low.x));
    const vrefined y = fma(t, to_refined(direction.y), to_refined(origin->high.y) + to_refined(origin->low.y));
    const vrefined z = fma(t, to_refined(direction.z), to_refined(origin->high.z) + to_refined(origin->low.z));
    const vrefined inverse = divide_refined(splat_refined(1), to_refined(sphere->radius));
#if EFFECT_CAPSULES
    normal->x = to_real((x - (to_refined(centre.x) + to_refined(sphere->low.x))) * inverse);
    normal->y = to_real((y - (to_refined(centre.y) + to_refined(sphere->low.y))) * inverse);
    normal->z = to_real((z - (to_refined(centre.z) + to_refined(sphere->low.z))) * inverse);
#else
    normal->x = to_real((x - to_refined(centre.x)) * inverse);
    normal->y = to_real((y - to_refined(centre.y)) * inverse);
    normal->z = to_real((z - to_refined(centre.z)) * inverse);
#endif
    point->high = vec3(to_real(x), to_real(y), to_real(z));
    point->low = vec3(to_real(x - to_refined(point->high.x)), to_real(y - to_refined(point->high.y)),
                      to_real(z - to_refined(point->high.z)));
    /* The low part ends at 2^-48 of the point; the sums above and t err by a few 2^-53 of their terms. */
    const vreal size = fabs(point->high.x) + fabs(point->high.y) + fabs(point->high.z);
    const vreal error = fma(size, splat(R(0x1p-45)), (to_real(t) + sphere->radius) * R(0x1p-49));
    /* A chord ends as far off its sphere as it began, and a little more. */
    const vbool own = vbool_of_uint(slot == ray->own_slot);
    point->error = choose(own, error + origin->error, error);
}
#else
/* a * b + c as high + low. */
static void multiply_add_exactly(vreal a, vreal b, vreal c, vreal *high, vreal *low) {
    const vreal product = a * b;
    *high = product + c;
    *low = fma(a, b, -product) + sum_error(product, c, *high);
}

/* Relative to the centre the point is l across the ray and s along it, whichever way t was rounded. In space: close
 * by it is origin + t d, off the sphere by the error of t, at most 16u t; far away against its radius, centre + r n,
 * off the sphere by the error of |n|, at most 3u. */
FORCE_INLINE static void sphere_surface(const Ray *ray, const Sphere *sphere, vuint slot, vrefined t, vbool enters,
                                        Point *point, Vec3 *normal) {
    const Point *origin = &ray->origin;
    const Vec3 direction = ray->direction, centre = sphere->centre;
    const vreal radius = sphere->radius;
    const Roots roots = sphere_roots(ray, sphere);
    const Vec3 relative =
        subtract3(scale3(choose(enters, -roots.half_chord, roots.half_chord), direction), roots.across);
    const vbool degenerate = vbool_not(dot3(relative, relative) > splat(0));
    const Vec3 unit = normalise3(choose3(degenerate, direction, relative));
    /* Once more, so that the length errs by 3u however well the device divides and takes roots. */
    const vreal excess = fma(unit.x, unit.x, fma(unit.y, unit.y, fma(unit.z, unit.z, splat(-1))));
    *normal = scale3(fma(excess, splat(R(-0.5)), splat(1)), unit);
    Vec3 near_high, near_low, far_high, far_low;
    multiply_add_exactly(t, direction.x, origin->high.x, &near_high.x, &near_low.x);
    multiply_add_exactly(t, direction.y, origin->high.y, &near_high.y, &near_low.y);
    multiply_add_exactly(t, direction.z, origin->high.z, &near_high.z, &near_low.z);
    near_low = add3(near_low, origin->low);
    multiply_add_exactly(radius, normal->x, centre.x, &far_high.x, &far_low.x);
    multiply_add_exactly(radius, normal->y, centre.y, &far_high.y, &far_low.y);
    multiply_add_exactly(radius, normal->z, centre.z, &far_high.z, &far_low.z);
#if EFFECT_CAPSULES
    far_low = add3(far_low, sphere->low);
#endif
    const vbool close_by = t < radius;
    point->high = choose3(close_by, near_high, far_high);
    point->low = choose3(close_by, near_low, far_low);
    const vreal size = fabs(point->high.x) + fabs(point->high.y) + fabs(point->high.z);
    const vreal error = fma(size, splat(R(0x1p-45)), choose(close_by, t * R(16.0), radius * R(4.0)) * ROUNDOFF);
    /* A chord ends as far off its sphere as it began, and a little more. */
    const vbool own = vbool_of_uint(slot == ray->own_slot);
    point->error = choose(own, error + origin->error, error);
}
#endif
#endif
