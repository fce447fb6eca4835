/* path.cl: the state of the paths that a work-item follows, one a lane.
 *
 * In:    camera rays.   Out: paths that begin; the ray of a path's next segment.
 * Knows: ray.cl, sampler.cl, camera.cl.   Does not know: what the paths meet. */
typedef struct Path {
    Point origin;
    Vec3 direction;
    Vec3 throughput, radiance;
    SampleKey key;
    vuint depth;    /* ray segments traced */
    vuint own_slot; /* of the sphere being left */
    vbool inward;   /* it is left into its inside */
    vbool alive;
    /* Of the latest segment, for path_log.cl. */
    vbool met, entered;
    vrefined distance;
} Path;

/* The ray of the next segment. */
static Ray path_ray(const Path *path) {
    Ray ray;
    ray.origin = path->origin;
    ray.direction = path->direction;
    ray.cull_margin = cull_margin_of(&path->origin);
    ray.own_slot = path->own_slot;
    ray.inward = path->inward;
    return ray;
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
}

/* The same for the pixel sample at a row and a column, whole numbers. */
static void path_init_from_camera(__global const PackedCamera *camera, uint pixel_center, SampleKey key, vreal column,
                                  vreal row, vbool fresh, Path *path) {
    Vec3 origin, direction;
    camera_ray(camera, pixel_center, key, column, row, &origin, &direction);
    path_init(camera, key, origin, direction, fresh, path);
}
