/* camera.cl: from a pixel and random numbers to a ray. The camera's position is the origin of space.
 *
 * In:    a pixel, the key of its sample.   Out: where the ray begins and its direction.
 * Knows: scene_types.h, sampler.cl, warps.cl.   Does not know: chunks, paths. */

/* The point of the lens that the ray leaves, and its unit direction. `column` and `row` are whole numbers;
 * `center` is 1 for rays through pixel centres only. */
static void camera_ray(__global const PackedCamera *camera, uint center, SampleKey key, vreal column, vreal row,
                       Vec3 *origin, Vec3 *direction) {
    vreal x, y;
    sample_2d(key, splat_uint(DIMENSION_PIXEL), &x, &y);
    /* Chosen, not branched to: see trace_sample.cl. */
    x = center != 0 ? splat(R(0.5)) : x;
    y = center != 0 ? splat(R(0.5)) : y;
    /* The pixel's corner first, the offset in it last: the offset keeps its bits in wide pictures. */
    const Vec3 right = splat3(camera->right), down = splat3(camera->down);
    const Vec3 corner = madd3(row, down, madd3(column, right, splat3(camera->corner)));
    const Vec3 target = madd3(y, down, madd3(x, right, corner));
    const int orthographic = camera->ahead[3] != 0;
    const Vec3 ahead = splat3(camera->ahead);
#if EFFECT_LENS
    vreal u, v, lens_x, lens_y;
    sample_2d(key, splat_uint(DIMENSION_LENS), &u, &v);
    sample_disk(u, v, &lens_x, &lens_y);
    const Vec3 aside = madd3(lens_y, splat3(camera->lens_up), scale3(lens_x, splat3(camera->lens_right)));
    *origin = orthographic ? madd3(splat(camera->corner[3]), aside, target) : aside;
    *direction = normalise3(subtract3(orthographic ? ahead : target, aside));
#else
    *origin = orthographic ? target : zero3();
    *direction = normalise3(orthographic ? ahead : target);
#endif
}
