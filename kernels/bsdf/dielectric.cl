/* dielectric.cl: refraction, Fresnel reflection and total reflection.
 *
 * In and out: as bsdf.cl says.   Knows: bsdf.cl, fresnel.cl.   Does not know: other lobes. */
#if EFFECT_DIELECTRIC
/* C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994, as the book uses it: always the
 * cosine of incidence, from inside too. */
static vreal fresnel_schlick(vreal c, vreal n) {
    const vreal root = divide(R(1.0) - n, R(1.0) + n);
    const vreal r0 = root * root;
    const vreal m = R(1.0) - c;
    const vreal m2 = m * m;
    return fma(R(1.0) - r0, m2 * m2 * m, r0);
}

/* From this ratio of the indices on, the direction of refraction is found from the part of the incoming one along the
 * surface, which magnifies no rounding but that of directions and normals. Below, the quicker way errs by as little. */
#define STEEP_RATIO R(8.0)

/* The part of a refracted direction along the surface; `c`: the cosine of incidence. */
static Vec3 along_surface(const Surface *surface, vreal c, vreal ratio) {
    return scale3(ratio, madd3(c, surface->normal, surface->incoming));
}

/* Chooses reflection with the probability of the reflectance, so the weight is the albedo, which is stored as 1. Where
 * the scene wants total reflection to absorb, it ends the path. A pilot's path chooses halfway between that and an even
 * chance, so the weight is how much more often a picture's path would choose the same. */
static BsdfSample dielectric_sample(const Surface *surface, SampleKey key, vuint bounce) {
    /* index of the far side over the near side */
    const vreal n = choose(surface->enters, surface->refraction_index, divide(splat(1), surface->refraction_index));
    const vreal c = at_most(at_least(-dot3(surface->incoming, surface->normal), splat(0)), splat(1));
    const vreal ratio = divide(splat(1), n);
    /* (1-c)(1+c) keeps the bits that 1 - c c loses near normal incidence */
    vreal transmitted2 = fma(-ratio * ratio, (R(1.0) - c) * (R(1.0) + c), splat(1));
    const vbool steep = ratio > splat(STEEP_RATIO);
    if (any_lane(steep)) {
        const Vec3 along = along_surface(surface, c, ratio);
        transmitted2 = choose(steep, splat(1) - dot3(along, along), transmitted2);
    }
    const vbool total = transmitted2 < splat(0);
    const vreal t = square_root(fabs(transmitted2));
    const vbool exact = vbool_of_uint(surface->variant == splat_uint(FRESNEL_EXACT));
    const vbool none = vbool_of_uint(surface->variant == splat_uint(FRESNEL_NONE));
    vreal reflectance = fresnel_schlick(c, ratio);
    if (any_lane(exact)) reflectance = choose(exact, fresnel_exact(c, n, t), reflectance);
    reflectance = choose(none, splat(0), reflectance);
    const vbool as_reflection = vbool_of_uint(surface->total_reflection == splat_uint(TOTAL_REFLECT));
    const vbool as_refraction = vbool_of_uint(surface->total_reflection == splat_uint(TOTAL_REFRACT));
    vreal odds_of_reflection = reflectance;
#if PILOT
    if (surface->evenly) {
        const vbool both = (reflectance > splat(0)) & (reflectance < splat(1));
        odds_of_reflection = choose(both, fma(R(0.5), reflectance, splat(R(0.25))), reflectance);
    }
#endif
    const vbool by_chance = sample_1d(key, bounce + BOUNCE_CHOICE) < odds_of_reflection;
    const vbool reflects = (total & as_reflection) | (vbool_not(total) & by_chance);
    const vbool lost = total & vbool_not(as_reflection | as_refraction);
    const Vec3 mirrored = madd3(splat(2) * c, surface->normal, surface->incoming);
    Vec3 bent = madd3(fma(ratio, c, -t), surface->normal, scale3(ratio, surface->incoming));
    if (any_lane(steep)) bent = choose3(steep, madd3(-t, surface->normal, along_surface(surface, c, ratio)), bent);
    /* Equal indices: there is no surface. */
    const vbool matched = surface->refraction_index == splat(1);
    const vbool refracted = vbool_not(reflects) | matched;
    const Vec3 direction = normalise3(choose3(refracted, bent, mirrored));
    BsdfSample sample = bsdf_sample_reflected(surface, choose3(matched, surface->incoming, direction));
    sample.scattered = vbool_not(lost) | matched;
    sample.transmitted = refracted;
#if PILOT
    if (surface->evenly) {
        const vreal share = choose(by_chance, divide(reflectance, odds_of_reflection), divide(splat(1) - reflectance, splat(1) - odds_of_reflection));
        const vbool sure = total | matched | vbool_of_uint(odds_of_reflection == reflectance);
        sample.odds = choose(sure, sample.odds, share);
        sample.weight = scale3(sample.odds, sample.weight);
    }
#endif
    return sample;
}
#endif
