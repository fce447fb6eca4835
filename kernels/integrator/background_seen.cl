/* background_seen.cl: what paths see that meet no surface.
 *
 * In:    paths whose latest segment has escaped.   Out: the same, ended, with the radiance of the background or the backdrop.
 * Knows: sky.cl, discs_direct.cl.   Does not know: why a path meets nothing. */
static void see_background(const Scene *scene, Path *path) {
    const vbool escaped = path->latest.escaped, dark = path->latest.dark;
    if (!any_lane(escaped)) return;
    Vec3 light = multiply3(path->throughput, sky_radiance(scene->sky, path->direction));
    see_environment(scene, path, escaped, &light);
    see_discs(scene, path, escaped, &light);
    /* A camera ray, which carries all of what it shows, or what a medium leaves of that. */
    const vbool at_once = escaped & vbool_of_uint(path->depth == splat_uint(1));
    if (has_backdrop(scene->sky))
        light = choose3(at_once, seen_through(path, backdrop_radiance(scene->sky, path->origin.high, path->direction)), light);
    /* A shadow is black, and covers what lies behind. */
    light = choose3(dark, zero3(), light);
    path->radiance = choose3(escaped, add3(path->radiance, light), path->radiance);
    path->depth = choose_uint(at_once & vbool_not(dark), splat_uint(1u + MISSED_MARK), path->depth);
    path->alive = path->alive & vbool_not(escaped);
}
