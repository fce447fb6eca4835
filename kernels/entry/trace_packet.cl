/* trace_packet.cl: the kernel of the packet form: a work-item takes SAMPLES_PER_ITEM pixel samples of the chunk, as
 * many at a time as there are lanes; lanes whose path has ended take the next ones.
 *
 * In:    the packed scene, a chunk.   Out: the samples of the chunk, as pixels.cl says.
 * Knows: path.cl, bounce.cl, lamps_direct.cl, caustics.cl, pixels.cl.   Does not know: what a bounce does. */
__kernel VECTORS_WRITTEN void trace(TRACE_PARAMETERS) {
    const Scene scene = scene_init(SCENE_ARGUMENTS);
    const uint item = get_global_id(0);
    uint next = item * SAMPLES_PER_ITEM;
    const uint end = min(next + SAMPLES_PER_ITEM, sample_count);
    if (next >= end) return;
    /* The pixel sample that `next` stands for. */
    Pixel pixel = pixel_of_chunk(first_pixel, next / samples_per_pixel, sample_count / samples_per_pixel,
                                 width PIXEL_LIST_ARGUMENT);
    uint sample = next % samples_per_pixel;

    Path path;
    path_none(&path);
    vbool cut = path.alive; /* lanes whose path the cap has ended, black for what is missing */
    /* Of a lane's pixel sample within the chunk. If there are fewer than lanes, the rest writes to the place of the first
     * lane, which writes after them. */
    vuint number = splat_uint(next);
    for (;;) {
#if SAMPLES_LAMPS
        const vbool busy = path.alive | path.wants_lamps;
#else
        const vbool busy = path.alive;
#endif
        /* Once half of the lanes are free: results out, the next pixel samples in. */
        uint alive = popcount(lane_bits(busy));
        if (alive == 0 || (alive <= LANE_COUNT / 2 && next < end)) {
            const vreal count = uint_to_real(path.depth) + choose(cut, splat(R(0.5)), splat(0));
            /* For a path that continues, this is not the final value; but its place belongs to it alone, and a test would cost more. */
            scatter4(path.radiance.x, path.radiance.y, path.radiance.z, count, number, samples);
            if (next >= end) {
#if EFFECT_LAMPS
                lamp_rays[item] = lamp_rays_of(&path);
#endif
                return; /* from here: a common end behind the loop makes compilers keep more in memory */
            }
            /* The free lanes take the next pixel samples, the lowest lane first. */
            const uint free = lane_bits(vbool_not(busy));
            const vuint rank = popcount(splat_uint(free) & BITS_BELOW);
            const vbool fresh = vbool_not(busy) & vbool_of_uint(rank < splat_uint(end - next));
            number = choose_uint(fresh, next + rank, number);
            vuint sample_number = sample + rank, ahead = splat_uint(0);
            carry_over(&sample_number, samples_per_pixel, &ahead);
            const Pixels pixels = pixels_ahead(&pixel, ahead, width);
            const uint taken = min((uint)popcount(free), end - next);
            next += taken;
            alive += taken;
            for (sample += taken; sample >= samples_per_pixel; sample -= samples_per_pixel) next_pixel(&pixel, width);
            const SampleKey key = sample_key(seed_low, seed_high, pixels.row * width + pixels.column,
                                             first_sample + sample_number, replicates);
            path_init_from_camera(camera, pixel_center, key, uint_to_real(pixels.column), uint_to_real(pixels.row),
                                  fresh, &path);
            light_camera(&scene, &path, fresh);
            cut = cut & vbool_not(fresh);
        }
        /* Behind the refill, so that a cap of 0 cuts new paths at once. */
        const vbool reached = path_moves(&path) & vbool_of_uint(path.depth >= splat_uint(max_depth));
        cut = cut | reached;
        path.alive = path.alive & vbool_not(reached);
#if SAMPLES_LAMPS
        /* Vertices wait until most paths stand at one. */
        if (2 * popcount(lane_bits(path.wants_lamps)) > alive) {
            light_vertices(&scene, &path);
            continue;
        }
#endif
        play_roulette(&path);
        trace_bounce(&scene, &path);
    }
}
