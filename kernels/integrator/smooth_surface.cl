/* smooth_surface.cl: the normal that a smooth triangle shows, between those at its vertices.
 *
 * In:    surfaces with the normal of a triangle's plane, and where on the triangle they are.   Out: the same, with the normal that
 * lobes stand about. Knows: hit.cl, bsdf.cl.   Does not know: what lobes send below the surface (bsdf/fold.cl).
 *
 * It is the mean of the three by the point's shares, on the side that the path comes from. A mirror about that may point below the true
 * surface, or the path may come from below the normal. Where the mirror direction rises by less than half the cosine by which the
 * path comes, or 1/64 if that is less, it is lifted to that along the true normal, and the normal becomes the one halfway between it and where
 * the path comes from. This is continuous, and a triangle whose normals are its own stays as it is. Lambert's surfaces look the same
 * from everywhere, so their normal is not bent. */
#if SMOOTH_TRIANGLES
#define MIRROR_RISE R(0x1p-6)

static Vec3 bent_normal(const Surface *surface, Vec3 normal) {
    const Vec3 d = surface->incoming, n = surface->normal;
    const Vec3 mirrored = madd3(splat(-2) * dot3(d, normal), normal, d);
    const vreal rise = dot3(mirrored, n), least = smaller(R(-0.5) * dot3(d, n), splat(MIRROR_RISE));
    const Vec3 lifted = normalise3(madd3(least - rise, n, mirrored));
    return choose3(rise < least, normalise3(subtract3(lifted, d)), normal);
}

static void smooth_surface(const Scene *scene, const Hit *hit, vbool met, const Shares *shares, Surface *surface) {
    const Geometry *const geometry = &scene->geometry;
    vbool smooth = met & is_triangle(geometry, hit->slot);
    if (geometry->normal_leaves == 0 || !any_lane(smooth)) return;
    const Triangle normals = load_normals(geometry, choose_uint(smooth, hit->slot, splat_uint(geometry->first_triangles * TREE_WIDTH)));
    const Vec3 mean = madd3(shares->b, normals.b, madd3(shares->c, normals.c, scale3(splat(1) - shares->b - shares->c, normals.a)));
    smooth = smooth & (dot3(mean, mean) > splat(R(0x1p-20)));
    if (!any_lane(smooth)) return;
    const vreal side = choose(dot3(mean, surface->normal) < splat(0), splat(-1), splat(1));
    const Vec3 normal = normalise3(choose3(smooth, scale3(side, mean), surface->normal));
    Vec3 bent = bent_normal(surface, normal);
#if EFFECT_LAMBERTIAN
    bent = choose3(has_kind(surface, KIND_LAMBERTIAN), normal, bent);
#endif
    surface->true_normal = choose3(smooth, surface->normal, surface->true_normal);
    surface->normal = choose3(smooth, bent, surface->normal);
}
#endif
