/* bounce.cl: extends a path by one segment, in lane code.
 *
 * In:    paths and the scene.   Out: the same paths, one segment longer.
 * Knows: what a segment may end at, what is seen there, what scatters and what waits for light, each by one function.   Does not
 *        know: pixels.
 *
 * What a scene does not have is a macro of nothing, which stands in the #else of the file that has the function. */

/* One segment of every living path that waits for nothing: intersect, collect radiance, scatter. */
ON_CHAINS static void trace_bounce(const Scene *scene, Path *path) {
    const vbool moving = path_moves(path);
    const Ray ray = path_ray(path);
    PIECE(last)
    const Hit hit = intersect_opaque(&scene->geometry, path, &ray, moving, &last);
    path->latest = end_segment(scene, &ray, &hit, moving, path);
    see_background(scene, path);
    scatter_in_medium(scene, path);
    const vbool met = path->latest.met;
    if (!any_lane(met)) return;

    Vertex vertex;
    vertex_init(scene, LAST_RAY(ray, last), LAST_HIT(hit, last), met, &vertex);
    see_surface(scene, &hit, met, &vertex, path);
    surface_set_odds(path, &vertex.surface);
    const BsdfSample bsdf_sample = scatter_folded(&vertex.surface, path->key, first_dimension(path->depth - 1u));
    path_keep_odds(path, met, &bsdf_sample);
    follow_chain(scene, path, met, &hit, &bsdf_sample);
    path_scatter(path, met, &vertex.point, hit.slot, hit.enters, &bsdf_sample);
    path_light(path, met & is_vertex(&vertex.surface), &bsdf_sample.lobe, scene->max_depth);
}
