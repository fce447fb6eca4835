/* trace_sample.cl: the kernel of the one-path form: a work-item traces one pixel sample.
 *
 * In:    the packed scene, a chunk.   Out: the samples of the chunk, as pixels.cl says.
 * Knows: one_path.cl, caustics.cl.   Does not know: what a bounce does.
 *
 * The paths of a work-group begin together, then each goes its way. A camera ray is made without a branch, so compilers
 * for processors can make those of a group in vector lanes, if nothing else stands between: hence the barrier, and the
 * numbers in memory, one array a component. */

typedef struct Starts {
    real origin_x[GROUP_MAX], origin_y[GROUP_MAX], origin_z[GROUP_MAX];
    real direction_x[GROUP_MAX], direction_y[GROUP_MAX], direction_z[GROUP_MAX];
    uint key_a[GROUP_MAX], key_b[GROUP_MAX];
#if SAMPLER_SOBOL
    uint index_reversed[GROUP_MAX], scramble_a[GROUP_MAX], scramble_b[GROUP_MAX];
#endif
} Starts;

static void put_start(SampleKey key, Vec3 origin, Vec3 direction, uint place, __local Starts *starts) {
    starts->origin_x[place] = origin.x;
    starts->origin_y[place] = origin.y;
    starts->origin_z[place] = origin.z;
    starts->direction_x[place] = direction.x;
    starts->direction_y[place] = direction.y;
    starts->direction_z[place] = direction.z;
    starts->key_a[place] = key.a;
    starts->key_b[place] = key.b;
#if SAMPLER_SOBOL
    starts->index_reversed[place] = key.index_reversed;
    starts->scramble_a[place] = key.scramble_a;
    starts->scramble_b[place] = key.scramble_b;
#endif
}

static void take_start(const __local Starts *starts, uint place, SampleKey *key, Vec3 *origin, Vec3 *direction) {
    *origin = vec3(starts->origin_x[place], starts->origin_y[place], starts->origin_z[place]);
    *direction = vec3(starts->direction_x[place], starts->direction_y[place], starts->direction_z[place]);
    key->a = starts->key_a[place];
    key->b = starts->key_b[place];
#if SAMPLER_SOBOL
    key->index_reversed = starts->index_reversed[place];
    key->scramble_a = starts->scramble_a[place];
    key->scramble_b = starts->scramble_b[place];
#endif
}

__kernel VECTORS_WRITTEN void trace(TRACE_PARAMETERS) {
    __local Starts starts;
    const uint item = get_global_id(0), place = get_local_id(0);
    {
        /* Work-items beyond the chunk begin its last path once more, and leave it there. */
        Vec3 origin, direction;
        const SampleKey key = sample_of_chunk(TRACE_ARGUMENTS, min(item, sample_count - 1), &origin, &direction);
        put_start(key, origin, direction, place, &starts);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item >= sample_count) return;
    const Scene scene = scene_init(SCENE_ARGUMENTS);
    SampleKey key;
    Vec3 origin, direction;
    take_start(&starts, place, &key, &origin, &direction);
    Path path;
    path_none(&path);
    path_init(camera, key, origin, direction, vbool_all, &path);
    light_camera(&scene, &path, vbool_all);
    while (path_goes_on(&path, max_depth)) path_go_on(&scene, &path);
    store_sample(&path, item, samples);
#if EFFECT_LAMPS
    lamp_rays[item] = lamp_rays_of(&path);
#endif
}
