/* path.cl: how paths begin, their rays, and how they go on from a surface.
 *
 * In:    camera rays; what a surface scatters.   Out: paths; the ray of a path's next segment, and points on it.
 * Knows: path_state.cl, path_effects.cl, camera.cl.   Does not know: what the paths meet. */

/* No path in any lane. */
static void path_none(Path *path) {
    path->alive = path->inward = vbool_none;
    path->depth = splat_uint(0);
    path->radiance = zero3();
    path_none_odds(path);
    path_none_media(path);
    path_none_lamps(path);
}

/* The ray of the next segment. */
static Ray path_ray(const Path *path) {
    Ray ray;
    ray.origin = path->origin;
    ray.direction = path->direction;
    ray.cull_margin = cull_margin_of(&path->origin);
    ray.own_slot = path->own_slot;
    ray.inward = path->inward;
#if EFFECT_OPACITY
    ray.passes = vbool_none;
#endif
    ray_set_time(&ray, path);
    return ray;
}

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

/* Sets the lanes of `fresh` to the beginning of a path: a camera ray, and the key of its pixel sample. */
static void path_init(__global const PackedCamera *camera, SampleKey key, Vec3 origin, Vec3 direction, vbool fresh,
                      Path *path) {
    path->origin.high = choose3(fresh, origin, path->origin.high);
    path->origin.low = choose3(fresh, zero3(), path->origin.low);
    path->origin.error = choose(fresh, splat(camera->own_slot[2]), path->origin.error);
    path->direction = choose3(fresh, direction, path->direction);
    path->throughput = choose3(fresh, vec3(splat(1), splat(1), splat(1)), path->throughput);
    path->radiance = choose3(fresh, zero3(), path->radiance);
    path->key = choose_key(fresh, key, path->key);
    path->depth = choose_uint(fresh, splat_uint(0), path->depth);
    /* A camera that stands on a sphere leaves it like any other point of its surface. */
    const vbool inward = dot3(splat3(camera->inward), direction) > splat(0);
    const uint own_slot = (uint)camera->own_slot[0] | (uint)camera->own_slot[1] << 16;
    path->own_slot = choose_uint(fresh, splat_uint(own_slot), path->own_slot);
    path->inward = (fresh & inward) | (vbool_not(fresh) & path->inward);
    path->alive = path->alive | fresh;
    path_init_time(key, fresh, path);
    path_init_media(fresh, path);
    path_init_lamps(fresh, path);
}

/* The same for the pixel sample at a row and a column, whole numbers. */
static void path_init_from_camera(__global const PackedCamera *camera, uint pixel_center, SampleKey key, vreal column,
                                  vreal row, vbool fresh, Path *path) {
    Vec3 origin, direction;
    camera_ray(camera, pixel_center, key, column, row, &origin, &direction);
    path_init(camera, key, origin, direction, fresh, path);
}

/* The lanes whose path is to be traced on: it lives and waits for nothing. */
static vbool path_moves(const Path *path) { return path->alive & vbool_not(path_waits(path)); }

/* Without lamps and media, no path that lives waits, and what becomes of those that do not live is no matter. */
#if (SAMPLES_LAMPS || EFFECT_MEDIA) && LANE_COUNT > 1
#define lanes_to_set(met) (met)
#else
#define lanes_to_set(met) vbool_all
#endif

/* The lanes `met` go on from `point`, of the sphere in `slot`, which they have met from outside where `enters`. */
static void path_scatter(Path *path, vbool met, const Point *point, vuint slot, vbool enters,
                         const BsdfSample *bsdf_sample) {
    const vbool set = lanes_to_set(met);
    const Vec3 throughput = multiply3(path->throughput, bsdf_sample->weight);
    /* Coming from outside and staying there, or from inside and going through: outside. */
    const vbool inward = (enters & bsdf_sample->transmitted) | (vbool_not(enters) & vbool_not(bsdf_sample->transmitted));
    path_keep_arrived(set, path);
    path->throughput = choose3(set, throughput, path->throughput);
    path->direction = choose3(set, bsdf_sample->direction, path->direction);
    path->origin.high = choose3(set, point->high, path->origin.high);
    path->origin.low = choose3(set, point->low, path->origin.low);
    path->origin.error = choose(set, point->error, path->origin.error);
    path->own_slot = choose_uint(set, slot, path->own_slot);
    path->inward = choose(set, inward, path->inward);
    path->alive = path->alive & (bsdf_sample->scattered | vbool_not(met));
    path_pass_media(met & bsdf_sample->transmitted, path);
}
