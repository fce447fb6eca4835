/* medium.c: flights through media; see trace.h. */
#include "trace.h"

#define PI 3.14159265358979323846

/* Beyond this many mean free paths nothing is left in double. */
#define FAR 800.0

/* Whether the ray begins inside the sphere, or goes into it from its surface. */
static bool begins_inside(const BpScene *scene, const Ray *ray, const BpSphere *sphere) {
    const Vec from_center = sub(ray->origin, bp_ref_center(scene, ray, sphere));
    const double radius = fabs(sphere->radius), distance = sqrt(length2(from_center));
    const bool from_camera =
        ray->leaves == NULL && ray->quits == NULL && ray->parts == NULL && !ray->scattered;
    if (ray->leaves == sphere) return dot(ray->direction, from_center) < 0;
    if (from_camera && fabs(distance - radius) <= 1e-15 * (radius + sqrt(length2(ray->origin))))
        return dot(ray->direction, from_center) < 0; /* a camera on the surface */
    return distance < radius;
}

static bool begins_in_capsule(const Ray *ray, const BpCapsule *capsule) {
    const Vec away = bp_ref_from_axis(capsule, ray->origin);
    if (ray->parts == capsule) return dot(ray->direction, away) < 0;
    return length2(away) < capsule->radius * capsule->radius;
}

/* The solid angle that a triangle fills, positive where its inner side is seen (A. van Oosterom and J.
 * Strackee, "The Solid Angle of a Plane Triangle", 1983). Of the triangle that the ray leaves that is a half
 * of all directions, seen from the side to which it goes; others in its plane are seen from their edges. */
static double solid_angle(const Ray *ray, const BpTriangle *triangle) {
    Vec at[3];
    for (int k = 0; k < 3; ++k) at[k] = sub(vec(triangle->vertices[k]), ray->origin);
    const Vec outward = cross(sub(at[1], at[0]), sub(at[2], at[0]));
    if (ray->quits == triangle) return dot(ray->direction, outward) < 0 ? 2 * PI : -2 * PI;
    for (int k = 0; k < 3; ++k) at[k] = unit(at[k]);
    const double volume = dot(at[0], cross(at[1], at[2]));
    return 2 * atan2(volume, 1 + dot(at[0], at[1]) + dot(at[1], at[2]) + dot(at[2], at[0]));
}

/* How often a body's triangles wind around where the ray begins, by all directions in which they are seen. */
static double winding(const BpScene *scene, const Ray *ray, uint32_t body) {
    double sum = 0;
    for (size_t i = scene->bodies.list[body].first; i < scene->triangle_count; ++i)
        if (scene->bodies.of_triangle[i] == body) sum += solid_angle(ray, &scene->triangles[i]);
    return sum / (4 * PI);
}

static bool lets_light_in(const BpScene *scene, uint32_t material) {
    const BpMaterialKind kind = scene->materials[material].kind;
    return kind == BP_MATERIAL_DIELECTRIC || kind == BP_MATERIAL_ROUGH_DIELECTRIC ||
           kind == BP_MATERIAL_INTERFACE;
}

/* Of the boundary around it that has the least volume, of equal ones the first: spheres, then bodies of
 * triangles, then capsules. NULL: clear. */
static const BpMedium *medium_around(const BpScene *scene, const Ray *ray) {
    double smallest = INFINITY;
    uint32_t number = scene->medium;
    if (scene->medium_count == 0) return NULL;
    for (size_t i = 0; i < scene->sphere_count; ++i) {
        const BpSphere *sphere = &scene->spheres[i];
        const double radius = fabs(sphere->radius), volume = 4 * PI / 3 * radius * radius * radius;
        if (!lets_light_in(scene, sphere->material) || volume >= smallest ||
            !begins_inside(scene, ray, sphere))
            continue;
        smallest = volume;
        number = i < scene->interior_count ? scene->interiors[i] : 0;
    }
    for (uint32_t b = 0; b < scene->bodies.count; ++b) {
        const BpBody *body = &scene->bodies.list[b];
        if (body->volume >= smallest || fabs(winding(scene, ray, b)) < 0.5) continue;
        smallest = body->volume;
        number = body->interior;
    }
    for (size_t i = 0; i < scene->capsule_count; ++i) {
        const BpCapsule *capsule = &scene->capsules[i];
        const double length = sqrt(length2(sub(vec(capsule->ends[1]), vec(capsule->ends[0]))));
        const double volume = PI * capsule->radius * capsule->radius * (length + 4 * capsule->radius / 3);
        if (!lets_light_in(scene, capsule->material) || volume >= smallest ||
            !begins_in_capsule(ray, capsule))
            continue;
        smallest = volume;
        number = i < scene->capsule_interior_count ? scene->capsule_interiors[i] : 0;
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
