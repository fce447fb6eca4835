/* smooth.c: triangles that look curved, by normals at their vertices; see trace.h.
 *
 * In angles, by the definition that docs/NUMERICS.md gives: the mirror direction is raised towards the
 * plane's normal, and what a lobe sends to the wrong side is mirrored at the plane. Nothing is known of
 * densities. */
#include "trace.h"

#define RISE_MAX (1.0 / 64)

/* How much of the triangle a point leaves to the vertex opposite to the side from `a` to `b`. */
static double share(Vec point, Vec a, Vec b, Vec c, Vec face) {
    return dot(face, cross(sub(b, a), sub(point, a))) / dot(face, cross(sub(b, a), sub(c, a)));
}

/* The unit vector above the same place of a plane as `v`, as if seen from the origin, whose tip would be at
 * this height. */
static Vec raised(Vec v, Vec normal, double height) {
    const Vec along = sub(v, scale(dot(v, normal), normal));
    const double angle = atan2(height, sqrt(length2(along)));
    if (!(length2(along) > 0)) return normal;
    return add(scale(cos(angle), unit(along)), scale(sin(angle), normal));
}

Vec bp_ref_shown_normal(const BpScene *scene, const Hit *hit, Vec incoming, Vec face) {
    const size_t number = (size_t)(hit->triangle - scene->triangles);
    const float(*const normals)[3] = bp_triangle_normals(scene, number);
    if (normals == NULL) return face;
    Vec corners[3], sum = {0, 0, 0};
    for (int k = 0; k < 3; ++k) corners[k] = vec(hit->triangle->vertices[k]);
    for (int k = 0; k < 3; ++k) {
        const Vec from = corners[(k + 1) % 3], to = corners[(k + 2) % 3];
        const Vec normal = {(double)normals[k][0], (double)normals[k][1], (double)normals[k][2]};
        sum = add(sum, scale(share(hit->point, from, to, corners[k], face), normal));
    }
    if (length2(sum) <= 0x1p-20) return face;
    const Vec shown = scale(dot(sum, face) < 0 ? -1 : 1, unit(sum)), out = scale(-1, incoming);
    if (hit->material->kind == BP_MATERIAL_LAMBERTIAN) return shown;
    const Vec mirrored = sub(scale(2 * dot(out, shown), shown), out);
    const double least = fmin(dot(out, face) / 2, RISE_MAX);
    if (dot(mirrored, face) >= least) return shown;
    return unit(add(out, raised(mirrored, face, least)));
}

Vec bp_ref_folded(const Hit *hit, Vec direction) {
    if (hit->triangle == NULL) return direction;
    const Vec face = hit->front_face ? hit->radial : scale(-1, hit->radial);
    const double shown = dot(direction, hit->normal), height = dot(direction, face);
    if ((shown > 0 && height >= 0) || (shown < 0 && height <= 0)) return direction;
    return sub(direction, scale(2 * height, face));
}
