/* warps.cl: from uniform numbers to directions: direct maps, no rejection loops, no division by zero.
 *
 * In: numbers in [0, 1).   Out: points of the unit disk and the unit sphere. */

/* sin and cos of 2 pi u, u in [0, 1]. The turn is cut at the nearest quarter q, and a short polynomial in
 * f = 4u - q in [-1/2, 1/2] does the rest (float: Chebyshev interpolation, error below 5e-9 before rounding;
 * double: Taylor series). Plain arithmetic, so one lane and eight give the same bits on every device. */
static void sin_cos_turn(reals u, reals *sine, reals *cosine) {
    const reals turns4 = u * R(4.0);
    /* Whole part of what is positive: some drivers' floor() takes a dozen steps and two branches. */
    const reals quarter = uint_to_reals(to_uints(turns4 + R(0.5)));
    const reals f = turns4 - quarter;
    const reals z = f * f;
#if REAL_IS_DOUBLE
    reals s = splat(-4.377065467313739e-14);
    s = fma(s, z, splat(6.066935731106192e-12));
    s = fma(s, z, splat(-6.688035109811464e-10));
    s = fma(s, z, splat(5.692172921967924e-08));
    s = fma(s, z, splat(-3.598843235212084e-06));
    s = fma(s, z, splat(1.6044118478735975e-04));
    s = fma(s, z, splat(-4.681754135318687e-03));
    s = fma(s, z, splat(7.969262624616703e-02));
    s = fma(s, z, splat(-6.459640975062462e-01));
    s = fma(s, z, splat(1.5707963267948966));
    reals c = splat(-5.294400200734619e-13);
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
    reals s = splat(-4.602163101438173e-03f);
    s = fma(s, z, splat(7.968022285707776e-02f));
    s = fma(s, z, splat(-6.459634781533428e-01f));
    s = fma(s, z, splat(1.5707963219600418f));
    reals c = splat(9.03629913284223e-04f);
    c = fma(c, z, splat(-2.086007042203948e-02f));
    c = fma(c, z, splat(2.536692037988893e-01f));
    c = fma(c, z, splat(-1.2337005406403394f));
    c = fma(c, z, splat(1.0f));
#endif
    s = s * f;
    /* quarter is 0, 1, 2, 3 or 4: odd quarters swap, 2 and 3 negate the sine, 1 and 2 the cosine. */
    const masks odd = (quarter == splat(1)) | (quarter == splat(3));
    const masks lower = (quarter == splat(2)) | (quarter == splat(3));
    const masks left = (quarter == splat(1)) | (quarter == splat(2));
    const reals sine_magnitude = choose(odd, c, s);
    const reals cosine_magnitude = choose(odd, s, c);
    *sine = choose(lower, -sine_magnitude, sine_magnitude);
    *cosine = choose(left, -cosine_magnitude, cosine_magnitude);
}

/* Uniform on the unit disk. */
static void sample_disk(reals u, reals v, reals *x, reals *y) {
    const reals radius = sqrt(u);
    reals sine, cosine;
    sin_cos_turn(v, &sine, &cosine);
    *x = radius * cosine;
    *y = radius * sine;
}

/* Uniform on the unit sphere (Archimedes: the height is uniform). */
static Vec3 sample_sphere(reals u, reals v) {
    const reals z = R(1.0) - R(2.0) * u;
    const reals radius = sqrt(at_least((R(1.0) - z) * (R(1.0) + z), splat(0)));
    reals sine, cosine;
    sin_cos_turn(v, &sine, &cosine);
    return vec3(radius * cosine, radius * sine, z);
}

/* The radius of a point uniform in the unit ball has the distribution of the largest of three uniform numbers:
 * P(r < x) = x^3. */
static reals sample_ball_radius(reals u, reals v, reals w) { return at_least(at_least(u, v), w); }
