/* scatter.cl: which lobe draws for which material.
 *
 * In:    a surface, a sample's key, how deep the path is.   Out: a BsdfSample for each lane.
 * Knows: every lobe by its one function.   Does not know: how lobes draw. */

/* With one kind of material in the scene there is nothing to ask. */
#define KIND_COUNT (EFFECT_LAMBERTIAN + EFFECT_METAL + EFFECT_DIELECTRIC + EFFECT_NORMALS + EFFECT_EMISSION)
#if KIND_COUNT == 1
#define has_kind(surface, wanted) vbool_all
#else
#define has_kind(surface, wanted) vbool_of_uint((surface)->kind == splat_uint(wanted))
#endif

static BsdfSample choose_sample(vbool mask, BsdfSample a, BsdfSample b) {
    BsdfSample chosen;
    chosen.direction = choose3(mask, a.direction, b.direction);
    chosen.weight = choose3(mask, a.weight, b.weight);
    chosen.scattered = (mask & a.scattered) | (vbool_not(mask) & b.scattered);
    chosen.transmitted = (mask & a.transmitted) | (vbool_not(mask) & b.transmitted);
    return chosen;
}

/* The lanes whose material is of kind `wanted` get what the lobe draws. */
#define SCATTER_BY(wanted, lobe_sample)                                                                                \
    {                                                                                                                  \
        const vbool of_kind = has_kind(surface, wanted);                                                               \
        if (any_lane(of_kind)) sample = choose_sample(of_kind, lobe_sample(surface, key, bounce), sample);             \
    }

/* Lamps and surfaces that show their normal scatter nothing. */
static BsdfSample scatter(const Surface *surface, SampleKey key, vuint depth) {
    const vuint bounce = depth * DIMENSIONS_PER_BOUNCE + DIMENSION_BOUNCE;
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
    return sample;
}
