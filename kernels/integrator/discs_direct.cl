/* discs_direct.cl: what discs and an image around the scene show a path that meets nothing.
 *
 * In:    paths that escape.   Out: radiance in their direction, weighted where rays are sent there too.
 * Knows: discs.cl, environment.cl, lamps_direct.cl, path.cl.   Does not know: what else the sky has. */
#if EFFECT_DISCS
#if SAMPLES_DISCS
/* As lamp_hit_weight. Discs that overlap are lamps of their own: each weighs by what would have chosen it. */
static vreal disc_hit_weight(const Path *path, __global const real *disc, vbool hit) {
    vbool shared = hit & is_lit_lobe(&path->lobe);
    if (!any_lane(shared)) return splat(1);
    const vreal probability = disc_probability(disc, &path->lobe, path->lamp_sum);
    shared = shared & (probability > splat(0));
    const vreal ratio = density_ratio(&path->lobe, path->direction, 1, splat(disc[DISC_CAP]),
                                      choose(shared, probability, splat(1)));
    return weight_of_hit(shared, ratio);
}
#endif

/* Of the lanes that have `escaped`. */
static Vec3 discs_radiance(const Scene *scene, const Path *path, vbool escaped) {
    const uint count = disc_count(scene);
    const vbool scattered = vbool_of_uint(path->depth > splat_uint(1));
    Vec3 sum = zero3();
    for (uint i = 0; i < count; ++i) {
        __global const real *disc = scene->discs + i * DISC_REALS;
        const vbool seen = disc[DISC_SEEN] > 0 ? escaped : escaped & scattered;
        const vbool hit = seen & disc_contains(disc, path->direction);
        if (!any_lane(hit)) continue;
        Vec3 radiance = splat3(disc + DISC_RADIANCE);
#if SAMPLES_DISCS
        radiance = scale3(disc_hit_weight(path, disc, hit), radiance);
        radiance = scale3(chain_hit_weight(scene, path, splat_uint(DISC_SLOT + i), hit), radiance);
#endif
        sum = choose3(hit, add3(sum, radiance), sum);
    }
    return sum;
}

static void see_discs(const Scene *scene, const Path *path, vbool escaped, Vec3 *light) {
    *light = add3(*light, multiply3(path->throughput, discs_radiance(scene, path, escaped)));
}
#else
#define see_discs(scene, path, escaped, light)
#endif

#if EFFECT_ENVIRONMENT
#if SAMPLES_ENVIRONMENT
/* As disc_hit_weight; the lanes `hit` have met nothing. */
static vreal environment_hit_weight(const Scene *scene, const Path *path, vbool hit) {
    const vreal importance = environment_importance(scene);
    vbool shared = hit & is_lit_lobe(&path->lobe) & (importance > splat(0));
    if (!any_lane(shared)) return splat(1);
    const EnvironmentCell cell = environment_cell(scene, path->direction);
    const vreal probability = choose(shared, divide(importance, path->lamp_sum), splat(1)) * cell.probability;
    shared = shared & (probability > splat(0));
    const vreal ratio =
        density_ratio(&path->lobe, path->direction, 1, cell.cap, choose(shared, probability, splat(1)));
    return weight_of_hit(shared, ratio);
}
#endif

/* What the image shows the lanes that have `escaped`. */
static Vec3 environment_light(const Scene *scene, const Path *path, vbool escaped) {
    const Vec3 radiance = environment_radiance(scene, path->direction);
#if SAMPLES_ENVIRONMENT
    return scale3(environment_hit_weight(scene, path, escaped), radiance);
#else
    return radiance;
#endif
}

/* In place of what lies behind it. */
static void see_environment(const Scene *scene, const Path *path, vbool escaped, Vec3 *light) {
    if (has_environment(scene->sky)) *light = multiply3(path->throughput, environment_light(scene, path, escaped));
}
#else
#define see_environment(scene, path, escaped, light)
#endif
