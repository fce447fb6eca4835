/* trace_pool.cl: the kernel of the pool form: a work-group has a share of the chunk's pixel samples, and a work-item whose
 * path has ended takes the next one of them (regeneration).
 *
 * In:    the packed scene, a chunk.   Out: the samples of the chunk, as pixels.cl says.
 * Knows: one_path.cl, caustics.cl.   Does not know: what a bounce does.
 *
 * Paths differ in length, and work-items that proceed in step wait for the longest of theirs. Here none waits before its
 * group's share is used up. Who traces a sample changes nothing of it. Paths begin and continue in one loop, so that work-items
 * meet after each segment; a loop for each path would make them wait again. */
__kernel VECTORS_WRITTEN void trace(TRACE_PARAMETERS) {
    __local uint next;
    const uint share = (sample_count - 1) / (uint)get_num_groups(0) + 1;
    const uint begin = min((uint)get_group_id(0) * share, sample_count), end = begin + min(share, sample_count - begin);
    if (get_local_id(0) == 0) next = begin;
    barrier(CLK_LOCAL_MEM_FENCE);
    const Scene scene = scene_init(SCENE_ARGUMENTS);
    Path path;
    path_none(&path);
    uint number = end; /* of the path's pixel sample; `end`: it has none yet */
    for (;;) {
        if (!path_goes_on(&path, max_depth)) {
            if (number < end) store_sample(&path, number, samples);
            number = atomic_inc(&next);
            if (number >= end) break;
            Vec3 origin, direction;
            const SampleKey key = sample_of_chunk(TRACE_ARGUMENTS, number, &origin, &direction);
            path_init(camera, key, origin, direction, vbool_all, &path);
            light_camera(&scene, &path, vbool_all);
            if (max_depth == 0) continue; /* a cap of 0 cuts at once */
        }
        path_go_on(&scene, &path);
    }
#if EFFECT_LAMPS
    lamp_rays[get_global_id(0)] = lamp_rays_of(&path);
#endif
}
