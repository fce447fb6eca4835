/* glossy.cl: a matte surface under a clear coat, such as plastic or varnished wood.
 *
 * In and out: as bsdf.cl says.   Knows: bsdf.cl, fresnel.cl, rough_metal.cl, by which a coat reflects.   Does not know: other lobes.
 *
 * For directions o and i with cosines co and ci, h halfway, F Fresnel's reflectance from outside, n the index:
 *
 *   f = M coat D(h) G / (4 co ci) + base      coat = min(F(o.h), F(co), F(ci)), M: the metal of rough_metal.cl, white
 *   base = albedo (1 - F(co)) (1 - F(ci)) / (pi (n^2 (1 - albedo) + albedo E))     E = integral of (1 - F(c)) 2c dc
 *
 * The base is Lambert's surface below the coat: of the light that enters, it sends up a part, of which the coat sends back 1 - E / n^2,
 * which makes the sum of all that leaves, over all turns, the term above. So a white base returns all that enters.
 * A facet reflects no more than a smooth coat does at either angle, because the rest enters and leaves by these angles:
 * with F(o.h) alone, a white surface would send back slightly more light than it gets. A smooth coat has h upright: all three are the same.
 *
 * The coat is drawn with the probability F(co), and weighs coat / F(co) times what metal does, 1 at most. The base
 * is drawn by a cosine, and by rejection with 1 - F(ci); so it has one weight, albedo E / (n^2 (1 - albedo) + albedo E), which is
 * at most the albedo. */
#if EFFECT_GLOSSY
#define COAT_TRIES 64u /* each succeeds with a probability of 0.3 at least, for an index of 10 */

static vreal coat_reflects(vreal cosine, vreal n) {
    const vreal ratio = divide(splat(1), n);
    const vreal t2 = fma(-ratio * ratio, (splat(1) - cosine) * (splat(1) + cosine), splat(1));
    return fresnel_exact(cosine, n, square_root(at_least(t2, splat(0))));
}

static vreal coat_cosine(Vec3 a, Vec3 b) { return at_most(at_least(dot3(a, b), splat(0)), splat(1)); }

/* coat / F(co). Upright facets, of a smooth coat, are as far from o as the normal, or nearly. */
static vreal coat_part(vreal n, Vec3 normal, Vec3 outgoing, Vec3 direction) {
    const Vec3 half_way = add3(outgoing, direction);
    const vreal length2 = at_least(dot3(half_way, half_way), splat(R(1e-30)));
    const vreal ch = at_most(R(0.5) * square_root(length2), splat(1));
    const vreal whole = coat_reflects(coat_cosine(outgoing, normal), n);
    const vreal least = smaller(coat_reflects(ch, n), coat_reflects(coat_cosine(direction, normal), n));
    return at_most(divide(least, at_least(whole, splat(R(1e-30)))), splat(1));
}

static BsdfSample glossy_coat_sample(const Surface *surface, SampleKey key, vuint bounce) {
    Surface coat = *surface;
    coat.albedo = vec3(splat(1), splat(1), splat(1));
    BsdfSample sample = rough_metal_sample(&coat, key, bounce);
    const Vec3 outgoing = scale3(splat(-1), surface->incoming);
    sample.weight = scale3(coat_part(surface->refraction_index, surface->normal, outgoing, sample.direction), sample.weight);
#if SAMPLES_LAMPS
    const vbool lit = vbool_of_uint(sample.lobe.kind == splat_uint(LOBE_ROUGH_METAL));
    sample.lobe.kind = choose_uint(lit, splat_uint(LOBE_GLOSSY_COAT), sample.lobe.kind);
#endif
    return sample;
}

static BsdfSample glossy_base_sample(const Surface *surface, SampleKey key, vuint bounce, vbool wanted) {
    const Vec3 n = surface->normal;
    Vec3 s, t, direction = n;
    basis_across(n, &s, &t);
    vreal u, v, choice = uniform(key, bounce + BOUNCE_BALL_RADIUS);
    sample_2d(key, bounce + BOUNCE_DIRECTION, &u, &v);
    for (uint i = 0; i < COAT_TRIES && any_lane(wanted); ++i) {
        vreal sine_turn, cosine_turn;
        sin_cos_turn(u, &sine_turn, &cosine_turn);
        const vreal c = square_root(splat(1) - v), sine = square_root(v);
        const vbool taken = wanted & (choice < splat(1) - coat_reflects(c, surface->refraction_index));
        const Vec3 candidate = madd3(c, n, madd3(sine * cosine_turn, s, scale3(sine * sine_turn, t)));
        direction = choose3(taken, candidate, direction);
        wanted = wanted & vbool_not(taken);
        const vuint dimension = bounce + (REJECTION_FIRST + i * REJECTION_STRIDE);
        u = uniform(key, dimension);
        v = uniform(key, dimension + 1u);
        choice = uniform(key, dimension + 2u);
    }
    BsdfSample sample = bsdf_sample_reflected(surface, normalise3(direction));
    const vreal index2 = surface->refraction_index * surface->refraction_index, in = surface->lets_in;
    const Vec3 a = surface->albedo;
    sample.weight = vec3(divide(a.x * in, fma(a.x, in, index2 * (splat(1) - a.x))),
                         divide(a.y * in, fma(a.y, in, index2 * (splat(1) - a.y))),
                         divide(a.z * in, fma(a.z, in, index2 * (splat(1) - a.z))));
#if SAMPLES_LAMPS
    sample.lobe.kind = splat_uint(LOBE_GLOSSY_BASE);
#endif
    return sample;
}

static BsdfSample choose_sample(vbool mask, BsdfSample a, BsdfSample b); /* scatter.cl */

static BsdfSample glossy_sample(const Surface *surface, SampleKey key, vuint bounce) {
    const vreal co = coat_cosine(scale3(splat(-1), surface->incoming), surface->normal);
    const vreal reflectance = coat_reflects(co, surface->refraction_index);
    vreal odds_of_coat = reflectance;
#if PILOT
    if (surface->evenly) odds_of_coat = fma(R(0.5), reflectance, splat(R(0.25)));
#endif
    const vbool reflects = sample_1d(key, bounce + BOUNCE_CHOICE) < odds_of_coat;
    BsdfSample sample = glossy_base_sample(surface, key, bounce, vbool_not(reflects));
    if (any_lane(reflects)) sample = choose_sample(reflects, glossy_coat_sample(surface, key, bounce), sample);
#if PILOT
    if (!surface->evenly) return sample;
    sample.odds = choose(reflects, divide(reflectance, odds_of_coat), divide(splat(1) - reflectance, splat(1) - odds_of_coat));
    sample.weight = scale3(sample.odds, sample.weight);
#endif
    return sample;
}

#if SAMPLES_LAMPS
static vreal glossy_base_pdf(const Lobe *lobe, Vec3 direction) {
    const vreal c = coat_cosine(direction, lobe->axis);
    return divide(c * (splat(1) - coat_reflects(c, lobe->refraction_index)) * PI_INVERSE, lobe->lets_in);
}
#endif
#endif
