/* warps.cl: from uniform numbers to directions: direct maps, no rejection loops, no division by zero.
 *
 * In:    numbers in [0, 1).   Out: points of the unit disk and the unit sphere, radii in the unit ball; vectors across one.
 * Knows: vector.cl.   Does not know: where the numbers come from. */

/* sin and cos of 2 pi u, u in [0, 1]. The turn is cut at the nearest quarter q, and a short polynomial in
 * f = 4u - q in [-1/2, 1/2] does the rest (float: Chebyshev interpolation, error below 5e-9 before rounding;
 * double: Taylor series). Plain arithmetic, so one lane and eight give the same bits on every device. */
static void sin_cos_turn(vreal u, vreal *sine, vreal *cosine) {
    const vreal turns4 = u * R(4.0);
    /* Whole part of what is positive: some drivers' floor() takes a dozen steps and two branches. */
    const vreal quarter = uint_to_real(to_uint(turns4 + R(0.5)));
    const vreal f = turns4 - quarter;
    const vreal z = f * f;
#if REAL_IS_DOUBLE
    vreal s = splat(-4.377065467313739e-14);
    s = fma(s, z, splat(6.066935731106192e-12));
    s = fma(s, z, splat(-6.688035109811464e-10));
    s = fma(s, z, splat(5.692172921967924e-08));
    s = fma(s, z, splat(-3.598843235212084e-06));
    s = fma(s, z, splat(1.6044118478735975e-04));
    s = fma(s, z, splat(-4.681754135318687e-03));
    s = fma(s, z, splat(7.969262624616703e-02));
    s = fma(s, z, splat(-6.459640975062462e-01));
    s = fma(s, z, splat(1.5707963267948966));
    vreal c = splat(-5.294400200734619e-13);
    c = fma(c, z, splat(6.565963114979468e-11));
    c = fma(c, z, splat(-6.386603083791849e-09));
    c = fma(c, z, splat(4.710874778818169e-07));
    c = fma(c, z, splat(-2.5202042373060596e-05));
    c = fma(c, z, splat(9.192602748394263e-04));
    c = fma(c, z, splat(-2.0863480763352957e-02));
    c = fma(c, z, splat(2.53669507901048e-01));
    c = fma(c, z, splat(-1.2337005501361697));
    c = fma(c, z, splat(1.0));
#else
    vreal s = splat(-4.602163101438173e-03f);
    s = fma(s, z, splat(7.968022285707776e-02f));
    s = fma(s, z, splat(-6.459634781533428e-01f));
    s = fma(s, z, splat(1.5707963219600418f));
    vreal c = splat(9.03629913284223e-04f);
    c = fma(c, z, splat(-2.086007042203948e-02f));
    c = fma(c, z, splat(2.536692037988893e-01f));
    c = fma(c, z, splat(-1.2337005406403394f));
    c = fma(c, z, splat(1.0f));
#endif
    s = s * f;
    /* quarter is 0, 1, 2, 3 or 4: odd quarters swap, 2 and 3 negate the sine, 1 and 2 the cosine. */
    const vbool odd = (quarter == splat(1)) | (quarter == splat(3));
    const vbool lower = (quarter == splat(2)) | (quarter == splat(3));
    const vbool left = (quarter == splat(1)) | (quarter == splat(2));
    const vreal sine_magnitude = choose(odd, c, s);
    const vreal cosine_magnitude = choose(odd, s, c);
    *sine = choose(lower, -sine_magnitude, sine_magnitude);
    *cosine = choose(left, -cosine_magnitude, cosine_magnitude);
}

/* Uniform on the unit disk. */
static void sample_disk(vreal u, vreal v, vreal *x, vreal *y) {
    const vreal radius = square_root(u);
    vreal sine, cosine;
    sin_cos_turn(v, &sine, &cosine);
    *x = radius * cosine;
    *y = radius * sine;
}

/* Uniform on the unit sphere (Archimedes: the height is uniform). */
static Vec3 sample_sphere(vreal u, vreal v) {
    const vreal z = R(1.0) - R(2.0) * u;
    const vreal radius = square_root(at_least((R(1.0) - z) * (R(1.0) + z), splat(0)));
    vreal sine, cosine;
    sin_cos_turn(v, &sine, &cosine);
    return vec3(radius * cosine, radius * sine, z);
}

/* The radius of a point uniform in the unit ball has the distribution of the largest of three uniform numbers:
 * P(r < x) = x^3. */
static vreal sample_ball_radius(vreal u, vreal v, vreal w) { return at_least(at_least(u, v), w); }

#if SAMPLES_LAMPS || EFFECT_SHADOW_CATCHER || LOBES_OF_TWO_DIRECTIONS
/* Two unit vectors across the unit vector `w`, and across each other (T. Duff et al., "Building an Orthonormal Basis,
 * Revisited", JCGT 6(1), 2017). */
static void basis_across(Vec3 w, Vec3 *s, Vec3 *t) {
    const vreal sign = copysign(splat(1), w.z);
    const vreal a = divide(splat(-1), sign + w.z);
    const vreal b = w.x * w.y * a;
    *s = vec3(fma(sign * w.x * w.x, a, splat(1)), sign * b, -sign * w.x);
    *t = vec3(b, fma(w.y * w.y, a, sign), -w.y);
}
#endif
