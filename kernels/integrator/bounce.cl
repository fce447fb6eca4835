/* bounce.cl: how a path goes on by one segment, in lane code.
 *
 * In:    paths and the scene.   Out: the same paths, one segment longer.
 * Knows: the tree, the shape, the sky and the materials, each by one function.   Does not know: pixels. */

/* One segment of every living path: intersect, collect radiance, scatter. */
static void trace_bounce(const Scene *scene, Path *path) {
    const Ray ray = path_ray(path);
    const Hit hit = intersect_closest(&scene->geometry, &ray, path->alive);
    const vbool met = is_hit(&hit);
    path->met = met;
    path->entered = hit.enters;
    path->distance = hit.t;
    path->depth = choose_uint(path->alive, path->depth + 1u, path->depth);

    const vbool escaped = path->alive & vbool_not(met);
    if (any_lane(escaped)) {
        const Vec3 light = multiply3(path->throughput, sky_radiance(scene->sky, path->direction));
        path->radiance = choose3(escaped, add3(path->radiance, light), path->radiance);
    }
    path->alive = path->alive & met;
    if (!any_lane(path->alive)) return;

    Sphere sphere;
    Surface surface;
    Vec3 outward, emitted;
    Point point;
    fetch_surface(scene, &hit, &sphere, &surface, &emitted);
    sphere_surface(&ray, &sphere, hit.slot, hit.t, hit.enters, &point, &outward);
    surface.incoming = path->direction;
    surface.enters = hit.enters;
    surface.normal = choose3(hit.enters, outward, scale3(splat(-1), outward));
#if EFFECT_NORMALS
    const vbool shows_normal = has_kind(&surface, KIND_NORMALS);
    const Vec3 colour =
        vec3(fma(surface.normal.x, splat(R(0.5)), splat(R(0.5))), fma(surface.normal.y, splat(R(0.5)), splat(R(0.5))),
             fma(surface.normal.z, splat(R(0.5)), splat(R(0.5))));
    emitted = choose3(shows_normal, add3(emitted, colour), emitted);
#endif
#if EFFECT_EMISSION || EFFECT_NORMALS
    path->radiance = choose3(path->alive, add3(path->radiance, multiply3(path->throughput, emitted)), path->radiance);
#endif
    const BsdfSample bsdf_sample = scatter(&surface, path->key, path->depth - 1u);
    path->throughput = multiply3(path->throughput, bsdf_sample.weight);
    path->direction = bsdf_sample.direction;
    path->origin = point;
    path->own_slot = hit.slot;
    /* Coming from outside and staying there, or from inside and going through: outside. */
    path->inward =
        (hit.enters & bsdf_sample.transmitted) | (vbool_not(hit.enters) & vbool_not(bsdf_sample.transmitted));
    path->alive = path->alive & bsdf_sample.scattered;
}
