/* oren_nayar.cl: a rough matte surface, such as plaster, clay or the moon: it darkens less towards its rim than a smooth one, and
 * sends more light back to where it came from.
 *
 * In and out: as bsdf.cl says.   Knows: bsdf.cl.   Does not know: other lobes.
 *
 * M. Oren and S. Nayar, "Generalization of Lambert's Reflectance Model", 1994, in the form of Y. Fujii, with what that loses
 * between its facets given back (J. Portsmouth, P. Kutz and S. Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", JCGT
 * 14(1), 2025). For directions o and i with the cosines co and ci, roughness r, s = o.i - co ci, and k and q below:
 *
 *   f = albedo once(o, i) + again again(o, i)
 *   once  = A / pi (1 + r s / t),   A = 1 / (1 + k r),   t = max(co, ci) where s > 0, else 1
 *   again = (1 - E(o)) (1 - E(i)) / (pi (1 - mean)),   E(o) = A (1 + r g(co)),   mean = A (1 + r q)
 *
 * E is the share of light that meets the surface once, g in terms of the angle of o. So a white surface returns all light, and both parts are
 * drawn exactly: `once` with the probability E(o), else `again`. Each has one weight whatever the direction, the albedo or the
 * colour of what is reflected again.
 *
 * Of `once`, a direction by the cosine is turned about the normal to the side of o with the probability r |s| where it lies on the other,
 * which makes that A ci (1 + r s) / pi on both. What lacks, for o not upright, is drawn by rejection, and so is `again`. */
#if EFFECT_OREN_NAYAR
#define OREN_NAYAR_K R(0.28779340921085446) /* 1/2 - 2 / (3 pi) */
#define OREN_NAYAR_Q R(0.07248821245670893) /* 2/3 - 28 / (15 pi) */
#define OREN_NAYAR_TRIES 64u                /* each succeeds with a probability of 1/3 at least */
#define UPRIGHT_SINE2 R(0x1p-20)            /* no side can be told from less, and s is nearly 0 */

/* The angle of which this is the cosine, at least 0, by a polynomial (Chebyshev interpolation of acos(1 - x) / sqrt(x), error
 * below 1e-10). */
static vreal angle_of(vreal cosine) {
    const vreal x = splat(1) - cosine;
    vreal p = splat(R(2.3247175e-4));
    p = fma(p, x, splat(R(-7.5828976e-4)));
    p = fma(p, x, splat(R(1.35109013e-3)));
    p = fma(p, x, splat(R(-1.057113225e-3)));
    p = fma(p, x, splat(R(1.0865734633e-3)));
    p = fma(p, x, splat(R(7.330184395e-4)));
    p = fma(p, x, splat(R(2.74242127714e-3)));
    p = fma(p, x, splat(R(7.884491794495e-3)));
    p = fma(p, x, splat(R(2.651698227214e-2)));
    p = fma(p, x, splat(R(1.1785111813409e-1)));
    p = fma(p, x, splat(R(1.4142135624230)));
    return p * square_root(x);
}

/* g: what the term r s / t adds to the light that meets the surface once: 0 upright, k at the horizon. */
static vreal oren_nayar_gain(vreal cosine) {
    const vreal sine = square_root((splat(1) - cosine) * (splat(1) + cosine));
    const vreal beyond = divide(cosine * fma(sine, sine, splat(1) + sine), splat(1) + sine);
    const vreal sum = angle_of(cosine) + fma(splat(R(2.0) / R(3.0)), beyond, fma(-sine, cosine, splat(-(R(2.0) / R(3.0)))));
    return at_least(sine * sum * R(0.3183098861837907), splat(0));
}

static vreal clamped_cosine(Vec3 a, Vec3 b) { return at_most(at_least(dot3(a, b), splat(0)), splat(1)); }

/* A direction of the lanes `rest`: of what the cosine lacks of `once`, or of `again`. For the former, in c = ci and the angle
 * about the normal, proportional to cos(angle) S min(c / co, (1 - c) / (1 - co)), where S is the sine of c. */
static Vec3 oren_nayar_rest(const Surface *surface, Vec3 aside, vreal co, SampleKey key, vuint bounce, vbool again, vbool rest) {
    const Vec3 n = surface->normal;
    const vreal aside2 = dot3(aside, aside);
    const vbool slants = aside2 > splat(UPRIGHT_SINE2);
    Vec3 t, b;
    basis_across(n, &t, &b);
    t = choose3(slants, scale3(divide(splat(1), square_root(choose(slants, aside2, splat(1)))), aside), t);
    b = vec3(fma(n.y, t.z, -(n.z * t.y)), fma(n.z, t.x, -(n.x * t.z)), fma(n.x, t.y, -(n.y * t.x)));
    Vec3 direction = n;
    for (uint i = 0; i < OREN_NAYAR_TRIES && any_lane(rest); ++i) {
        const vuint dimension = bounce + (REJECTION_FIRST + i * REJECTION_STRIDE);
        const vreal u = uniform(key, dimension), v = uniform(key, dimension + 1u);
        const vreal across = choose(again, u, fma(splat(R(2.0)), u, splat(-1)));
        const vreal c = choose(again, square_root(u), v);
        const vreal sine = square_root((splat(1) - c) * (splat(1) + c));
        vreal along_t = square_root((splat(1) - across) * (splat(1) + across)), along_b = across;
        if (any_lane(again & rest)) {
            vreal turn_sine, turn_cosine;
            sin_cos_turn(v, &turn_sine, &turn_cosine);
            along_t = choose(again, turn_cosine, along_t);
            along_b = choose(again, turn_sine, along_b);
        }
        const vreal once = sine * smaller(divide(c, at_least(co, splat(R(1e-30)))), divide(splat(1) - c, at_least(splat(1) - co, splat(R(1e-30)))));
        const vreal share = choose(again, fma(oren_nayar_gain(c), splat(R(-1.0) / OREN_NAYAR_K), splat(1)), once);
        const vbool taken = rest & (uniform(key, dimension + 2u) < share);
        const Vec3 candidate = madd3(c, n, madd3(sine * along_t, t, scale3(sine * along_b, b)));
        direction = choose3(taken, candidate, direction);
        rest = rest & vbool_not(taken);
    }
    return direction;
}

static BsdfSample oren_nayar_sample(const Surface *surface, SampleKey key, vuint bounce) {
    const Vec3 n = surface->normal, outgoing = scale3(splat(-1), surface->incoming);
    const vreal r = surface->roughness;
    const vreal co = clamped_cosine(outgoing, n);
    const Vec3 aside = madd3(-dot3(outgoing, n), n, outgoing);
    /* Over A, the share of the cosine is 1, of the rest of `once` r g, and all together are 1 + k r. */
    const vreal part = sample_1d(key, bounce + BOUNCE_CHOICE) * fma(splat(OREN_NAYAR_K), r, splat(1));
    const vbool rest = part >= splat(1);
    const vbool again = part >= fma(r, oren_nayar_gain(co), splat(1));
    Vec3 direction = add3(n, random_direction(key, bounce));
    const vbool vanished = dot3(direction, n) < splat(R(8.0) * ROUNDOFF);
    direction = normalise3(choose3(vanished, n, direction));
    const vreal s = dot3(direction, aside), aside2 = dot3(aside, aside);
    const vbool back = vbool_not(rest) & (aside2 > splat(UPRIGHT_SINE2)) & (uniform(key, bounce + BOUNCE_BALL_RADIUS) < -s * r);
    if (any_lane(back)) {
        const Vec3 turned = normalise3(madd3(divide(splat(-2) * s, choose(back, aside2, splat(1))), aside, direction));
        direction = choose3(back & (dot3(turned, n) > splat(0)), turned, direction);
    }
    if (any_lane(rest))
        direction = choose3(rest, normalise3(oren_nayar_rest(surface, aside, co, key, bounce, again & rest, rest)), direction);
    BsdfSample sample = bsdf_sample_reflected(surface, direction);
    if (any_lane(again)) {
        const vreal mean = divide(fma(splat(OREN_NAYAR_Q), r, splat(1)), fma(splat(OREN_NAYAR_K), r, splat(1)));
        const Vec3 a = surface->albedo;
        const Vec3 colour = vec3(divide(a.x * a.x * mean, fma(a.x, mean - splat(1), splat(1))),
                                 divide(a.y * a.y * mean, fma(a.y, mean - splat(1), splat(1))),
                                 divide(a.z * a.z * mean, fma(a.z, mean - splat(1), splat(1))));
        sample.weight = choose3(again, colour, sample.weight);
    }
#if SAMPLES_LAMPS
    sample.lobe.fuzz = r;
    sample.lobe.kind = choose_uint(again, splat_uint(LOBE_OREN_NAYAR_AGAIN), splat_uint(LOBE_OREN_NAYAR_ONCE));
#endif
    return sample;
}

#if SAMPLES_LAMPS
static vreal oren_nayar_pdf(const Lobe *lobe, Vec3 direction) {
    const vreal ci = clamped_cosine(direction, lobe->axis), co = clamped_cosine(lobe->outgoing, lobe->axis);
    const Vec3 aside = madd3(-dot3(lobe->outgoing, lobe->axis), lobe->axis, lobe->outgoing);
    const vreal s = dot3(direction, aside);
    const vbool above = ci > splat(0);
    const vreal share = choose(s > splat(0), divide(ci, choose(above, larger(ci, co), splat(1))), ci);
    const vreal once = divide(fma(lobe->fuzz * s, share, ci), fma(lobe->fuzz, oren_nayar_gain(co), splat(1)));
    const vreal again = ci * (splat(OREN_NAYAR_K) - oren_nayar_gain(ci)) * (R(1.0) / (OREN_NAYAR_K - OREN_NAYAR_Q));
    const vreal density = choose(vbool_of_uint(lobe->kind == splat_uint(LOBE_OREN_NAYAR_AGAIN)), again, once);
    return choose(above, at_least(density, splat(0)) * PI_INVERSE, splat(0));
}
#endif
#endif
