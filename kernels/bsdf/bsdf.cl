/* bsdf.cl: what a lobe is given, and what it returns.
 *
 * A lobe is a file in bsdf/ with a function `..._sample(surface, key, bounce)` in lane code:
 * In:    the surface where a path stands, the key of its sample, the first dimension of its bounce (rng.cl).
 * Out:   a BsdfSample: a direction, drawn by some density, and its weight, which is f times the cosine over that density.
 * A lobe of many directions is lit by rays to lamps too. Then its sample has a Lobe of a kind of its own, from which follow
 *   `..._pdf(lobe, direction)`      the density with which the direction is drawn, per steradian, in all directions where f is
 *                                   not 0. It may sum up to less than 1: the rest is absorbed.
 *   `..._weight(lobe, direction)`   the weight in any direction, that of the sample in the sample's, so pdf times weight is f times
 *                                   the cosine. If it is the same in all directions, there is no such function: the weight of the sample
 *                                   serves (lamps_direct.cl), and nothing is carried along for it.
 * A lobe may draw one of its parts by chance, and then has the Lobe of that part alone: density and weight are those of the
 * part, given that it was drawn, and the weights make up for the chance. The largest weight, over the albedo, stands in the list of
 * host/scene/material.h. It should be 1: more costs a film as many times its resolution at every vertex of a path.
 * Knows: vector.cl, sampler.cl, warps.cl.   Does not know: which lobes there are; scatter.cl calls them. */

/* The surface where a path stands. */
typedef struct Surface {
    Vec3 incoming; /* unit direction of the path, towards the surface */
    Vec3 normal;   /* unit, on the side that the path comes from */
    vbool enters;  /* the path comes from outside */
#if SMOOTH_TRIANGLES
    Vec3 true_normal; /* of the plane of a triangle that shows another; else 0 */
#endif
    Vec3 albedo;
    vreal fuzz, refraction_index;
#if LOBES_OF_TWO_DIRECTIONS
    vreal roughness;
#endif
#if EFFECT_GLOSSY
    vreal lets_in;
#endif
    vuint kind, lobe, variant, total_reflection;
#if PILOT
    uint evenly; /* 1: what is rare is drawn more often than in a picture, and weighs less */
#endif
} Surface;

#if SAMPLES_LAMPS
/* What the density of a lobe depends on, apart from the direction. */
typedef struct Lobe {
    Vec3 axis;  /* unit: the normal; for metal the mirror direction, in a medium the direction before, at the camera to the middle of
                 * the pixel */
#if EFFECT_METAL
    Vec3 normal; /* what lies below the surface is absorbed */
#endif
#if LOBES_OF_TWO_DIRECTIONS
    Vec3 outgoing; /* unit, to where the path came from */
#endif
#if WEIGHTED_LOBES
    Vec3 albedo; /* of lobes whose weight depends on the direction */
#endif
#if EFFECT_GLOSSY
    vreal refraction_index, lets_in; /* of coats; of rough glass the index of the far side over the near one */
#elif EFFECT_ROUGH_DIELECTRIC
    vreal refraction_index;
#endif
    vreal fuzz; /* of metal; of what is rough the roughness or alpha; of a medium the anisotropy; at the camera the sine of the angle from the axis to a pixel's corner */
    vuint kind; /* LOBE_... */
#if SMOOTH_TRIANGLES
    Vec3 true_normal; /* of the surface */
#endif
} Lobe;

/* Of the surface, where `axis` is its normal; `lobe_of`: a lobe and what leads to its members. */
#if SMOOTH_TRIANGLES
#define TRUE_NORMAL(lobe_of) choose3(is_smooth(lobe_of true_normal), lobe_of true_normal, lobe_of axis)
#else
#define TRUE_NORMAL(lobe_of) lobe_of axis
#endif

/* Lobes that scene_types.h does not name. LOBE_NONE has no density: it scatters into a few directions only. LOBE_PIXEL is
 * that of a camera ray, which light_camera (caustics.cl) gives it; rays to lamps do not light the camera. */
enum {
    LOBE_FUZZ_SPHERE = LOBE_HEMISPHERE + 1,
    LOBE_FUZZ_BALL,
    LOBE_OREN_NAYAR_ONCE,
    LOBE_OREN_NAYAR_AGAIN,
    LOBE_ROUGH_METAL,
    LOBE_GLOSSY_COAT,
    LOBE_GLOSSY_BASE,
    LOBE_ROUGH_DIELECTRIC,
    LOBE_PHASE,
    LOBE_NONE,
    LOBE_PIXEL
};

#define LOBE_FUZZ_MIN R(0x1p-6) /* with less fuzz, rays to lamps gain nothing, and float does not hold the densities well */
#define PI_INVERSE R(0.3183098861837907)
#endif

#if SMOOTH_TRIANGLES
/* Whether there is a true normal besides the one that the surface shows. */
static vbool is_smooth(Vec3 true_normal) { return dot3(true_normal, true_normal) > splat(R(0.5)); }
#endif

typedef struct BsdfSample {
    Vec3 direction;    /* unit */
    Vec3 weight;       /* on the radiance that comes along the direction */
    vbool scattered;   /* the path continues; else it has been absorbed */
    vbool transmitted; /* it continues beyond the surface */
#if SAMPLES_LAMPS
    Lobe lobe; /* that the direction was drawn from */
#endif
#if PILOT
    vreal odds; /* how much more often a picture's path would choose the same; a part of the weight */
#endif
} BsdfSample;

/* A path that continues along `direction`, on the side from which it came. */
static BsdfSample bsdf_sample_reflected(const Surface *surface, Vec3 direction) {
    BsdfSample sample;
    sample.direction = direction;
    sample.weight = surface->albedo;
    sample.scattered = vbool_all;
    sample.transmitted = vbool_none;
#if PILOT
    sample.odds = splat(1);
#endif
#if SAMPLES_LAMPS
    sample.lobe.axis = surface->normal;
#if EFFECT_METAL
    sample.lobe.normal = surface->normal;
#endif
#if LOBES_OF_TWO_DIRECTIONS
    sample.lobe.outgoing = scale3(splat(-1), surface->incoming);
#endif
#if WEIGHTED_LOBES
    sample.lobe.albedo = surface->albedo;
#endif
#if EFFECT_GLOSSY
    sample.lobe.refraction_index = surface->refraction_index;
    sample.lobe.lets_in = surface->lets_in;
#elif EFFECT_ROUGH_DIELECTRIC
    sample.lobe.refraction_index = surface->refraction_index;
#endif
    sample.lobe.fuzz = splat(1);
    sample.lobe.kind = splat_uint(LOBE_NONE);
#if SMOOTH_TRIANGLES
    sample.lobe.true_normal = surface->true_normal;
#endif
#endif
    return sample;
}

/* Uniform over the unit sphere. */
static Vec3 random_direction(SampleKey key, vuint bounce) {
    vreal u, v;
    sample_2d(key, bounce + BOUNCE_DIRECTION, &u, &v);
    return sample_sphere(u, v);
}

#if EFFECT_LAMBERTIAN || EFFECT_METAL
static vreal random_ball_radius(SampleKey key, vuint bounce) {
    return sample_ball_radius(uniform(key, bounce + BOUNCE_BALL_RADIUS),
                              uniform(key, bounce + (BOUNCE_BALL_RADIUS + 1u)),
                              uniform(key, bounce + (BOUNCE_BALL_RADIUS + 2u)));
}
#endif
