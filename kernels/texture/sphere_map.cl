/* sphere_map.cl: where a point stands on the map of its sphere: longitude and latitude, from 0 to 1.
 *
 * In:    the outward normal, the axes of a map.   Out: how far around, and how far from the south to the north pole.
 * Knows: vector.cl.   Does not know: what stands on the map.
 *
 * Plain arithmetic, so all forms give the same bits on every device. Both are right to 2 ROUNDOFF and what the dot products
 * lose, another 4 ROUNDOFF; tests/textures measures it. */
#if EFFECT_TEXTURES || EFFECT_ENVIRONMENT || SAMPLES_TRIANGLES
/* atan(r) / (2 pi r) as a polynomial of r^2, |r| <= 1/4 (Chebyshev interpolation: float to 1.5e-10, double to 6.4e-20 of
 * its value, before rounding). */
static vreal turn_over_tangent(vreal z) {
#if REAL_IS_DOUBLE
    vreal s = splat(-0.0063528824261242391734);
    s = fma(s, z, splat(0.0091074950630738667074));
    s = fma(s, z, splat(-0.010592106575517475377));
    s = fma(s, z, splat(0.012241890717816947572));
    s = fma(s, z, splat(-0.014468609481819616044));
    s = fma(s, z, splat(0.017683882204703051305));
    s = fma(s, z, splat(-0.022736420438242521016));
    s = fma(s, z, splat(0.031830988618362234068));
    s = fma(s, z, splat(-0.053051647697298413421));
    return fma(s, z, splat(0.15915494309189533576));
#else
    vreal s = splat(0.015604165248452511f);
    s = fma(s, z, splat(-0.022625735033492329f));
    s = fma(s, z, splat(0.031828547927571614f));
    s = fma(s, z, splat(-0.053051628734394731f));
    return fma(s, z, splat(0.15915494306821667f));
#endif
}

/* The angle from the x axis to (x, y), in turns: from 0 to 1, counter-clockwise; 0 for the origin. The smaller over the
 * larger of |x| and |y| is the tangent of at most 1/8 turn, and taken from the nearest of 0, 1/2 and 1, where the angle is
 * known. */
static vreal turn_of(vreal x, vreal y) {
    const vreal ax = fabs(x), ay = fabs(y);
    const vbool steep = ay > ax;
    const vreal larger_one = choose(steep, ay, ax), smaller_one = choose(steep, ax, ay);
    const vbool some = larger_one > splat(0);
    const vbool near_half = smaller_one > R(0.25) * larger_one, near_one = smaller_one > R(0.75) * larger_one;
    const vreal tangent = choose(near_one, splat(1), choose(near_half, splat(R(0.5)), splat(0)));
    const vreal known = choose(near_one, splat(R(0.125)), choose(near_half, splat(R(0.073791808825216637)), splat(0)));
    const vreal below = choose(some, fma(tangent, smaller_one, larger_one), splat(1));
    const vreal r = divide(fma(-tangent, larger_one, smaller_one), below);
    vreal turn = fma(r, turn_over_tangent(r * r), known);
    turn = choose(steep, R(0.25) - turn, turn);
    turn = choose(x < splat(0), R(0.5) - turn, turn);
    return choose(y < splat(0), R(1.0) - turn, turn);
}

#if EFFECT_TEXTURES || EFFECT_ENVIRONMENT
/* `seam`, `east`, `pole`: to longitude 0, to a quarter, to the north pole. `u`: around, from 0 to 1, both of which are the seam;
 * `v`: from the south pole, 0, to the north pole, 1. The length of the normal does not matter. */
static void sphere_map(Vec3 normal, Vec3 seam, Vec3 east, Vec3 pole, vreal *u, vreal *v) {
    const vreal x = dot3(normal, seam), y = dot3(normal, east), height = dot3(normal, pole);
    *u = turn_of(x, y);
    *v = at_most(splat(2) * turn_of(-height, square_root(fma(x, x, y * y))), splat(1));
}
#endif
#endif
