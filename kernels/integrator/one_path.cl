/* one_path.cl: the path of one pixel sample of a chunk, from its camera ray to its result, for the forms whose work-items
 * follow one path at a time.
 *
 * In:    the packed scene, a chunk, the number of a pixel sample in it.   Out: its sample, as pixels.cl says.
 * Knows: path.cl, bounce.cl, lamps_direct.cl, pixels.cl.   Does not know: which work-item traces which sample. */

/* The camera ray of pixel sample `number` of the chunk, and its key. */
static SampleKey sample_of_chunk(TRACE_PARAMETERS, uint number, Vec3 *origin, Vec3 *direction) {
    const uint ahead = number / samples_per_pixel;
    const Pixel pixel =
        pixel_of_chunk(first_pixel, ahead, sample_count / samples_per_pixel, width PIXEL_LIST_ARGUMENT);
    const SampleKey key = sample_key(seed_low, seed_high, pixel.row * width + pixel.column,
                                     first_sample + number - ahead * samples_per_pixel, replicates);
    camera_ray(camera, pixel_center, key, (real)pixel.column, (real)pixel.row, origin, direction);
    return key;
}

/* Whether the path goes on by a segment more. */
static int path_goes_on(const Path *path, uint max_depth) { return path->alive && path->depth < max_depth; }

static void path_go_on(const Scene *scene, Path *path) {
    play_roulette(path);
#if EFFECT_ROULETTE
    if (!path->alive) return;
#endif
    trace_bounce(scene, path);
#if SAMPLES_LAMPS
    if (path->wants_lamps) light_vertices(scene, path);
#endif
}

/* The result of a path that has ended or been cut. */
static void store_sample(const Path *path, uint number, __global real *samples) {
    const real cut = path->alive ? R(0.5) : R(0.0);
    vstore4((real4)(path->radiance.x, path->radiance.y, path->radiance.z, (real)path->depth + cut), number, samples);
}
