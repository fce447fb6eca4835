/* sphere_robust.cl: where a ray meets a sphere, right to a few units in the last place of the answer, for every ratio of
 * radius to distance. Read twice when a work-item traces several lanes: once for one lane, once for all.
 *
 * In:    a ray whose origin is the unevaluated sum high + low (a point of a surface, known beyond single
 *        precision), a direction of nearly unit length, a sphere as it is stored.
 * Out:   both roots, as distances in units of the direction's length.
 *
 * Inlined by force for many lanes: some compilers would pass two dozen vectors through memory instead.
 *
 * Notation: oc = centre - origin; the centre projects to distance p along the ray; l = oc - p d is the part of oc
 * across the ray; s = sqrt((r^2 - l.l) / d.d) is half the chord; the roots are p - s and p + s.
 * l instead of oc.oc - r^2: E. Haines, J. Guenther and T. Akenine-Moeller, "Precision Improvements for Ray_one/Sphere
 * Intersection", Ray_one Tracing Gems, 2019. */

typedef struct LANED(Roots) {
    vrefined near, far;
    vrefined middle; /* p: negative when the sphere's centre lies behind */
    vrefined half_chord; /* s */
    vrefined across_x, across_y, across_z; /* l */
    vbool meets;     /* the line meets the sphere; else the rest means nothing */
} LANED(Roots);

#if REFINE_IS_DOUBLE
/* In double, from float inputs, every step is right to about 1e-15 of its largest term: a sphere of radius 1e6 a
 * unit away gets its near root to 1e-9. */
FORCE_INLINE static LANED(Roots) LANED(sphere_roots)(vreal high_x, vreal high_y, vreal high_z, vreal low_x, vreal low_y,
                                        vreal low_z, vreal dir_x, vreal dir_y, vreal dir_z, vreal cx, vreal cy,
                                        vreal cz, vreal radius) {
    const vrefined dx = to_refined(dir_x), dy = to_refined(dir_y), dz = to_refined(dir_z);
    const vrefined ocx = to_refined(cx) - (to_refined(high_x) + to_refined(low_x));
    const vrefined ocy = to_refined(cy) - (to_refined(high_y) + to_refined(low_y));
    const vrefined ocz = to_refined(cz) - (to_refined(high_z) + to_refined(low_z));
    /* d.d = 1 + e with |e| of a few ROUNDOFF: 1 / d.d = 1 - e + e e, to the cube of e */
    const vrefined e = fma(dx, dx, fma(dy, dy, fma(dz, dz, splat_refined(-1))));
    const vrefined inverse = fma(e, e - splat_refined(1), splat_refined(1));
    const vrefined p = fma(ocx, dx, fma(ocy, dy, ocz * dz)) * inverse;
    const vrefined lx = fma(-p, dx, ocx), ly = fma(-p, dy, ocy), lz = fma(-p, dz, ocz);
    const vrefined r = to_refined(radius);
    const vrefined discriminant = fma(r, r, -fma(lx, lx, fma(ly, ly, lz * lz)));
    LANED(Roots) roots;
    roots.meets = vbool_of_refined(discriminant >= splat_refined(0));
    const vrefined s = sqrt(choose_refined(roots.meets, discriminant, splat_refined(0)) * inverse);
    roots.near = p - s;
    roots.far = p + s;
    roots.middle = p;
    roots.half_chord = s;
    roots.across_x = lx;
    roots.across_y = ly;
    roots.across_z = lz;
    return roots;
}
#else
/* The error of sum = a + b, exactly (D. Knuth, The Art of Computer Programming 2, 4.2.2). */
static vreal LANED(sum_error)(vreal a, vreal b, vreal sum) {
    const vreal b_part = sum - a;
    const vreal a_part = sum - b_part;
    return (a - a_part) + (b - b_part);
}

/* The same in float by error-free transforms: oc as an unevaluated sum, its projection removed twice, so that l is
 * right to an ulp of itself and not of oc; and oc.oc - r^2 by a compensated sum (T. Ogita, S. Rump and S. Oishi,
 * "Accurate Sum and Dot Product", 2005) for the root that p and s would cancel to. */
FORCE_INLINE static LANED(Roots) LANED(sphere_roots)(vreal high_x, vreal high_y, vreal high_z, vreal low_x, vreal low_y,
                                        vreal low_z, vreal dx, vreal dy, vreal dz, vreal cx, vreal cy, vreal cz,
                                        vreal radius) {
    const vreal ocx = cx - high_x, ocy = cy - high_y, ocz = cz - high_z;
    const vreal ex = LANED(sum_error)(cx, -high_x, ocx) - low_x;
    const vreal ey = LANED(sum_error)(cy, -high_y, ocy) - low_y;
    const vreal ez = LANED(sum_error)(cz, -high_z, ocz) - low_z;
    const vreal inverse = splat(2) - fma(dx, dx, fma(dy, dy, dz * dz));
    const vreal p1 = fma(ocx, dx, fma(ocy, dy, ocz * dz)) * inverse;
    vreal lx = fma(-p1, dx, ocx) + ex, ly = fma(-p1, dy, ocy) + ey, lz = fma(-p1, dz, ocz) + ez;
    const vreal p2 = fma(lx, dx, fma(ly, dy, lz * dz)) * inverse;
    lx = fma(-p2, dx, lx);
    ly = fma(-p2, dy, ly);
    lz = fma(-p2, dz, lz);
    const vreal impact = sqrt(fma(lx, lx, fma(ly, ly, lz * lz)));
    const vreal discriminant = (radius - impact) * (radius + impact);
    LANED(Roots) roots;
    roots.meets = discriminant >= splat(0);
    const vreal s = sqrt(choose(roots.meets, discriminant, splat(0)) * inverse);
    const vreal p = p1 + p2;
    /* The root away from zero adds up; the other one is (oc.oc - r^2) / d.d over it. */
    const vbool ahead = p >= splat(0);
    const vreal outer = p1 + (p2 + choose(ahead, s, -s));
    const vreal xx = ocx * ocx, yy = ocy * ocy, zz = ocz * ocz, rr = radius * radius;
    const vreal a = xx - rr, b = a + yy, c = b + zz;
    const vreal products = (fma(ocx, ocx, -xx) + fma(ocy, ocy, -yy)) + (fma(ocz, ocz, -zz) - fma(radius, radius, -rr));
    const vreal sums = (LANED(sum_error)(xx, -rr, a) + LANED(sum_error)(a, yy, b)) + LANED(sum_error)(b, zz, c);
    const vreal cross = splat(2) * fma(ocx, ex, fma(ocy, ey, ocz * ez));
    const vreal power = c + ((products + sums) + cross);
    const vreal quotient = choose(outer != splat(0), power * inverse / outer, splat(0));
    const vreal difference = p1 + (p2 - choose(ahead, s, -s));
    const vreal inner = choose(fabs(difference) < R(0.5) * fabs(p), quotient, difference);
    roots.near = choose(ahead, inner, outer);
    roots.far = choose(ahead, outer, inner);
    roots.middle = p;
    roots.half_chord = s;
    roots.across_x = lx;
    roots.across_y = ly;
    roots.across_z = lz;
    return roots;
}
#endif

/* Which root counts, for a sphere that is not the one being left. `origin_error` bounds how far the origin may lie off
 * its true place: the power of the origin (near * far) tells outside from inside beyond that; outside and moving
 * towards the centre the ray enters at the near root, and an entry that rounding put behind the origin counts as
 * 0. Sets *enters; returns whether there is a hit. */
static vbool LANED(choose_root)(LANED(Roots) roots, vreal radius, vreal origin_error, vrefined *t, vbool *enters) {
    const vbool inside =
        vbool_of_refined(roots.near * roots.far < to_refined(radius * origin_error) * splat_refined(-2));
    const vbool ahead = vbool_of_refined(roots.middle > splat_refined(0));
    const vrefined entry = choose_refined(vbool_of_refined(roots.near > splat_refined(0)), roots.near, splat_refined(0));
    *t = choose_refined(inside, roots.far, entry);
    *enters = vbool_not(inside);
    return roots.meets & (inside | ahead);
}

/* The sphere being left into its inside is met again at the end of the chord: 2 p, since the origin is on it. */
static vrefined LANED(chord)(LANED(Roots) roots) {
    const vrefined length = roots.middle + roots.middle;
    return choose_refined(vbool_of_refined(length > splat_refined(0)), length, splat_refined(0));
}
