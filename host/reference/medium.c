/* medium.c: flights through media; see trace.h. */
#include "trace.h"

/* Beyond this many mean free paths nothing is left in double. */
#define FAR 800.0

/* Whether the ray begins inside the sphere, or goes into it from its surface. */
static bool begins_inside(const BpScene *scene, const Ray *ray, const BpSphere *sphere) {
    const Vec from_center = sub(ray->origin, bp_ref_center(scene, ray, sphere));
    const double radius = fabs(sphere->radius), distance = sqrt(length2(from_center));
    if (ray->leaves == sphere) return dot(ray->direction, from_center) < 0;
    if (ray->leaves == NULL && !ray->scattered &&
        fabs(distance - radius) <= 1e-15 * (radius + sqrt(length2(ray->origin))))
        return dot(ray->direction, from_center) < 0; /* a camera on the surface */
    return distance < radius;
}

/* Of the smallest sphere around that light passes through, of equal ones the first; NULL: clear. */
static const BpMedium *medium_around(const BpScene *scene, const Ray *ray) {
    double smallest = INFINITY;
    uint32_t number = scene->medium;
    if (scene->medium_count == 0) return NULL;
    for (size_t i = 0; i < scene->sphere_count; ++i) {
        const BpSphere *sphere = &scene->spheres[i];
        const BpMaterialKind kind = scene->materials[sphere->material].kind;
        if (kind != BP_MATERIAL_DIELECTRIC && kind != BP_MATERIAL_ROUGH_DIELECTRIC &&
            kind != BP_MATERIAL_INTERFACE)
            continue;
        if (fabs(sphere->radius) >= smallest || !begins_inside(scene, ray, sphere)) continue;
        smallest = fabs(sphere->radius);
        number = i < scene->interior_count ? scene->interiors[i] : 0;
    }
    return number == 0 ? NULL : &scene->media[number - 1];
}

/* Henyey and Greenstein 1941, inverted as textbooks have it; evenly where g is next to nothing. */
static double phase_cosine(double g, Random *random) {
    const double u = random_real(random);
    if (fabs(g) < 1e-6) return 2 * u - 1;
    const double root = (1 - g * g) / (1 - g + 2 * g * u);
    return (1 + g * g - root * root) / (2 * g);
}

static Vec phase_direction(Vec before, double g, Random *random) {
    const double cosine = fmax(-1, fmin(1, phase_cosine(g, random)));
    Vec across;
    do {
        across = cross(before, random_on_sphere(random));
    } while (length2(across) < 1e-8);
    return add(scale(cosine, before), scale(sqrt(1 - cosine * cosine), unit(across)));
}

/* exp(-density * length), with 0 and infinity as one expects of them. */
static double left_of(double density, double length) {
    if (density == 0) return 1;
    return density * length > FAR ? 0 : exp(-density * length);
}

/* By the same estimator as the kernel, since check compares the spread of samples too: lengths by scattering
 * of one colour, the same all along the path, weighted by the balance heuristic against the two others;
 * absorption is a weight. */
bool bp_ref_fly(const BpScene *scene, const Ray *ray, double distance, Random *random, Path *path,
                Ray *scattered, Vec *weight) {
    const BpMedium *medium = medium_around(scene, ray);
    *weight = (Vec){1, 1, 1};
    if (medium == NULL) return false;
    if (!path->flies) {
        path->flies = true;
        path->color = (int)(3 * random_real(random));
        for (int c = 0; c < 3; ++c) path->likelihood[c] = 1;
    }
    const double end = distance * sqrt(length2(ray->direction)), by = medium->scattering[path->color];
    const double length = by > 0 ? -log(1 - random_real(random)) / by : INFINITY;
    const bool scatters = length < end;
    double left[3], mean = 0;
    for (int c = 0; c < 3; ++c) {
        double density = left_of(medium->scattering[c], scatters ? length : end);
        if (scatters) density *= medium->scattering[c];
        left[c] = density * left_of(medium->absorption[c], scatters ? length : end);
        path->likelihood[c] *= density;
        mean += path->likelihood[c] / 3;
    }
    for (int c = 0; c < 3; ++c) path->likelihood[c] /= mean;
    *weight = scale(1 / mean, vec(left));
    if (!scatters) return false;
    const Vec forward = unit(ray->direction);
    *scattered = (Ray){.origin = add(ray->origin, scale(length, forward)),
                       .direction = phase_direction(forward, medium->anisotropy, random),
                       .time = ray->time,
                       .scattered = true};
    return true;
}
