/* metal.cl: mirror reflection with fuzz.
 *
 * In and out: as bsdf.cl says.   Knows: bsdf.cl.   Does not know: other lobes. */
#if EFFECT_METAL
/* Mirror direction, unit, plus fuzz times a point of the unit sphere (fourth edition) or ball (first, third). What
 * ends below the surface is absorbed. */
static BsdfSample metal_sample(const Surface *surface, SampleKey key, vuint bounce) {
    const vreal along = dot3(surface->incoming, surface->normal);
    const Vec3 mirrored = normalise3(madd3(splat(-2) * along, surface->normal, surface->incoming));
    Vec3 direction = mirrored;
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
#if SAMPLES_LAMPS
    sample.lobe.axis = mirrored;
    sample.lobe.fuzz = surface->fuzz;
    sample.lobe.kind = choose_uint(surface->fuzz >= splat(LOBE_FUZZ_MIN), surface->variant + (uint)LOBE_FUZZ_SPHERE,
                                   splat_uint(LOBE_NONE));
#endif
    return sample;
}

#if SAMPLES_LAMPS
/* A ray at the angle gamma from the mirror direction R meets the sphere of radius f (fuzz) around its tip at the
 * distances c - h and c + h, c = cos(gamma), h^2 = f^2 - sin^2(gamma); t^2 dw = |cos| dA there, so on the sphere the
 * density is ((c - h)^2 + (c + h)^2) / (4 pi f h), and in the ball ((c + h)^3 - (c - h)^3) / (4 pi f^3).
 * sin^2(gamma) comes from |direction - R|^2, which keeps the bits that 1 - c^2 loses. `drawn`: the direction was
 * drawn from this lobe, so it lies in its cone even where rounding would put it beyond the rim. Below
 * the surface the density is 0; it does not grow elsewhere, since what is drawn there is absorbed. */
static vreal metal_pdf(const Lobe *lobe, Vec3 direction, int drawn) {
    const Vec3 off = subtract3(direction, lobe->axis);
    const vreal f = lobe->fuzz;
    const vreal delta = dot3(off, off);
    const vreal sine = square_root(at_least(delta * fma(splat(R(-0.25)), delta, splat(1)), splat(0)));
    const vreal c = fma(splat(R(-0.5)), delta, splat(1));
    const vreal h2 = at_least((f - sine) * (f + sine), drawn ? f * f * R(0x1p-24) : splat(0));
    const vreal h = square_root(h2);
    const vbool inside = (h2 > splat(0)) & (c > splat(0)) & (dot3(direction, lobe->normal) > splat(0));
    vreal density = divide(fma(c, c, h2) * (R(0.5) * PI_INVERSE), f * h);
    const vbool ball = vbool_of_uint(lobe->kind == splat_uint(LOBE_FUZZ_BALL));
    if (any_lane(ball)) {
        const vreal in_ball = divide(h * fma(c * c, splat(3), h2) * (R(0.5) * PI_INVERSE), f * f * f);
        density = choose(ball, in_ball, density);
    }
    return choose(inside, density, splat(0));
}
#endif
#endif
