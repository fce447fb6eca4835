/* surface.cl: the point where a path meets a sphere, in lane code.
 *
 * In:    the ray, the distance, the sphere.
 * Out:   the point as an unevaluated sum, the outward unit normal, and a bound on the point's error (slack).
 *
 * The normal comes from the point relative to the centre, never from the rounded point. */
typedef struct Point {
    Vec3 high, low;
    vreal error;
} Point;

#if !NUMERICS_ROBUST
/* As the book has it: the rounded point, and the normal from it. */
static void surface_point(const Point *origin, Vec3 direction, vrefined t, vbool enters, Vec3 centre, vreal radius,
                          Point *point, Vec3 *normal) {
    point->high = madd3(t, direction, origin->high);
    point->low = zero3();
    point->error = splat(0);
    *normal = scale3(splat(1) / radius, subtract3(point->high, centre));
}
#elif REFINE_IS_DOUBLE
static void surface_point(const Point *origin, Vec3 direction, vrefined t, vbool enters, Vec3 centre, vreal radius,
                          Point *point, Vec3 *normal) {
    const vrefined x = fma(t, to_refined(direction.x), to_refined(origin->high.x) + to_refined(origin->low.x));
    const vrefined y = fma(t, to_refined(direction.y), to_refined(origin->high.y) + to_refined(origin->low.y));
    const vrefined z = fma(t, to_refined(direction.z), to_refined(origin->high.z) + to_refined(origin->low.z));
    const vrefined inverse = splat_refined(1) / to_refined(radius);
    normal->x = to_real((x - to_refined(centre.x)) * inverse);
    normal->y = to_real((y - to_refined(centre.y)) * inverse);
    normal->z = to_real((z - to_refined(centre.z)) * inverse);
    point->high = vec3(to_real(x), to_real(y), to_real(z));
    point->low = vec3(to_real(x - to_refined(point->high.x)), to_real(y - to_refined(point->high.y)),
                      to_real(z - to_refined(point->high.z)));
    /* The low part ends at 2^-48 of the point; the sums above and t err by a few 2^-53 of their terms. */
    const vreal size = fabs(point->high.x) + fabs(point->high.y) + fabs(point->high.z);
    point->error = fma(size, splat(R(0x1p-45)), (to_real(t) + radius) * R(0x1p-49));
}
#else
/* a * b + c as high + low. */
static void multiply_add_exactly(vreal a, vreal b, vreal c, vreal *high, vreal *low) {
    const vreal product = a * b;
    *high = product + c;
    *low = fma(a, b, -product) + LANED(sum_error)(product, c, *high);
}

/* Relative to the centre the point is l across the ray and s along it, whichever way t was rounded. In space: close
 * by it is origin + t d, off the sphere by the error of t, at most 16u t; far away against its radius, centre + r n,
 * off the sphere by the error of |n|, at most 3u. */
static void surface_point(const Point *origin, Vec3 direction, vrefined t, vbool enters, Vec3 centre, vreal radius,
                          Point *point, Vec3 *normal) {
    const LANED(Roots) roots = LANED(sphere_roots)(origin->high.x, origin->high.y, origin->high.z, origin->low.x,
                                                   origin->low.y, origin->low.z, direction.x, direction.y,
                                                   direction.z, centre.x, centre.y, centre.z, radius);
    const Vec3 across = vec3(roots.across_x, roots.across_y, roots.across_z);
    const Vec3 relative = subtract3(scale3(choose(enters, -roots.half_chord, roots.half_chord), direction), across);
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
    const vbool close_by = t < radius;
    point->high = choose3(close_by, near_high, far_high);
    point->low = choose3(close_by, near_low, far_low);
    const vreal size = fabs(point->high.x) + fabs(point->high.y) + fabs(point->high.z);
    point->error = fma(size, splat(R(0x1p-45)), choose(close_by, t * R(16.0), radius * R(4.0)) * ROUNDOFF);
}
#endif
