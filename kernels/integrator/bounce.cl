/* bounce.cl: extends a path by one segment, in lane code.
 *
 * In:    paths and the scene.   Out: the same paths, one segment longer.
 * Knows: the tree, the shape, the sky, the shadow catcher, the media, the lamps, the materials and their textures, each by one function.   Does not know: pixels. */

#if EFFECT_MEDIA
#define seen_through(path, radiance) multiply3((path)->throughput, radiance)
#else
#define seen_through(path, radiance) (radiance)
#endif

/* One segment of every living path that waits for nothing: intersect, collect radiance, scatter. */
static void trace_bounce(const Scene *scene, Path *path) {
    const vbool moving = path_moves(path);
    const Ray ray = path_ray(path);
    const Hit hit = intersect_closest(&scene->geometry, &ray, moving);
#if EFFECT_SHADOW_CATCHER
    vreal to_catcher;
    const vbool at_catcher = meets_catcher(scene, path, &hit, moving, &to_catcher);
#define reach choose(at_catcher, to_catcher, to_real(hit.t))
#else
#define reach to_real(hit.t)
#endif
#if EFFECT_MEDIA
    path->depth = choose_uint(moving, path->depth + 1u, path->depth);
    vreal flown;
    find_media(scene, &ray, moving, path);
    const vbool scattered = fly(scene, moving, reach, path, &flown);
    const vbool arrived = moving & vbool_not(scattered);
    path->scattered = scattered;
#else
    const vbool arrived = moving;
#endif
#undef reach
#if EFFECT_SHADOW_CATCHER
    const vbool caught = arrived & at_catcher;
    const vbool met = arrived & is_hit(&hit) & vbool_not(caught);
    vbool dark = vbool_none;
    if (any_lane(caught)) dark = lies_in_shadow(scene, path, caught, to_catcher);
    path->caught = caught;
    path->dark = dark;
#else
    const vbool met = arrived & is_hit(&hit);
#endif
    path->met = met;
    path->entered = hit.enters;
    path->distance = hit.t;
#if EFFECT_SHADOW_CATCHER
    path->distance = choose_refined(caught, to_refined(to_catcher), path->distance);
#endif
#if EFFECT_MEDIA
    path->distance = choose_refined(scattered, to_refined(flown), path->distance);
#else
    path->depth = choose_uint(moving, path->depth + 1u, path->depth);
#endif

    const vbool escaped = arrived & vbool_not(met);
    if (any_lane(escaped)) {
        Vec3 light = multiply3(path->throughput, sky_radiance(scene->sky, path->direction));
#if EFFECT_ENVIRONMENT
        if (has_environment(scene->sky)) light = multiply3(path->throughput, environment_light(scene, path, escaped));
#endif
#if EFFECT_DISCS
        light = add3(light, multiply3(path->throughput, discs_radiance(scene, path, escaped)));
#endif
        /* A camera ray, which carries all of what it shows, or what a medium leaves of that. */
        const vbool at_once = escaped & vbool_of_uint(path->depth == splat_uint(1));
        if (has_backdrop(scene->sky))
            light = choose3(at_once, seen_through(path, backdrop_radiance(scene->sky, path->origin.high, path->direction)), light);
#if EFFECT_SHADOW_CATCHER
        /* A shadow is black, and covers what lies behind. */
        light = choose3(dark, zero3(), light);
#define uncovered (at_once & vbool_not(dark))
#else
#define uncovered at_once
#endif
        path->radiance = choose3(escaped, add3(path->radiance, light), path->radiance);
        path->depth = choose_uint(uncovered, splat_uint(1u + MISSED_MARK), path->depth);
#undef uncovered
        path->alive = path->alive & vbool_not(escaped);
    }
#if EFFECT_MEDIA
    if (any_lane(scattered)) scatter_in_medium(scene, scattered, flown, path);
#endif
    if (!any_lane(met)) return;

#if SPHERES_MET
    Sphere sphere;
#endif
    Surface surface;
    Vec3 outward, emitted;
    Point point;
    fetch_surface(scene, &ray, &hit, WITH_SPHERE(&sphere) &surface, &emitted);
#if SPHERES_MET
    sphere_surface(&ray, &sphere, hit.slot, hit.t, hit.enters, &point, &outward);
#endif
#if EFFECT_TRIANGLES
    surface_of_triangle(&scene->geometry, &ray, &hit, met, &point, &outward);
#endif
    surface.incoming = path->direction;
    surface.enters = hit.enters;
    surface.normal = choose3(hit.enters, outward, scale3(splat(-1), outward));
#if EFFECT_TEXTURES
    vary_surface(scene, met, hit.slot, &point, outward, &surface, &emitted);
#endif
#if SAMPLES_LAMP_TREE
#if EFFECT_TRIANGLES
    /* Triangles are no lamps that rays are sent to: their light is found by chance. */
    const vbool lit = met & hit.enters & (emitted.x + emitted.y + emitted.z > splat(0)) &
                      vbool_not(is_triangle(&scene->geometry, hit.slot));
#else
    const vbool lit = met & hit.enters & (emitted.x + emitted.y + emitted.z > splat(0));
#endif
    if (any_lane(lit)) emitted = scale3(lamp_hit_weight(scene, path, hit.slot, &sphere, lit), emitted);
#if SAMPLES_CAUSTICS
    if (any_lane(lit)) emitted = scale3(chain_hit_weight(scene, path, hit.slot, lit), emitted);
#endif
#endif
#if EFFECT_NORMALS
    const vbool shows_normal = has_kind(&surface, KIND_NORMALS);
    const Vec3 colour =
        vec3(fma(surface.normal.x, splat(R(0.5)), splat(R(0.5))), fma(surface.normal.y, splat(R(0.5)), splat(R(0.5))),
             fma(surface.normal.z, splat(R(0.5)), splat(R(0.5))));
    emitted = choose3(shows_normal, add3(emitted, colour), emitted);
#endif
#if EFFECT_EMISSION || EFFECT_NORMALS
    path->radiance = choose3(met, add3(path->radiance, multiply3(path->throughput, emitted)), path->radiance);
#endif
    const BsdfSample bsdf_sample = scatter(&surface, path->key, first_dimension(path->depth - 1u));
#if SAMPLES_CAUSTICS
    follow_chain(scene, path, met, &hit, &bsdf_sample);
#endif
    path_scatter(path, met, &point, hit.slot, hit.enters, &bsdf_sample);
#if SAMPLES_LAMPS
    /* The ray to a lamp stands for the next segment of the path, so where the path ends there is none. */
    const vbool follows = vbool_of_uint(path->depth < splat_uint(scene->max_depth));
#if LAMPS_THROUGH_MEDIA
    /* Past the boundary of a medium a path is still on its way from the vertex before. */
    path_light(path, met & vbool_not(has_kind(&surface, KIND_INTERFACE)), &bsdf_sample.lobe, follows);
#else
    path_light(path, met, &bsdf_sample.lobe, follows);
#endif
#endif
}
