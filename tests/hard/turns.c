/* turns.c: what turns.h promises. */
#include "turns.h"

#include <string.h>

static BpWorker *make_worker(const Lab *lab, const BpScene *shapes) {
    BpMaterial matte = {.name = (char *)"matte", .kind = BP_MATERIAL_LAMBERTIAN, .albedo = {0.5, 0.5, 0.5}};
    BpScene scene = *shapes;
    scene.path = scene.title = scene.source = scene.notes = (char *)"";
    scene.materials = &matte;
    scene.material_count = 1;
    scene.implicit_material = SIZE_MAX;
    bp_camera_defaults(&scene.camera);
    scene.camera.width = scene.camera.height = 4;
    return lab_scene(lab, &scene);
}

BpWorker *turns_worker(const Lab *lab, const BpSphere *spheres, size_t sphere_count,
                       const BpTriangle *triangles, size_t count) {
    const BpScene scene = {.spheres = (BpSphere *)(uintptr_t)spheres,
                           .sphere_count = sphere_count,
                           .triangles = (BpTriangle *)(uintptr_t)triangles,
                           .triangle_count = count};
    return make_worker(lab, &scene);
}

BpWorker *turns_capsules(const Lab *lab, const BpCapsule *capsules, size_t count) {
    const BpScene scene = {.capsules = (BpCapsule *)(uintptr_t)capsules, .capsule_count = count};
    return make_worker(lab, &scene);
}

void turns_aim(bool fine, double *ray, const double from[3], const double to[3]) {
    memset(ray, 0, RAY_REALS * sizeof *ray);
    for (int a = 0; a < 3; ++a) {
        ray[RAY_HIGH + a] = fine ? from[a] : lab_float(from[a]);
        ray[RAY_LOW + a] = fine ? 0 : lab_float(from[a] - ray[RAY_HIGH + a]);
        ray[RAY_DIRECTION + a] = to[a] - from[a];
    }
    lab_float_unit(ray + RAY_DIRECTION);
}

void turns_run(const Lab *lab, BpWorker *worker, size_t rays_count, const double *rays,
               const double *directions, double *out) {
    const LabArgument arguments[] = {{LAB_REALS, (double *)(uintptr_t)rays, rays_count * RAY_REALS},
                                     {LAB_REALS, (double *)(uintptr_t)directions, rays_count * 3},
                                     {LAB_OUT_REFINED, out, rays_count * TURN_REALS}};
    lab_run(lab, "probe_turns", rays_count, arguments, 3, worker);
}

bool turns_passes(const BpTriangle *triangle, const Wide origin[3], const Wide d[3], Wide tiny, Wide w[3],
                  Wide *t, bool *outside) {
    Wide at[3][3];
    for (int k = 0; k < 3; ++k)
        for (int a = 0; a < 3; ++a) at[k][a] = (Wide)triangle->vertices[k][a] - origin[a];
    bool below = false, above = false;
    for (int k = 0; k < 3; ++k) {
        const Wide *p = at[(k + 1) % 3], *q = at[(k + 2) % 3];
        w[k] = d[0] * (p[1] * q[2] - p[2] * q[1]) + d[1] * (p[2] * q[0] - p[0] * q[2]) +
               d[2] * (p[0] * q[1] - p[1] * q[0]);
        below = below || w[k] < -tiny;
        above = above || w[k] > tiny;
    }
    const Wide sum = w[0] + w[1] + w[2];
    if ((below && above) || sum == 0) return false;
    const Wide volume = at[0][0] * (at[1][1] * at[2][2] - at[1][2] * at[2][1]) +
                        at[0][1] * (at[1][2] * at[2][0] - at[1][0] * at[2][2]) +
                        at[0][2] * (at[1][0] * at[2][1] - at[1][1] * at[2][0]);
    *t = volume / sum;
    *outside = sum < 0;
    return true;
}

/* ---- capsules: a cylinder and two balls ---- */

static void widen(TurnsStretch *stretch, Wide from, Wide to) {
    if (!stretch->meets || from < stretch->from) stretch->from = from;
    if (!stretch->meets || to > stretch->to) stretch->to = to;
    stretch->meets = true;
}

TurnsStretch turns_through(const BpCapsule *capsule, const Wide origin[3], const Wide d[3], double scale) {
    const Wide r = (Wide)capsule->radius * (Wide)scale, dd = wide_dot(d, d);
    Wide axis[3], m[3], p[3], q[3];
    TurnsStretch stretch = {false, 0, 0};
    for (int k = 0; k < 2; ++k) {
        Wide oc[3];
        for (int a = 0; a < 3; ++a) oc[a] = (Wide)capsule->ends[k][a] - origin[a];
        const Wide middle = wide_dot(oc, d) / dd;
        for (int a = 0; a < 3; ++a) oc[a] -= middle * d[a];
        const Wide room = r * r - wide_dot(oc, oc);
        if (room >= 0) widen(&stretch, middle - wide_sqrt(room / dd), middle + wide_sqrt(room / dd));
    }
    for (int a = 0; a < 3; ++a) {
        axis[a] = (Wide)capsule->ends[1][a] - (Wide)capsule->ends[0][a];
        m[a] = origin[a] - (Wide)capsule->ends[0][a];
    }
    const Wide ww = wide_dot(axis, axis);
    if (ww == 0) return stretch;
    const Wide of_d = wide_dot(d, axis) / ww, of_m = wide_dot(m, axis) / ww;
    for (int a = 0; a < 3; ++a) {
        p[a] = d[a] - of_d * axis[a];
        q[a] = m[a] - of_m * axis[a];
    }
    const Wide A = wide_dot(p, p), t = A > 0 ? -wide_dot(p, q) / A : 0;
    for (int a = 0; a < 3; ++a) q[a] += t * p[a];
    const Wide room = r * r - wide_dot(q, q);
    if (!(A > 0) || room < 0) return stretch; /* along the axis the balls have both ends */
    Wide from = t - wide_sqrt(room / A), to = t + wide_sqrt(room / A);
    if (of_d != 0) {
        const Wide low = -of_m / of_d, high = (1 - of_m) / of_d;
        from = from > (low < high ? low : high) ? from : (low < high ? low : high);
        to = to < (low < high ? high : low) ? to : (low < high ? high : low);
    } else if (of_m < 0 || of_m > 1)
        return stretch;
    if (from <= to) widen(&stretch, from, to);
    return stretch;
}
