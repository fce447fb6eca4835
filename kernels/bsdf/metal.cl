/* metal.cl: mirror reflection with fuzz.
 *
 * In and out: as bsdf.cl says.   Knows: bsdf.cl.   Does not know: other lobes. */
#if EFFECT_METAL
/* Mirror direction, unit, plus fuzz times a point of the unit sphere (fourth edition) or ball (first, third). What
 * ends below the surface is absorbed. */
static BsdfSample metal_sample(const Surface *surface, SampleKey key, vuint bounce) {
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
    BsdfSample sample = bsdf_sample_reflected(surface, direction);
    sample.scattered = dot3(direction, surface->normal) > splat(0);
    return sample;
}
#endif
