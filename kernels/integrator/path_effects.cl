/* path_effects.cl: what motion, media, rays to lamps and a pilot's odds add to how a path begins and goes on; nothing in programs
 * without them.
 *
 * In:    paths, and the lanes that it is about.   Out: the members of Path that only these effects have.
 * Knows: path_state.cl, camera.cl, phase.cl.   Does not know: what the paths meet. */
#if EFFECT_MOTION
static void path_init_time(SampleKey key, vbool fresh, Path *path) {
    path->time = choose(fresh, sample_1d(key, splat_uint(DIMENSION_TIME)), path->time);
}
#define ray_set_time(ray, path) (ray)->time = (path)->time
#else
#define path_init_time(key, fresh, path)
#define ray_set_time(ray, path)
#endif

#if EFFECT_MEDIA
static void path_none_media(Path *path) {
    path->unsure = vbool_none;
    path->medium = splat_uint(0);
#if MEDIA_IN_TRIANGLES
    path->bodies = splat_uint(0);
#endif
}

static void path_init_media(vbool fresh, Path *path) {
    path->unsure = path->unsure | fresh;
    path->likelihood = choose3(fresh, vec3(splat(1), splat(1), splat(1)), path->likelihood);
}

/* The lanes `passed` have come to the other side of a surface. */
static void path_pass_media(vbool passed, Path *path) { path->unsure = path->unsure | passed; }
#else
#define path_none_media(path)
#define path_init_media(fresh, path)
#define path_pass_media(passed, path)
#endif

#if SAMPLES_CAUSTICS
static void path_init_chain(vbool fresh, Path *path) { path->chain = choose_uint(fresh, splat_uint(CHAIN_NONE), path->chain); }
#else
#define path_init_chain(fresh, path)
#endif

#if PILOT
static void path_none_odds(Path *path) {
    path->evenly = 0;
    path->odds = splat(1);
}

static void surface_set_odds(const Path *path, Surface *surface) { surface->evenly = path->evenly; }

static void path_keep_odds(Path *path, vbool met, const BsdfSample *bsdf_sample) {
    path->odds = choose(met, path->odds * bsdf_sample->odds, path->odds);
}
#else
#define path_none_odds(path)
#define surface_set_odds(path, surface)
#define path_keep_odds(path, met, bsdf_sample)
#endif

#if WEIGHTED_LOBES
static void path_keep_arrived(vbool met, Path *path) { path->arrived = choose3(met, path->throughput, path->arrived); }
#else
#define path_keep_arrived(met, path)
#endif

/* Past the boundary of a medium a path is still on its way from the vertex before. */
#if LAMPS_THROUGH_MEDIA
static vbool is_vertex(const Surface *surface) { return vbool_not(has_kind(surface, KIND_INTERFACE)); }

static void path_keep_vertex(vbool met, Path *path) {
    path->vertex.high = choose3(met, path->origin.high, path->vertex.high);
    path->vertex.low = choose3(met, path->origin.low, path->vertex.low);
    path->vertex.error = choose(met, path->origin.error, path->vertex.error);
    path->vertex_slot = choose_uint(met, path->own_slot, path->vertex_slot);
}
#else
#define is_vertex(surface) vbool_all
#define path_keep_vertex(met, path)
#endif

#if SAMPLES_LAMPS
static void path_none_lamps(Path *path) {
    path->wants_lamps = vbool_none;
    path->lamp_rays = 0;
    path_init_chain(vbool_all, path);
}

static void path_init_lamps(vbool fresh, Path *path) {
    path->lobe.kind = choose_uint(fresh, splat_uint(LOBE_NONE), path->lobe.kind);
    path->wants_lamps = path->wants_lamps & vbool_not(fresh);
    path_init_chain(fresh, path);
}

/* The lanes `met` stand at a vertex with this lobe, to be lit. The ray to a lamp stands for the next segment of the path, so
 * where the path ends there is none. */
static void path_light(Path *path, vbool met, const Lobe *lobe, uint max_depth) {
    const vbool follows = vbool_of_uint(path->depth < splat_uint(max_depth));
    path->lobe = choose_lobe(met, lobe, &path->lobe);
    path_keep_vertex(met, path);
    path->wants_lamps = path->wants_lamps | (met & follows & is_lit_lobe(lobe));
}

#if EFFECT_MEDIA
/* The same for lanes that a medium with this mean cosine has scattered. */
static void path_light_in_medium(Path *path, vbool scattered, vreal anisotropy, uint max_depth) {
    const Lobe lobe = phase_lobe(path->direction, anisotropy);
    path_light(path, scattered, &lobe, max_depth);
}
#endif

#define lamp_rays_of(path) ((path)->lamp_rays)
#define path_waits(path) ((path)->wants_lamps)
#else
#define path_none_lamps(path)
#define path_init_lamps(fresh, path)
#define path_light(path, met, lobe, max_depth)
#define path_light_in_medium(path, scattered, anisotropy, max_depth)
#define lamp_rays_of(path) 0
#define path_waits(path) vbool_none
#endif
