/* lambertian.cl: diffuse scattering, with the three lobes of the book's editions.
 *
 * In and out: as bsdf.cl says.   Knows: bsdf.cl.   Does not know: other lobes. */
#if EFFECT_LAMBERTIAN
/* Lambertian: a point of the unit sphere around the tip of the normal. Cosine cubed (first
 * edition): a point of the unit ball there. Hemisphere: uniform over directions. */
static BsdfSample lambertian_sample(const Surface *surface, SampleKey key, vuint bounce) {
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
    BsdfSample sample = bsdf_sample_reflected(surface, normalise3(choose3(vanished, surface->normal, direction)));
#if SAMPLES_LAMPS
    sample.lobe.kind = surface->lobe;
#endif
    return sample;
}

#if SAMPLES_LAMPS
static vreal lambertian_pdf(const Lobe *lobe, Vec3 direction) {
    const vreal c = at_least(dot3(direction, lobe->axis), splat(0));
    vreal density = c * PI_INVERSE;
    density = choose(vbool_of_uint(lobe->kind == splat_uint(LOBE_COSINE_CUBED)), R(2.0) * c * c * density, density);
    const vreal uniform_density = choose(c > splat(0), splat(R(0.5) * PI_INVERSE), splat(0));
    return choose(vbool_of_uint(lobe->kind == splat_uint(LOBE_HEMISPHERE)), uniform_density, density);
}
#endif
#endif
