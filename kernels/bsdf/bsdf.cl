/* bsdf.cl: what a surface does to a path: one sampling function per effect, in lane code.
 *
 * In:    the surface where the path stands, the incoming direction, random numbers.
 * Out:   the next direction, the weight on radiance that comes along it, and on which side the path goes on. */
typedef struct Surface {
    Vec3 incoming; /* unit direction of the path, towards the surface */
    Vec3 normal;   /* unit, on the side that the path comes from */
    vbool enters;  /* the path comes from outside */
    Vec3 albedo;
    vreal fuzz, refraction_index;
    vuint kind, lobe, variant, total_reflection;
} Surface;

typedef struct BsdfSample {
    Vec3 direction; /* unit */
    Vec3 weight;
    vbool scattered;
    vbool transmitted; /* goes on beyond the surface */
} BsdfSample;

/* With one kind of material in the scene there is nothing to ask. */
#define KIND_COUNT (EFFECT_LAMBERTIAN + EFFECT_METAL + EFFECT_DIELECTRIC + EFFECT_NORMALS + EFFECT_EMISSION)
#if KIND_COUNT == 1
#define has_kind(surface, wanted) (splat(0) == splat(0))
#else
#define has_kind(surface, wanted) vbool_of_uint((surface)->kind == splat_uint(wanted))
#endif

#if EFFECT_LAMBERTIAN || EFFECT_METAL
static Vec3 random_direction(SampleKey key, vuint bounce) {
    vreal u, v;
    sample_2d(key, bounce + BOUNCE_DIRECTION, &u, &v);
    return sample_sphere(u, v);
}

static vreal random_ball_radius(SampleKey key, vuint bounce) {
    return sample_ball_radius(uniform(key, bounce + BOUNCE_BALL_RADIUS), uniform(key, bounce + (BOUNCE_BALL_RADIUS + 1u)),
                              uniform(key, bounce + (BOUNCE_BALL_RADIUS + 2u)));
}
#endif

#if EFFECT_LAMBERTIAN
/* The book's three lobes. Lambertian: a point of the unit sphere around the tip of the normal. Cosine cubed (first
 * edition): a point of the unit ball there. Hemisphere: uniform over directions. */
static Vec3 scatter_lambertian(const Surface *surface, SampleKey key, vuint bounce) {
    const vbool ball = vbool_of_uint(surface->lobe == splat_uint(LOBE_COSINE_CUBED));
    const vbool hemisphere = vbool_of_uint(surface->lobe == splat_uint(LOBE_HEMISPHERE));
    Vec3 offset = random_direction(key, bounce);
    if (any_lane(ball)) offset = scale3(choose(ball, random_ball_radius(key, bounce), splat(1)), offset);
    Vec3 direction = add3(surface->normal, offset);
    if (any_lane(hemisphere)) {
        const vreal side = choose(dot3(offset, surface->normal) < splat(0), splat(-1), splat(1));
        direction = choose3(hemisphere, scale3(side, offset), direction);
    }
    /* normal + offset can vanish, or be so short that rounding may point it below the surface: then straight up. */
    const vbool vanished = dot3(direction, surface->normal) < splat(R(8.0) * ROUNDOFF);
    return normalise3(choose3(vanished, surface->normal, direction));
}
#endif

#if EFFECT_METAL
/* Mirror direction, unit, plus fuzz times a point of the unit sphere (fourth edition) or ball (first, third). What
 * ends below the surface is absorbed: *up is false there. */
static Vec3 scatter_metal(const Surface *surface, SampleKey key, vuint bounce, vbool *up) {
    const vreal along = dot3(surface->incoming, surface->normal);
    Vec3 direction = normalise3(madd3(splat(-2) * along, surface->normal, surface->incoming));
    if (any_lane(surface->fuzz > splat(0))) {
        const vbool ball = vbool_of_uint(surface->variant == splat_uint(FUZZ_BALL));
        Vec3 offset = random_direction(key, bounce);
        if (any_lane(ball)) offset = scale3(choose(ball, random_ball_radius(key, bounce), splat(1)), offset);
        const Vec3 fuzzy = madd3(surface->fuzz, offset, direction);
        const vbool vanished = dot3(fuzzy, fuzzy) < splat(R(1e-12));
        direction = choose3(vanished | vbool_not(surface->fuzz > splat(0)), direction, normalise3(fuzzy));
    }
    *up = dot3(direction, surface->normal) > splat(0);
    return direction;
}
#endif

#if EFFECT_DIELECTRIC
/* Reflectance of unpolarised light. c: cosine of incidence, in [0, 1]; n: index of the far over the near side;
 * t: cosine of refraction. Fresnel's equations (M. Born and E. Wolf, Principles of Optics, 1.5.2). */
static vreal fresnel_exact(vreal c, vreal n, vreal t) {
    const vreal across = (c - n * t) / (c + n * t);
    const vreal along = (n * c - t) / (n * c + t);
    return R(0.5) * fma(across, across, along * along);
}

/* C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994, as the book uses it: always the
 * cosine of incidence, from inside too. */
static vreal fresnel_schlick(vreal c, vreal n) {
    const vreal root = (R(1.0) - n) / (R(1.0) + n);
    const vreal r0 = root * root;
    const vreal m = R(1.0) - c;
    const vreal m2 = m * m;
    return fma(R(1.0) - r0, m2 * m2 * m, r0);
}

/* Chooses reflection with the probability of the reflectance, so the weight is the albedo, which is 1. *lost:
 * absorbed, where the scene wants total reflection to absorb. */
static Vec3 scatter_dielectric(const Surface *surface, SampleKey key, vuint bounce, vbool *refracted, vbool *lost) {
    /* index of the far side over the near side */
    const vreal n = choose(surface->enters, surface->refraction_index, splat(1) / surface->refraction_index);
    const vreal c = at_most(at_least(-dot3(surface->incoming, surface->normal), splat(0)), splat(1));
    const vreal ratio = splat(1) / n;
    /* (1-c)(1+c) keeps the bits that 1 - c c loses near normal incidence */
    const vreal transmitted2 = fma(-ratio * ratio, (R(1.0) - c) * (R(1.0) + c), splat(1));
    const vbool total = transmitted2 < splat(0);
    const vreal t = sqrt(fabs(transmitted2));
    const vbool exact = vbool_of_uint(surface->variant == splat_uint(FRESNEL_EXACT));
    const vbool none = vbool_of_uint(surface->variant == splat_uint(FRESNEL_NONE));
    vreal reflectance = fresnel_schlick(c, ratio);
    if (any_lane(exact)) reflectance = choose(exact, fresnel_exact(c, n, t), reflectance);
    reflectance = choose(none, splat(0), reflectance);
    const vbool as_reflection = vbool_of_uint(surface->total_reflection == splat_uint(TOTAL_REFLECT));
    const vbool as_refraction = vbool_of_uint(surface->total_reflection == splat_uint(TOTAL_REFRACT));
    const vbool by_chance = sample_1d(key, bounce + BOUNCE_CHOICE) < reflectance;
    const vbool reflects = (total & as_reflection) | (vbool_not(total) & by_chance);
    *lost = total & vbool_not(as_reflection | as_refraction);
    const Vec3 mirrored = madd3(splat(2) * c, surface->normal, surface->incoming);
    const Vec3 bent = madd3(fma(ratio, c, -t), surface->normal, scale3(ratio, surface->incoming));
    /* Equal indices: there is no surface. */
    const vbool matched = surface->refraction_index == splat(1);
    *refracted = vbool_not(reflects) | matched;
    *lost = *lost & vbool_not(matched);
    const Vec3 direction = normalise3(choose3(*refracted, bent, mirrored));
    return choose3(matched, surface->incoming, direction);
}
#endif

static BsdfSample scatter(const Surface *surface, SampleKey key, vuint depth) {
    const vuint bounce = depth * DIMENSIONS_PER_BOUNCE + DIMENSION_BOUNCE;
    const vbool nowhere = splat(0) != splat(0);
    BsdfSample bsdf_sample;
    bsdf_sample.direction = surface->normal;
    bsdf_sample.weight = surface->albedo;
    bsdf_sample.scattered = nowhere;
    bsdf_sample.transmitted = nowhere;
#if EFFECT_LAMBERTIAN
    const vbool diffuse = has_kind(surface, KIND_LAMBERTIAN);
    if (any_lane(diffuse)) {
        bsdf_sample.direction = choose3(diffuse, scatter_lambertian(surface, key, bounce), bsdf_sample.direction);
        bsdf_sample.scattered = bsdf_sample.scattered | diffuse;
    }
#endif
#if EFFECT_METAL
    const vbool metal = has_kind(surface, KIND_METAL);
    if (any_lane(metal)) {
        vbool up;
        bsdf_sample.direction = choose3(metal, scatter_metal(surface, key, bounce, &up), bsdf_sample.direction);
        bsdf_sample.scattered = bsdf_sample.scattered | (metal & up);
    }
#endif
#if EFFECT_DIELECTRIC
    const vbool glass = has_kind(surface, KIND_DIELECTRIC);
    if (any_lane(glass)) {
        vbool refracted, lost;
        bsdf_sample.direction =
            choose3(glass, scatter_dielectric(surface, key, bounce, &refracted, &lost), bsdf_sample.direction);
        bsdf_sample.scattered = bsdf_sample.scattered | (glass & vbool_not(lost));
        bsdf_sample.transmitted = glass & refracted;
    }
#endif
    return bsdf_sample;
}
