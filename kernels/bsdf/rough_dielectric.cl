/* rough_dielectric.cl: glass whose surface is made of tiny facets, which face all ways by the GGX distribution.
 *
 * In and out: as bsdf.cl says.   Knows: bsdf.cl, fresnel.cl, rough_metal.cl, which draws facets and reflects.   Does not know: other lobes.
 *
 * B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, equations 16, 17, 20 and 21. For directions o and i
 * with cosines co and ci, n the index of the far side over the near one, F Fresnel's reflectance of a facet h, D and q as
 * rough_metal.cl has them:
 *
 *   i above:  f = F D G / (4 co ci)                                                 h along o + i, G of rough_metal.cl
 *   i below:  f = (1 - F) D g(co) g(|ci|) n^2 (o.h) |i.h| / (co |ci| |o + n i|^2)   h along o + n i or against it, g = 2 c / (c + q)
 *
 * Of what is refracted, heights above and below do not belong together, so each side has its own shadows. As in dielectric.cl, light counts
 * by its radiance over the squared index, hence n^2: f(o, i) over the square of i's index is the same both ways.
 * The facet is drawn among those that are seen from o, and reflects with the probability F. That leaves the density F D / (2 (co + qo)) above,
 * and below (1 - F) D / (co + qo) times 2 n^2 (o.h) |i.h| / |o + n i|^2, where the last terms are the solid angle of facets over that of
 * directions. The weight is that of rough_metal.cl above, and g(|ci|) below: never more than 1. What a facet sends to the wrong side is lost.
 *
 * One lobe has both sides, so rays to lamps go to both. */
#if EFFECT_ROUGH_DIELECTRIC
/* The larger index over the smaller one. Closer than that, float does not hold the densities of refraction well: it is nearly straight. */
#define LIT_INDEX_MIN R(1.0625)

/* What is seen from a direction of the facets that face it: g above. */
static vreal facets_unhidden(vreal cosine, vreal alpha) {
    return divide(splat(2) * cosine, cosine + smith_root(cosine, alpha));
}

static BsdfSample rough_dielectric_sample(const Surface *surface, SampleKey key, vuint bounce) {
    BsdfSample sample = rough_metal_sample(surface, key, bounce);
    const Vec3 outgoing = scale3(splat(-1), surface->incoming);
    const vreal index = surface->refraction_index, inverse = divide(splat(1), index);
    const vreal n = choose(surface->enters, index, inverse), ratio = choose(surface->enters, inverse, index);
    const Vec3 facet = normalise3(madd3(splat(R(1e-20)), surface->normal, add3(outgoing, sample.direction)));
    const vreal c = facet_cosine(outgoing, facet);
    const vreal t = square_root(at_least(fma(-ratio * ratio, (splat(1) - c) * (splat(1) + c), splat(1)), splat(0)));
    const vbool reflects = sample_1d(key, bounce + BOUNCE_CHOICE) < fresnel_exact(c, n, t);
    const Vec3 bent = normalise3(madd3(fma(c, ratio, -t), facet, scale3(ratio, surface->incoming)));
    sample.direction = choose3(reflects, sample.direction, bent);
    const vreal ci = dot3(sample.direction, surface->normal);
    const vbool below = ci < splat(0);
    const vreal passed = facets_unhidden(facet_cosine(scale3(splat(-1), sample.direction), surface->normal), surface->roughness * surface->roughness);
    sample.weight = choose3(reflects, sample.weight, scale3(passed, surface->albedo));
    sample.scattered = (reflects & sample.scattered) | (vbool_not(reflects) & below);
    /* Also of what is lost: rays to lamps leave by the side of this direction, or by the other (turned_inward). */
    sample.transmitted = below;
    /* Equal indices: there is no surface. */
    const vbool matched = index == splat(1);
    if (any_lane(matched)) {
        sample.direction = choose3(matched, surface->incoming, sample.direction);
        sample.weight = choose3(matched, surface->albedo, sample.weight);
        sample.scattered = sample.scattered | matched;
        sample.transmitted = sample.transmitted | matched;
    }
#if SAMPLES_LAMPS
    const vbool lit = (surface->roughness >= splat(LIT_ROUGHNESS_MIN)) & (larger(n, ratio) >= splat(LIT_INDEX_MIN));
    sample.lobe.refraction_index = n;
    sample.lobe.kind = choose_uint(lit, splat_uint(LOBE_ROUGH_DIELECTRIC), splat_uint(LOBE_NONE));
#endif
    return sample;
}

#if SAMPLES_LAMPS
static vbool is_rough_dielectric(const Lobe *lobe) { return vbool_of_uint(lobe->kind == splat_uint(LOBE_ROUGH_DIELECTRIC)); }

static vreal rough_dielectric_pdf(const Lobe *lobe, Vec3 direction) {
    const vreal alpha = lobe->fuzz, n = lobe->refraction_index;
    const vbool below = dot3(direction, lobe->axis) < splat(0);
    const Vec3 both = madd3(choose(below, n, splat(1)), direction, lobe->outgoing);
    const vreal along = dot3(both, lobe->axis);
    const Vec3 across = madd3(-along, lobe->axis, both);
    const vreal length2 = at_least(dot3(both, both), splat(R(1e-30)));
    /* Of the facet, which faces the side of the normal. */
    const vreal inverse = divide(choose(along < splat(0), splat(-1), splat(1)), square_root(length2));
    const vreal c = at_most(dot3(lobe->outgoing, both) * inverse, splat(1)), d = dot3(direction, both) * inverse;
    const vbool possible = (c > splat(0)) & ((below & (d < splat(0))) | (vbool_not(below) & (d > splat(0))));
    const vreal ratio = divide(splat(1), n);
    const vreal t2 = at_least(fma(-ratio * ratio, (splat(1) - c) * (splat(1) + c), splat(1)), splat(0));
    const vreal t = choose(below, at_most(-d, splat(1)), square_root(t2));
    const vreal reflectance = fresnel_exact(choose(possible, c, splat(1)), n, choose(possible, t, splat(1)));
    const vreal spread = divide(fma(alpha * alpha, along * along, dot3(across, across)), length2);
    const vreal co = facet_cosine(lobe->outgoing, lobe->axis);
    const vreal facets = divide(R(0.5) * PI_INVERSE * alpha * alpha, spread * spread * (co + smith_root(co, alpha)));
    const vreal turned = divide(splat(-4) * n * n * c * d, length2);
    const vreal density = facets * choose(below, (splat(1) - reflectance) * turned, reflectance);
    return choose(possible, density, splat(0));
}

static Vec3 rough_dielectric_weight(const Lobe *lobe, Vec3 direction) {
    const vbool below = dot3(direction, lobe->axis) < splat(0);
    const vreal passed = facets_unhidden(facet_cosine(scale3(splat(-1), direction), lobe->axis), lobe->fuzz);
    return choose3(below, scale3(passed, lobe->albedo), rough_metal_weight(lobe, direction));
}

/* Whether a ray to a lamp leaves the vertex of a path into its sphere: as the path does where both directions are on one side. */
static vbool turned_inward(const Lobe *lobe, Vec3 of_path, Vec3 direction, vbool inward) {
    const vbool a = dot3(of_path, TRUE_NORMAL(lobe->)) < splat(0), b = dot3(direction, TRUE_NORMAL(lobe->)) < splat(0);
    const vbool turned = is_rough_dielectric(lobe) & ((a & vbool_not(b)) | (vbool_not(a) & b));
    return (inward & vbool_not(turned)) | (vbool_not(inward) & turned);
}
#endif
#endif
