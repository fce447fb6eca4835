/* rough_metal.cl: metal whose surface is made of tiny mirrors, which face all ways by the GGX distribution.
 *
 * In and out: as bsdf.cl says.   Knows: bsdf.cl.   Does not know: other lobes.
 *
 * B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, with alpha = roughness^2, heights and
 * shadows that belong together (E. Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", 2014), and the
 * same albedo at all angles, as metal without roughness has it. For directions o and i with cosines co and ci, and h halfway:
 *
 *   f = albedo D(h) G / (4 co ci)     D = alpha^2 / (pi (alpha^2 cos^2 + sin^2)^2)     G = 2 co ci / (co qi + ci qo)
 *   q = root of (c^2 + alpha^2 (1 - c^2)), for each of the two cosines c
 *
 * The facet is drawn among those that are seen from o (J. Dupuy and A. Benyoub, "Sampling Visible GGX Normals with Spherical
 * Caps", 2023). That leaves the density D / (2 (co + qo)), so the weight f ci / density is the albedo times
 * (co + qo) ci / (co qi + ci qo), never more than the albedo. What a facet sends below the surface is lost, and so is what it
 * sends into another: no light is reflected twice between facets. */
#if EFFECT_ROUGH_METAL || EFFECT_GLOSSY || EFFECT_ROUGH_DIELECTRIC
#define LIT_ROUGHNESS_MIN R(0x1p-4) /* with less, rays to lamps gain nothing, and float does not hold the densities well */
#define GRAZING_COSINE R(0x1p-40)   /* of directions that rounding puts on the horizon or below */

static vreal smith_root(vreal cosine, vreal alpha) {
    return square_root(fma(alpha * alpha, (splat(1) - cosine) * (splat(1) + cosine), cosine * cosine));
}

/* The weight over the albedo. */
static vreal facets_seen(vreal co, vreal ci, vreal alpha) {
    const vreal qo = smith_root(co, alpha), qi = smith_root(ci, alpha);
    return divide((co + qo) * ci, fma(co, qi, ci * qo));
}

static vreal facet_cosine(Vec3 direction, Vec3 normal) {
    return at_most(at_least(dot3(direction, normal), splat(GRAZING_COSINE)), splat(1));
}

static BsdfSample rough_metal_sample(const Surface *surface, SampleKey key, vuint bounce) {
    const Vec3 n = surface->normal, outgoing = scale3(splat(-1), surface->incoming);
    const vreal alpha = surface->roughness * surface->roughness;
    const vreal co = facet_cosine(outgoing, n);
    Vec3 s, t;
    basis_across(n, &s, &t);
    /* Stretched, so that the facets are those of a half sphere. */
    const vreal x = alpha * dot3(outgoing, s), y = alpha * dot3(outgoing, t);
    const vreal inverse = divide(splat(1), square_root(fma(x, x, fma(y, y, co * co))));
    const vreal w = co * inverse;
    vreal u, v, sine_turn, cosine_turn;
    sample_2d(key, bounce + BOUNCE_DIRECTION, &u, &v);
    sin_cos_turn(u, &sine_turn, &cosine_turn);
    const vreal high = (splat(1) - v) * (splat(1) + w);
    const vreal radius = square_root(at_least(v * (splat(1) + w) * (splat(1) - w + high), splat(0)));
    const vreal along_s = alpha * fma(radius, cosine_turn, x * inverse), along_t = alpha * fma(radius, sine_turn, y * inverse);
    const Vec3 facet = normalise3(madd3(high, n, madd3(along_s, s, scale3(along_t, t))));
    const Vec3 direction = normalise3(madd3(splat(2) * dot3(outgoing, facet), facet, surface->incoming));
    const vreal ci = dot3(direction, n);
    BsdfSample sample = bsdf_sample_reflected(surface, direction);
    sample.scattered = ci > splat(0);
    sample.weight = scale3(facets_seen(co, facet_cosine(direction, n), alpha), surface->albedo);
#if SAMPLES_LAMPS
    sample.lobe.fuzz = alpha;
    sample.lobe.kind = choose_uint(surface->roughness >= splat(LIT_ROUGHNESS_MIN), splat_uint(LOBE_ROUGH_METAL), splat_uint(LOBE_NONE));
#endif
    return sample;
}

#if SAMPLES_LAMPS
/* The sine of the angle from the normal comes from the part of h across it, which keeps the bits that 1 - cos^2 loses. */
static vreal rough_metal_pdf(const Lobe *lobe, Vec3 direction) {
    const vreal alpha = lobe->fuzz, ci = dot3(direction, lobe->axis);
    const Vec3 half_way = add3(lobe->outgoing, direction);
    const vreal along = dot3(half_way, lobe->axis);
    const Vec3 across = madd3(-along, lobe->axis, half_way);
    const vbool above = (ci > splat(0)) & (along > splat(0));
    const vreal length2 = choose(above, dot3(half_way, half_way), splat(1));
    const vreal spread = divide(fma(alpha * alpha, along * along, dot3(across, across)), length2);
    const vreal co = facet_cosine(lobe->outgoing, lobe->axis);
    const vreal density = divide(alpha * alpha * (R(0.5) * PI_INVERSE), spread * spread * (co + smith_root(co, alpha)));
    return choose(above, density, splat(0));
}

static Vec3 rough_metal_weight(const Lobe *lobe, Vec3 direction) {
    const vreal co = facet_cosine(lobe->outgoing, lobe->axis), ci = facet_cosine(direction, lobe->axis);
    return scale3(facets_seen(co, ci, lobe->fuzz), lobe->albedo);
}
#endif
#endif
