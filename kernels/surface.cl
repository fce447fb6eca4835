/* surface.cl: the point where a path meets a sphere, in lane code.
 *
 * In:    the ray, the distance, the sphere.
 * Out:   the point as an unevaluated sum, the outward unit normal, and a bound on the point's error (slack).
 *
 * The normal comes from the point relative to the centre, never from the rounded point. */
typedef struct Point {
    Vec3 high, low;
    reals slack;
} Point;

#if REFINE_IS_DOUBLE
static void surface_point(const Point *origin, Vec3 direction, refineds t, Vec3 centre, reals radius, Point *point,
                          Vec3 *normal) {
    const refineds x = fma(t, to_refined(direction.x), to_refined(origin->high.x) + to_refined(origin->low.x));
    const refineds y = fma(t, to_refined(direction.y), to_refined(origin->high.y) + to_refined(origin->low.y));
    const refineds z = fma(t, to_refined(direction.z), to_refined(origin->high.z) + to_refined(origin->low.z));
    const refineds inverse = splat_refined(1) / to_refined(radius);
    normal->x = to_real((x - to_refined(centre.x)) * inverse);
    normal->y = to_real((y - to_refined(centre.y)) * inverse);
    normal->z = to_real((z - to_refined(centre.z)) * inverse);
    point->high = vec3(to_real(x), to_real(y), to_real(z));
    point->low = vec3(to_real(x - to_refined(point->high.x)), to_real(y - to_refined(point->high.y)),
                      to_real(z - to_refined(point->high.z)));
    /* The low part ends at 2^-48 of the point; the sums above and t err by a few 2^-53 of their terms. */
    const reals size = fabs(point->high.x) + fabs(point->high.y) + fabs(point->high.z);
    point->slack = fma(size, splat(R(0x1p-45)), (to_real(t) + radius) * R(0x1p-49));
}
#else
/* a * b + c as high + low. */
static void multiply_add_exactly(reals a, reals b, reals c, reals *high, reals *low) {
    const reals product = a * b;
    *high = product + c;
    *low = fma(a, b, -product) + LANED(sum_error)(product, c, *high);
}

/* Close by, the point is origin + t d: t errs by 2u t. Far away against its radius, it is centre + r n: n errs by
 * 2u. The smaller error is taken. */
static void surface_point(const Point *origin, Vec3 direction, refineds t, Vec3 centre, reals radius, Point *point,
                          Vec3 *normal) {
    /* From the origin to the centre, its part across the ray and the rest along it: refine.cl. */
    const reals ocx = centre.x - origin->high.x, ocy = centre.y - origin->high.y, ocz = centre.z - origin->high.z;
    const reals ex = LANED(sum_error)(centre.x, -origin->high.x, ocx) - origin->low.x;
    const reals ey = LANED(sum_error)(centre.y, -origin->high.y, ocy) - origin->low.y;
    const reals ez = LANED(sum_error)(centre.z, -origin->high.z, ocz) - origin->low.z;
    /* point - centre = t d - oc, the large parts first: they cancel exactly or nearly so. */
    Vec3 local = vec3(fma(t, direction.x, -ocx) - ex, fma(t, direction.y, -ocy) - ey, fma(t, direction.z, -ocz) - ez);
    *normal = normalise3(local);
    Vec3 near_high, near_low, far_high, far_low;
    multiply_add_exactly(t, direction.x, origin->high.x, &near_high.x, &near_low.x);
    multiply_add_exactly(t, direction.y, origin->high.y, &near_high.y, &near_low.y);
    multiply_add_exactly(t, direction.z, origin->high.z, &near_high.z, &near_low.z);
    near_low = add3(near_low, origin->low);
    multiply_add_exactly(radius, normal->x, centre.x, &far_high.x, &far_low.x);
    multiply_add_exactly(radius, normal->y, centre.y, &far_high.y, &far_low.y);
    multiply_add_exactly(radius, normal->z, centre.z, &far_high.z, &far_low.z);
    const masks close_by = t < radius;
    point->high = choose3(close_by, near_high, far_high);
    point->low = choose3(close_by, near_low, far_low);
    const reals size = fabs(point->high.x) + fabs(point->high.y) + fabs(point->high.z);
    point->slack = fma(size, splat(R(0x1p-45)), choose(close_by, t, radius) * (R(16.0) * ROUNDOFF));
}
#endif
