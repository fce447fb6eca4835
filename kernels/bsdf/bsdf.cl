/* bsdf.cl: what a surface does to a path: one sampling function per effect, in lane code.
 *
 * In:    the surface where the path stands, the incoming direction, random numbers.
 * Out:   the next direction, the weight on radiance that comes along it, and on which side the path goes on. */
typedef struct Surface {
    Vec3 incoming; /* unit direction of the path, towards the surface */
    Vec3 normal;   /* unit, on the side that the path comes from */
    masks enters;  /* the path comes from outside */
    Vec3 albedo;
    reals fuzz, refraction_index;
    uints kind, lobe, variant, total_reflection;
} Surface;

typedef struct Scattering {
    Vec3 direction; /* unit */
    Vec3 weight;
    masks goes_on;
    masks refracted; /* goes on beyond the surface */
} Scattering;

/* With one kind of material in the scene there is nothing to ask. */
#define KIND_COUNT (EFFECT_LAMBERTIAN + EFFECT_METAL + EFFECT_DIELECTRIC + EFFECT_NORMALS + EFFECT_EMISSION)
#if KIND_COUNT == 1
#define has_kind(surface, wanted) (splat(0) == splat(0))
#else
#define has_kind(surface, wanted) mask_of_uint((surface)->kind == splat_uint(wanted))
#endif

#if EFFECT_LAMBERTIAN || EFFECT_METAL
static Vec3 random_direction(SampleKey key, uints bounce) {
    reals u, v;
    sample_2d(key, bounce + BOUNCE_DIRECTION, &u, &v);
    return sample_sphere(u, v);
}

static reals random_ball_radius(SampleKey key, uints bounce) {
    return sample_ball_radius(uniform(key, bounce + BOUNCE_BALL_RADIUS), uniform(key, bounce + (BOUNCE_BALL_RADIUS + 1u)),
                              uniform(key, bounce + (BOUNCE_BALL_RADIUS + 2u)));
}
#endif

#if EFFECT_LAMBERTIAN
/* The book's three lobes. Lambertian: a point of the unit sphere around the tip of the normal. Cosine cubed (first
 * edition): a point of the unit ball there. Hemisphere: uniform over directions. */
static Vec3 scatter_lambertian(const Surface *surface, SampleKey key, uints bounce) {
    const masks ball = mask_of_uint(surface->lobe == splat_uint(LOBE_COSINE_CUBED));
    const masks hemisphere = mask_of_uint(surface->lobe == splat_uint(LOBE_HEMISPHERE));
    Vec3 offset = random_direction(key, bounce);
    if (any_lane(ball)) offset = scale3(choose(ball, random_ball_radius(key, bounce), splat(1)), offset);
    Vec3 direction = add3(surface->normal, offset);
    if (any_lane(hemisphere)) {
        const reals side = choose(dot3(offset, surface->normal) < splat(0), splat(-1), splat(1));
        direction = choose3(hemisphere, scale3(side, offset), direction);
    }
    /* normal + offset can vanish, or be so short that rounding may point it below the surface: then straight up. */
    const masks vanished = dot3(direction, surface->normal) < splat(R(8.0) * ROUNDOFF);
    return normalise3(choose3(vanished, surface->normal, direction));
}
#endif

#if EFFECT_METAL
/* Mirror direction, unit, plus fuzz times a point of the unit sphere (fourth edition) or ball (first, third). What
 * ends below the surface is absorbed: *up is false there. */
static Vec3 scatter_metal(const Surface *surface, SampleKey key, uints bounce, masks *up) {
    const reals along = dot3(surface->incoming, surface->normal);
    Vec3 direction = normalise3(madd3(splat(-2) * along, surface->normal, surface->incoming));
    if (any_lane(surface->fuzz > splat(0))) {
        const masks ball = mask_of_uint(surface->variant == splat_uint(FUZZ_BALL));
        Vec3 offset = random_direction(key, bounce);
        if (any_lane(ball)) offset = scale3(choose(ball, random_ball_radius(key, bounce), splat(1)), offset);
        const Vec3 fuzzy = madd3(surface->fuzz, offset, direction);
        const masks vanished = dot3(fuzzy, fuzzy) < splat(R(1e-12));
        direction = choose3(vanished | not_mask(surface->fuzz > splat(0)), direction, normalise3(fuzzy));
    }
    *up = dot3(direction, surface->normal) > splat(0);
    return direction;
}
#endif

#if EFFECT_DIELECTRIC
/* Reflectance of unpolarised light. c: cosine of incidence, in [0, 1]; n: index of the far over the near side;
 * t: cosine of refraction. Fresnel's equations (M. Born and E. Wolf, Principles of Optics, 1.5.2). */
static reals fresnel_exact(reals c, reals n, reals t) {
    const reals across = (c - n * t) / (c + n * t);
    const reals along = (n * c - t) / (n * c + t);
    return R(0.5) * fma(across, across, along * along);
}

/* C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994, as the book uses it: always the
 * cosine of incidence, from inside too. */
static reals fresnel_schlick(reals c, reals n) {
    const reals root = (R(1.0) - n) / (R(1.0) + n);
    const reals r0 = root * root;
    const reals m = R(1.0) - c;
    const reals m2 = m * m;
    return fma(R(1.0) - r0, m2 * m2 * m, r0);
}

/* Chooses reflection with the probability of the reflectance, so the weight is the albedo, which is 1. *lost:
 * absorbed, where the scene wants total reflection to absorb. */
static Vec3 scatter_dielectric(const Surface *surface, SampleKey key, uints bounce, masks *refracted, masks *lost) {
    /* index of the far side over the near side */
    const reals n = choose(surface->enters, surface->refraction_index, splat(1) / surface->refraction_index);
    const reals c = at_most(at_least(-dot3(surface->incoming, surface->normal), splat(0)), splat(1));
    const reals ratio = splat(1) / n;
    /* (1-c)(1+c) keeps the bits that 1 - c c loses near normal incidence */
    const reals transmitted2 = fma(-ratio * ratio, (R(1.0) - c) * (R(1.0) + c), splat(1));
    const masks total = transmitted2 < splat(0);
    const reals t = sqrt(fabs(transmitted2));
    const masks exact = mask_of_uint(surface->variant == splat_uint(FRESNEL_EXACT));
    const masks none = mask_of_uint(surface->variant == splat_uint(FRESNEL_NONE));
    reals reflectance = fresnel_schlick(c, ratio);
    if (any_lane(exact)) reflectance = choose(exact, fresnel_exact(c, n, t), reflectance);
    reflectance = choose(none, splat(0), reflectance);
    const masks as_reflection = mask_of_uint(surface->total_reflection == splat_uint(TOTAL_REFLECT));
    const masks as_refraction = mask_of_uint(surface->total_reflection == splat_uint(TOTAL_REFRACT));
    const masks by_chance = sample_1d(key, bounce + BOUNCE_CHOICE) < reflectance;
    const masks reflects = (total & as_reflection) | (not_mask(total) & by_chance);
    *lost = total & not_mask(as_reflection | as_refraction);
    const Vec3 mirrored = madd3(splat(2) * c, surface->normal, surface->incoming);
    const Vec3 bent = madd3(fma(ratio, c, -t), surface->normal, scale3(ratio, surface->incoming));
    /* Equal indices: there is no surface. */
    const masks matched = surface->refraction_index == splat(1);
    *refracted = not_mask(reflects) | matched;
    *lost = *lost & not_mask(matched);
    const Vec3 direction = normalise3(choose3(*refracted, bent, mirrored));
    return choose3(matched, surface->incoming, direction);
}
#endif

static Scattering scatter(const Surface *surface, SampleKey key, uints depth) {
    const uints bounce = depth * DIMENSIONS_PER_BOUNCE + DIMENSION_BOUNCE;
    const masks nowhere = splat(0) != splat(0);
    Scattering scattering;
    scattering.direction = surface->normal;
    scattering.weight = surface->albedo;
    scattering.goes_on = nowhere;
    scattering.refracted = nowhere;
#if EFFECT_LAMBERTIAN
    const masks diffuse = has_kind(surface, KIND_LAMBERTIAN);
    if (any_lane(diffuse)) {
        scattering.direction = choose3(diffuse, scatter_lambertian(surface, key, bounce), scattering.direction);
        scattering.goes_on = scattering.goes_on | diffuse;
    }
#endif
#if EFFECT_METAL
    const masks metal = has_kind(surface, KIND_METAL);
    if (any_lane(metal)) {
        masks up;
        scattering.direction = choose3(metal, scatter_metal(surface, key, bounce, &up), scattering.direction);
        scattering.goes_on = scattering.goes_on | (metal & up);
    }
#endif
#if EFFECT_DIELECTRIC
    const masks glass = has_kind(surface, KIND_DIELECTRIC);
    if (any_lane(glass)) {
        masks refracted, lost;
        scattering.direction =
            choose3(glass, scatter_dielectric(surface, key, bounce, &refracted, &lost), scattering.direction);
        scattering.goes_on = scattering.goes_on | (glass & not_mask(lost));
        scattering.refracted = glass & refracted;
    }
#endif
    return scattering;
}
