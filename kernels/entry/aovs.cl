/* aovs.cl: what each pixel's camera rays meet first: how far, which way it faces, what colour it is.
 *
 * Appended to a render's program when someone asks (host/render/aovs.c).
 * In:    the packed scene; a range of pixels; a range of samples, whose camera rays are those of the render.
 * Out:   for each pixel AOV_FLOATS sums over its samples, in the places that aov_list.h gives them. A ray that meets
 *        nothing adds nothing.
 * Knows: aov_list.h, path.cl, vertex.cl.   Does not know: how paths continue. */

/* One work-item a pixel; as many of its samples at a time as there are lanes. */
__kernel VECTORS_WRITTEN void aovs(SCENE_PARAMETERS uint first_pixel, uint pixel_count, uint first_sample,
                                   uint samples, float forward_x, float forward_y, float forward_z,
                                   __global float *out) {
    const uint item = get_global_id(0);
    if (item >= pixel_count) return;
    const Scene scene = scene_init(SCENE_ARGUMENTS);
    const uint pixel = first_pixel + item;
    const Vec3 forward = vec3(splat(forward_x), splat(forward_y), splat(forward_z));
    real sums[AOV_FLOATS];
    for (uint i = 0; i < AOV_FLOATS; ++i) sums[i] = 0;
    for (uint begun = 0; begun < samples; begun += LANE_COUNT) {
        const vuint numbers = splat_uint(begun) + LANE_NUMBERS;
        Path path;
        path_none(&path);
        const SampleKey key = sample_key(seed_low, seed_high, splat_uint(pixel), first_sample + numbers, replicates);
        path_init_from_camera(camera, pixel_center, key, splat((real)(pixel % width)), splat((real)(pixel / width)),
                              vbool_of_uint(numbers < splat_uint(samples)), &path);
        const Ray ray = path_ray(&path);
        PIECE(last)
        const Hit hit = intersect_opaque(&scene.geometry, &path, &ray, path.alive, &last);
        const vbool met = path.alive & is_hit(&hit);
        if (!any_lane(met)) continue;

        Vertex vertex;
        vertex_init(&scene, LAST_RAY(ray, last), LAST_HIT(hit, last), met, &vertex);
        const Vec3 normal = vertex.surface.normal, albedo = vertex.surface.albedo;
        const vreal values[AOV_FLOATS] = {
            /* along `forward_x, forward_y, forward_z`, from the camera */
            [AOV_DEPTH] = dot3(vertex.point.high, forward),
            /* unit, towards where the ray came from */
            [AOV_NORMAL] = normal.x, normal.y, normal.z,
            /* what the surface scatters: its colour, 1 for a dielectric, 0 for a lamp */
            [AOV_ALBEDO] = albedo.x, albedo.y, albedo.z,
            [AOV_MET] = splat(1)};
        for (uint i = 0; i < AOV_FLOATS; ++i) {
            LaneReals lanes;
            lanes.all = choose(met, values[i], splat(0));
            for (uint lane = 0; lane < LANE_COUNT; ++lane) sums[i] += lanes.of[lane];
        }
    }
    for (uint i = 0; i < AOV_FLOATS; ++i) out[(size_t)item * AOV_FLOATS + i] = (float)sums[i];
}
