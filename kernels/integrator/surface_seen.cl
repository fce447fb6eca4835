/* surface_seen.cl: what paths see of the surfaces that they meet.
 *
 * In:    paths and the vertices that they have reached.   Out: the same paths, with the radiance that comes
 * from there. Knows: vertex.cl, the weights of lamps that are met (lamps_direct.cl, caustics.cl).   Does not
 * know: what surfaces scatter. */
#if SAMPLES_LAMP_TREE
/* Whether what was met, if it emits, is a lamp seen from a side that emits: triangles have two. */
#if SAMPLES_TRIANGLES
static vbool shows_lamp(const Geometry *geometry, const Hit *hit) {
    return hit->enters | is_triangle(geometry, hit->slot);
}
#elif EFFECT_TRIANGLES
static vbool shows_lamp(const Geometry *geometry, const Hit *hit) {
    return hit->enters & vbool_not(is_triangle(geometry, hit->slot));
}
#else
#define shows_lamp(geometry, hit) (hit)->enters
#endif

/* Rays are sent to lamps as well, so what is met of them by chance has a weight. */
static void weigh_lamps(const Scene *scene, const Path *path, const Hit *hit, vbool met, Vertex *vertex) {
    const Vec3 emitted = vertex->emitted;
    const vbool lit =
        met & shows_lamp(&scene->geometry, hit) & (emitted.x + emitted.y + emitted.z > splat(0));
    if (!any_lane(lit)) return;
    vertex->emitted =
        scale3(lamp_hit_weight(scene, path, hit->slot, WITH_SPHERE(&vertex->sphere) lit), emitted);
    vertex->emitted = scale3(chain_hit_weight(scene, path, hit->slot, lit), vertex->emitted);
}
#else
#define weigh_lamps(scene, path, hit, met, vertex)
#endif

#if EFFECT_NORMALS
static void show_normal(Vertex *vertex) {
    const Vec3 normal = vertex->surface.normal;
    const vbool shows_normal = has_kind(&vertex->surface, KIND_NORMALS);
    const Vec3 colour =
        vec3(fma(normal.x, splat(R(0.5)), splat(R(0.5))), fma(normal.y, splat(R(0.5)), splat(R(0.5))),
             fma(normal.z, splat(R(0.5)), splat(R(0.5))));
    vertex->emitted = choose3(shows_normal, add3(vertex->emitted, colour), vertex->emitted);
}
#else
#define show_normal(vertex)
#endif

#if EFFECT_EMISSION || EFFECT_NORMALS
/* In the lanes `met`. */
static void see_surface(const Scene *scene, const Hit *hit, vbool met, Vertex *vertex, Path *path) {
    weigh_lamps(scene, path, hit, met, vertex);
    show_normal(vertex);
    const Vec3 light = multiply3(path->throughput, vertex->emitted);
    path->radiance = choose3(met, add3(path->radiance, light), path->radiance);
}
#else
#define see_surface(scene, hit, met, vertex, path)
#endif
