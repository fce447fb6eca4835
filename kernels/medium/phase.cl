/* phase.cl: the direction in which a medium scatters: L. Henyey and J. Greenstein, "Diffuse radiation in the galaxy", 1941.
 *
 * In:    the direction of a path, the mean cosine g, two numbers in [0, 1).   Out: the direction after, its density, and its lobe.
 * Knows: warps.cl, bsdf.cl's Lobe.   Does not know: media, paths. */
#if EFFECT_MEDIA
/* 1 + c and 1 - c for a cosine c to the direction before, of the density (1 - g^2) / (2 (1 + g^2 - 2 g c)^(3/2)), by
 * inversion, as two products in which nothing cancels, so that narrow peaks keep their shape; nothing is divided by g. */
static void phase_cosine(vreal g, vreal u, vreal *one_plus, vreal *one_minus) {
    const vbool forwards = g >= splat(0);
    const vreal size = fabs(g), rest = splat(1) - size, all = splat(1) + size;
    const vreal a = splat(2) * choose(forwards, u, splat(1) - u), b = splat(2) - a;
    const vreal root = fma(size, a, rest);
    const vreal scale = divide(splat(R(0.5)), root * root);
    const vreal near = a * all * all * fma(size, a, rest + rest) * scale;
    const vreal far = b * rest * rest * fma(-size, b, all + all) * scale;
    *one_plus = choose(forwards, near, far);
    *one_minus = choose(forwards, far, near);
}

/* The density of a direction after, per steradian. 1 + g^2 - 2 g c is (1 - |g|)^2 plus |g| times the squared
 * distance of the direction from that of the peak, so that narrow peaks keep their height. */
static vreal phase_pdf(vreal g, Vec3 before, Vec3 after) {
    const vreal size = fabs(g), rest = splat(1) - size;
    const Vec3 peak = scale3(choose(g >= splat(0), splat(1), splat(-1)), before);
    const Vec3 off = subtract3(after, peak);
    const vreal square = fma(size, dot3(off, off), rest * rest);
    return divide(R(0.07957747154594767) * rest * (splat(1) + size), square * square_root(square));
}

static Vec3 phase_direction(Vec3 before, vreal g, vreal u, vreal v) {
    vreal one_plus, one_minus;
    phase_cosine(g, u, &one_plus, &one_minus);
    const vreal cosine = (one_plus - one_minus) * R(0.5);
    const vreal sine = square_root(one_plus * one_minus);
    vreal along, across;
    sin_cos_turn(v, &across, &along);
    along = along * sine;
    across = across * sine;
    /* As in lamps.cl: T. Duff et al., 2017. */
    const vreal sign = copysign(splat(1), before.z);
    const vreal a = divide(splat(-1), sign + before.z);
    const vreal b = before.x * before.y * a;
    const Vec3 s = vec3(fma(sign * before.x * before.x, a, splat(1)), sign * b, -sign * before.x);
    const Vec3 t = vec3(b, fma(before.y * before.y, a, sign), -before.y);
    return normalise3(madd3(cosine, before, madd3(along, s, scale3(across, t))));
}

#if SAMPLES_LAMPS
static Lobe phase_lobe(Vec3 before, vreal g) {
    Lobe lobe;
    lobe.axis = before;
#if EFFECT_METAL
    lobe.normal = before;
#endif
#if LOBES_OF_TWO_DIRECTIONS
    lobe.outgoing = before;
#endif
#if WEIGHTED_LOBES
    lobe.albedo = before; /* of no use: its weight is the same in all directions */
#endif
#if EFFECT_GLOSSY
    lobe.refraction_index = lobe.lets_in = splat(1);
#elif EFFECT_ROUGH_DIELECTRIC
    lobe.refraction_index = splat(1);
#endif
    lobe.fuzz = g;
    lobe.kind = splat_uint(LOBE_PHASE);
#if SMOOTH_TRIANGLES
    lobe.true_normal = zero3();
#endif
    return lobe;
}
#endif
#endif
