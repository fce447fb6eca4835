/* scatter.cl: which lobe draws for which material.
 *
 * In:    a surface, a sample's key, the first dimension of its bounce.   Out: a BsdfSample for each lane; for lamps, the lobe
 *        that it is drawn from, and the lobe's density.
 * Knows: every lobe by its one function.   Does not know: how lobes draw. */

/* If the scene has one kind of material only, there is nothing to choose. */
#define KIND_COUNT (EFFECT_LAMBERTIAN + EFFECT_METAL + EFFECT_DIELECTRIC + EFFECT_NORMALS + EFFECT_EMISSION + EFFECT_MEDIA + \
                    EFFECT_OREN_NAYAR + EFFECT_ROUGH_METAL + EFFECT_GLOSSY + EFFECT_ROUGH_DIELECTRIC)
#if KIND_COUNT == 1
#define has_kind(surface, wanted) vbool_all
#else
#define has_kind(surface, wanted) vbool_of_uint((surface)->kind == splat_uint(wanted))
#endif

#if SAMPLES_LAMPS
static Lobe choose_lobe(vbool mask, const Lobe *a, const Lobe *b) {
    Lobe chosen;
    chosen.axis = choose3(mask, a->axis, b->axis);
#if EFFECT_METAL
    chosen.normal = choose3(mask, a->normal, b->normal);
#endif
#if LOBES_OF_TWO_DIRECTIONS
    chosen.outgoing = choose3(mask, a->outgoing, b->outgoing);
#endif
#if WEIGHTED_LOBES
    chosen.albedo = choose3(mask, a->albedo, b->albedo);
#endif
#if EFFECT_GLOSSY
    chosen.refraction_index = choose(mask, a->refraction_index, b->refraction_index);
    chosen.lets_in = choose(mask, a->lets_in, b->lets_in);
#elif EFFECT_ROUGH_DIELECTRIC
    chosen.refraction_index = choose(mask, a->refraction_index, b->refraction_index);
#endif
    chosen.fuzz = choose(mask, a->fuzz, b->fuzz);
    chosen.kind = choose_uint(mask, a->kind, b->kind);
#if SMOOTH_TRIANGLES
    chosen.true_normal = choose3(mask, a->true_normal, b->true_normal);
#endif
    return chosen;
}
#endif

static BsdfSample choose_sample(vbool mask, BsdfSample a, BsdfSample b) {
    BsdfSample chosen;
    chosen.direction = choose3(mask, a.direction, b.direction);
    chosen.weight = choose3(mask, a.weight, b.weight);
    chosen.scattered = (mask & a.scattered) | (vbool_not(mask) & b.scattered);
    chosen.transmitted = (mask & a.transmitted) | (vbool_not(mask) & b.transmitted);
#if SAMPLES_LAMPS
    chosen.lobe = choose_lobe(mask, &a.lobe, &b.lobe);
#endif
#if PILOT
    chosen.odds = choose(mask, a.odds, b.odds);
#endif
    return chosen;
}

/* The lanes whose material is of kind `wanted` get what the lobe draws. */
#define SCATTER_BY(wanted, lobe_sample)                                                                                \
    {                                                                                                                  \
        const vbool of_kind = has_kind(surface, wanted);                                                               \
        if (any_lane(of_kind)) sample = choose_sample(of_kind, lobe_sample(surface, key, bounce), sample);             \
    }

/* Lamps and surfaces that show their normal scatter nothing. */
static BsdfSample scatter(const Surface *surface, SampleKey key, vuint bounce) {
    BsdfSample sample = bsdf_sample_reflected(surface, surface->normal);
    sample.scattered = vbool_none;
#if EFFECT_LAMBERTIAN
    SCATTER_BY(KIND_LAMBERTIAN, lambertian_sample)
#endif
#if EFFECT_METAL
    SCATTER_BY(KIND_METAL, metal_sample)
#endif
#if EFFECT_DIELECTRIC
    SCATTER_BY(KIND_DIELECTRIC, dielectric_sample)
#endif
#if EFFECT_MEDIA
    SCATTER_BY(KIND_INTERFACE, interface_sample)
#endif
#if EFFECT_OREN_NAYAR
    SCATTER_BY(KIND_OREN_NAYAR, oren_nayar_sample)
#endif
#if EFFECT_ROUGH_METAL
    SCATTER_BY(KIND_ROUGH_METAL, rough_metal_sample)
#endif
#if EFFECT_GLOSSY
    SCATTER_BY(KIND_GLOSSY, glossy_sample)
#endif
#if EFFECT_ROUGH_DIELECTRIC
    SCATTER_BY(KIND_ROUGH_DIELECTRIC, rough_dielectric_sample)
#endif
    return sample;
}

#if SAMPLES_LAMPS
static vbool is_fuzzy(const Lobe *lobe) {
    return vbool_of_uint(lobe->kind == splat_uint(LOBE_FUZZ_SPHERE)) |
           vbool_of_uint(lobe->kind == splat_uint(LOBE_FUZZ_BALL));
}

/* It scatters into a cone, whose half angle has the sine `fuzz`. */
#if SAMPLES_CAUSTICS
#define is_cone(lobe) (is_fuzzy(lobe) | vbool_of_uint((lobe)->kind == splat_uint(LOBE_PIXEL)))
#else
#define is_cone is_fuzzy
#endif

#if EFFECT_MEDIA
static vbool is_phase(const Lobe *lobe) { return vbool_of_uint(lobe->kind == splat_uint(LOBE_PHASE)); }
#endif

/* Rays to lamps light a vertex that has this lobe. */
static vbool is_lit_lobe(const Lobe *lobe) { return vbool_of_uint(lobe->kind < splat_uint(LOBE_NONE)); }

#if PILOT
/* Those that lie around the direction of a mirror, or of refraction. */
static vbool is_narrow_lobe(const Lobe *lobe) {
    return is_fuzzy(lobe) | vbool_of_uint(lobe->kind == splat_uint(LOBE_ROUGH_METAL)) |
           vbool_of_uint(lobe->kind == splat_uint(LOBE_GLOSSY_COAT)) |
           vbool_of_uint(lobe->kind == splat_uint(LOBE_ROUGH_DIELECTRIC));
}
#endif

/* Per steradian; 0 for LOBE_NONE; not of LOBE_PIXEL (focusers.cl). `drawn`: `direction` was drawn from the lobe. */
static vreal scatter_pdf(const Lobe *lobe, Vec3 direction, int drawn) {
    vreal density = splat(0);
#if EFFECT_LAMBERTIAN
    density = lambertian_pdf(lobe, direction);
#endif
#if EFFECT_METAL
    const vbool fuzzy = is_fuzzy(lobe);
    if (any_lane(fuzzy)) density = choose(fuzzy, metal_pdf(lobe, direction, drawn), density);
#endif
#if EFFECT_OREN_NAYAR
    const vbool rough = vbool_of_uint(lobe->kind == splat_uint(LOBE_OREN_NAYAR_ONCE)) |
                        vbool_of_uint(lobe->kind == splat_uint(LOBE_OREN_NAYAR_AGAIN));
    if (any_lane(rough)) density = choose(rough, oren_nayar_pdf(lobe, direction), density);
#endif
#if EFFECT_ROUGH_METAL
    const vbool facets = vbool_of_uint(lobe->kind == splat_uint(LOBE_ROUGH_METAL));
    if (any_lane(facets)) density = choose(facets, rough_metal_pdf(lobe, direction), density);
#endif
#if EFFECT_GLOSSY
    const vbool coat = vbool_of_uint(lobe->kind == splat_uint(LOBE_GLOSSY_COAT));
    if (any_lane(coat)) density = choose(coat, rough_metal_pdf(lobe, direction), density);
    const vbool base = vbool_of_uint(lobe->kind == splat_uint(LOBE_GLOSSY_BASE));
    if (any_lane(base)) density = choose(base, glossy_base_pdf(lobe, direction), density);
#endif
#if EFFECT_ROUGH_DIELECTRIC
    const vbool glass = is_rough_dielectric(lobe);
    if (any_lane(glass)) density = choose(glass, rough_dielectric_pdf(lobe, direction), density);
#endif
#if EFFECT_MEDIA
    const vbool phase = is_phase(lobe);
    if (any_lane(phase)) density = choose(phase, phase_pdf(lobe->fuzz, lobe->axis, direction), density);
#endif
    return choose(vbool_of_uint(lobe->kind == splat_uint(LOBE_NONE)), splat(0), density);
}

#if WEIGHTED_LOBES
#define has_lobe(lobe, wanted) vbool_of_uint((lobe)->kind == splat_uint(wanted))

/* The lobes whose weight depends on the direction. */
static vbool is_weighted(const Lobe *lobe) {
    vbool weighted = has_lobe(lobe, LOBE_ROUGH_METAL);
#if EFFECT_GLOSSY
    weighted = weighted | has_lobe(lobe, LOBE_GLOSSY_COAT);
#endif
#if EFFECT_ROUGH_DIELECTRIC
    weighted = weighted | is_rough_dielectric(lobe);
#endif
    return weighted;
}

/* Their weight. A coat's is a part of what its facets leave. */
static Vec3 scatter_weight(const Lobe *lobe, Vec3 direction) {
    Vec3 weight = zero3();
#if EFFECT_ROUGH_METAL || EFFECT_GLOSSY || EFFECT_ROUGH_DIELECTRIC
    weight = rough_metal_weight(lobe, direction);
#endif
#if EFFECT_ROUGH_DIELECTRIC
    const vbool glass = is_rough_dielectric(lobe);
    if (any_lane(glass)) weight = choose3(glass, rough_dielectric_weight(lobe, direction), weight);
#endif
#if EFFECT_GLOSSY
    const vbool coat = has_lobe(lobe, LOBE_GLOSSY_COAT);
    if (any_lane(coat))
        weight = choose3(coat, scale3(coat_part(lobe->refraction_index, lobe->axis, lobe->outgoing, direction), weight), weight);
#endif
    return weight;
}
#endif
#endif
