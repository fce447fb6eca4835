/* path.cl: the state of the paths that a work-item follows, one a lane.
 *
 * In:    camera rays.   Out: paths that begin; the ray of a path's next segment, and points on it.
 * Knows: ray.cl, sampler.cl, camera.cl, bsdf.cl.   Does not know: what the paths meet. */
typedef struct Path {
    Point origin;
    Vec3 direction;
    Vec3 throughput, radiance;
    SampleKey key;
    vuint depth;    /* ray segments traced; of a path that its camera ray ended in the open, with MISSED_MARK */
    vuint own_slot; /* of the sphere being left */
    vbool inward;   /* it is left into its inside */
    vbool alive;
#if EFFECT_MOTION
    vreal time;
#endif
#if EFFECT_MEDIA
    vuint medium;    /* that it flies through */
    vbool unsure;    /* it may be another now */
    Vec3 likelihood; /* flight.cl */
    vbool scattered; /* its latest segment ended in a medium */
#endif
#if SAMPLES_LAMPS
    Lobe lobe;          /* that `direction` was drawn from; of LOBE_NONE where no lamp is sampled */
#if WEIGHTED_LOBES
    Vec3 arrived;      /* the throughput before the latest vertex scattered it */
#endif
    vreal lamp_sum;    /* of importance, seen from the latest vertex: lamps.cl */
#if LAMPS_THROUGH_MEDIA
    Point vertex;      /* the latest, where `lobe` is: the boundaries of media that the path passes are none */
    vuint vertex_slot; /* of the sphere that was left there */
#endif
#if SAMPLES_CAUSTICS
    vuint chain;       /* that it follows from a vertex through a focuser, or CHAIN_NONE */
    Focus focus;       /* of that chain */
#endif
    vbool wants_lamps; /* its latest vertex is still to be lit; a path that is not alive may want that too */
#endif
    /* Of the latest segment, for path_log.cl. */
#if EFFECT_SHADOW_CATCHER
    vbool caught, dark; /* it ended at the shadow catcher, and in shadow */
#endif
    vbool met, entered;
    vrefined distance;
#if SAMPLES_LAMPS
    vuint lamp_slot, seen_slot; /* the lamp that the vertex was to be lit by, or NO_SLOT, and what stands in front */
    uint lamp_rays; /* sent by all lanes, since path_none */
#endif
} Path;

#if LAMPS_THROUGH_MEDIA
#define vertex_of(path) (&(path)->vertex)
#define vertex_slot_of(path) ((path)->vertex_slot)
#else
#define vertex_of(path) (&(path)->origin)
#define vertex_slot_of(path) ((path)->own_slot)
#endif

/* When the path is, from 0 where the shutter opens to 1: where nothing moves, always 0. */
static vreal path_time(const Path *path) {
#if EFFECT_MOTION
    return path->time;
#else
    return splat(0);
#endif
}

/* No path in any lane. */
static void path_none(Path *path) {
    path->alive = path->inward = vbool_none;
    path->depth = splat_uint(0);
    path->radiance = zero3();
#if EFFECT_MEDIA
    path->unsure = vbool_none;
    path->medium = splat_uint(0);
#endif
#if SAMPLES_LAMPS
    path->wants_lamps = vbool_none;
    path->lamp_rays = 0;
#if SAMPLES_CAUSTICS
    path->chain = splat_uint(CHAIN_NONE);
#endif
#endif
}

/* The ray of the next segment. */
static Ray path_ray(const Path *path) {
    Ray ray;
    ray.origin = path->origin;
    ray.direction = path->direction;
    ray.cull_margin = cull_margin_of(&path->origin);
    ray.own_slot = path->own_slot;
    ray.inward = path->inward;
#if EFFECT_MOTION
    ray.time = path->time;
#endif
    return ray;
}

#if EFFECT_MEDIA || EFFECT_SHADOW_CATCHER
/* The point in the open, `length` ahead of the path, where `moving`; in the other lanes its origin. */
static Point point_ahead(const Path *path, vbool moving, vreal length) {
    const vrefined t = to_refined(length);
    const Vec3 high = path->origin.high, low = path->origin.low;
    const vrefined x = fma(t, to_refined(path->direction.x), to_refined(high.x) + to_refined(low.x));
    const vrefined y = fma(t, to_refined(path->direction.y), to_refined(high.y) + to_refined(low.y));
    const vrefined z = fma(t, to_refined(path->direction.z), to_refined(high.z) + to_refined(low.z));
    const Vec3 place = vec3(to_real(x), to_real(y), to_real(z));
    const Vec3 rest = vec3(to_real(x - to_refined(place.x)), to_real(y - to_refined(place.y)), to_real(z - to_refined(place.z)));
    Point point;
    point.high = choose3(moving, place, high);
    point.low = choose3(moving, rest, low);
    point.error = choose(moving, splat(0), path->origin.error);
    return point;
}
#endif

/* Sets the lanes of `fresh` to the beginning of a path: a camera ray, and the key of its pixel sample. */
static void path_init(__global const PackedCamera *camera, SampleKey key, Vec3 origin, Vec3 direction, vbool fresh,
                      Path *path) {
    path->origin.high = choose3(fresh, origin, path->origin.high);
    path->origin.low = choose3(fresh, zero3(), path->origin.low);
    path->origin.error = choose(fresh, splat(camera->own_slot[2]), path->origin.error);
    path->direction = choose3(fresh, direction, path->direction);
    path->throughput = choose3(fresh, vec3(splat(1), splat(1), splat(1)), path->throughput);
    path->radiance = choose3(fresh, zero3(), path->radiance);
    path->key.a = choose_uint(fresh, key.a, path->key.a);
    path->key.b = choose_uint(fresh, key.b, path->key.b);
#if SAMPLER_SOBOL
    path->key.index_reversed = choose_uint(fresh, key.index_reversed, path->key.index_reversed);
    path->key.scramble_a = choose_uint(fresh, key.scramble_a, path->key.scramble_a);
    path->key.scramble_b = choose_uint(fresh, key.scramble_b, path->key.scramble_b);
#endif
    path->depth = choose_uint(fresh, splat_uint(0), path->depth);
    /* A camera that stands on a sphere leaves it like any other point of its surface. */
    const vbool inward = dot3(splat3(camera->inward), direction) > splat(0);
    const uint own_slot = (uint)camera->own_slot[0] | (uint)camera->own_slot[1] << 16;
    path->own_slot = choose_uint(fresh, splat_uint(own_slot), path->own_slot);
    path->inward = (fresh & inward) | (vbool_not(fresh) & path->inward);
    path->alive = path->alive | fresh;
#if EFFECT_MOTION
    path->time = choose(fresh, sample_1d(key, splat_uint(DIMENSION_TIME)), path->time);
#endif
#if EFFECT_MEDIA
    path->unsure = path->unsure | fresh;
    path->likelihood = choose3(fresh, vec3(splat(1), splat(1), splat(1)), path->likelihood);
#endif
#if SAMPLES_LAMPS
    path->lobe.kind = choose_uint(fresh, splat_uint(LOBE_NONE), path->lobe.kind);
    path->wants_lamps = path->wants_lamps & vbool_not(fresh);
#if SAMPLES_CAUSTICS
    path->chain = choose_uint(fresh, splat_uint(CHAIN_NONE), path->chain);
#endif
#endif
}

/* The same for the pixel sample at a row and a column, whole numbers. */
static void path_init_from_camera(__global const PackedCamera *camera, uint pixel_center, SampleKey key, vreal column,
                                  vreal row, vbool fresh, Path *path) {
    Vec3 origin, direction;
    camera_ray(camera, pixel_center, key, column, row, &origin, &direction);
    path_init(camera, key, origin, direction, fresh, path);
}

/* The lanes whose path is to be traced on: it lives and waits for nothing. */
static vbool path_moves(const Path *path) {
#if SAMPLES_LAMPS
    return path->alive & vbool_not(path->wants_lamps);
#else
    return path->alive;
#endif
}

/* The lanes `met` go on from `point`, of the sphere in `slot`, which they have met from outside where `enters`. Without
 * lamps and media, no path that lives waits, and what becomes of those that do not live is no matter. */
static void path_scatter(Path *path, vbool met, const Point *point, vuint slot, vbool enters,
                         const BsdfSample *bsdf_sample) {
#if (SAMPLES_LAMPS || EFFECT_MEDIA) && LANE_COUNT > 1
#define IN_MET(type, a, b) choose##type(met, a, b)
#else
#define IN_MET(type, a, b) (a)
#endif
    const Vec3 throughput = multiply3(path->throughput, bsdf_sample->weight);
    /* Coming from outside and staying there, or from inside and going through: outside. */
    const vbool inward = (enters & bsdf_sample->transmitted) | (vbool_not(enters) & vbool_not(bsdf_sample->transmitted));
#if WEIGHTED_LOBES
    path->arrived = IN_MET(3, path->throughput, path->arrived);
#endif
    path->throughput = IN_MET(3, throughput, path->throughput);
    path->direction = IN_MET(3, bsdf_sample->direction, path->direction);
    path->origin.high = IN_MET(3, point->high, path->origin.high);
    path->origin.low = IN_MET(3, point->low, path->origin.low);
    path->origin.error = IN_MET(, point->error, path->origin.error);
    path->own_slot = IN_MET(_uint, slot, path->own_slot);
    path->inward = IN_MET(, inward, path->inward);
    path->alive = path->alive & (bsdf_sample->scattered | vbool_not(met));
#if EFFECT_MEDIA
    path->unsure = path->unsure | (met & bsdf_sample->transmitted);
#endif
#undef IN_MET
}

/* How many rays the paths of a work-item have sent to lamps. */
static uint lamp_rays_of(const Path *path) {
#if SAMPLES_LAMPS
    return path->lamp_rays;
#else
    return 0;
#endif
}

#if SAMPLES_LAMPS
/* The lanes `met` stand at a vertex with this lobe, to be lit where a segment `follows`. */
static void path_light(Path *path, vbool met, const Lobe *lobe, vbool follows) {
    path->lobe = choose_lobe(met, lobe, &path->lobe);
#if LAMPS_THROUGH_MEDIA
    path->vertex.high = choose3(met, path->origin.high, path->vertex.high);
    path->vertex.low = choose3(met, path->origin.low, path->vertex.low);
    path->vertex.error = choose(met, path->origin.error, path->vertex.error);
    path->vertex_slot = choose_uint(met, path->own_slot, path->vertex_slot);
#endif
    path->wants_lamps =
        path->wants_lamps | (met & follows & is_lit_lobe(lobe));
}
#endif
