/* vertex.cl: the point where a ray meets a surface, with the surface as it is there.
 *
 * In:    rays and their hits.   Out: point, normal, material with its textures, and what it emits.
 * Knows: the shapes by one function each, fetch_surface.cl, smooth_surface.cl, triangle_map.cl, vary_surface.cl.   Does not know: paths. */
typedef struct Vertex {
#if SPHERES_MET
    Sphere sphere; /* of no meaning where a triangle was met */
#endif
    Surface surface;
    Point point;
    Vec3 outward, emitted;
} Vertex;

static void vertex_init(const Scene *scene, const Ray *ray, const Hit *hit, vbool met, Vertex *vertex) {
    Surface *surface = &vertex->surface;
    fetch_surface(scene, ray, hit, WITH_SPHERE(&vertex->sphere) surface, &vertex->emitted);
#if SPHERES_MET
    sphere_surface(ray, &vertex->sphere, hit->slot, hit->t, hit->enters, &vertex->point, &vertex->outward);
#endif
#if SHARES_KNOWN
    Shares shares;
#endif
#if EFFECT_TRIANGLES
    surface_of_triangle(&scene->geometry, ray, hit, met, WITH_SHARES(&shares) &vertex->point, &vertex->outward);
#endif
    surface->incoming = ray->direction;
    surface->enters = hit->enters;
    surface->normal = choose3(hit->enters, vertex->outward, scale3(splat(-1), vertex->outward));
#if SMOOTH_TRIANGLES
    smooth_surface(scene, hit, met, &shares, surface);
#endif
#if MAPPED_TRIANGLES
    const MapPlace place = triangle_map(scene, hit->slot, met, &shares);
#endif
    vary_surface(scene, met, hit->slot, &vertex->point, WITH_PLACE(&place) vertex->outward, surface, &vertex->emitted);
}
