/* trace.c: intersection and the recursion; see trace.h. */
#include "trace.h"

#include "scene/material.h"

#include <float.h>

#define PI 3.14159265358979323846

/* A ray that starts on a sphere starts also on every other one of the same place and size. A camera may stand
 * on a sphere too: within the rounding of the numbers that place both. */
static bool starts_on(const BpScene *scene, const Ray *ray, const BpSphere *sphere) {
    const BpSphere *from = ray->leaves;
    if (from == sphere) return true;
    if (from == NULL && (ray->scattered || ray->quits != NULL || ray->parts != NULL)) return false;
    if (from == NULL) {
        const Vec center = bp_ref_center(scene, ray, sphere);
        const double radius = fabs(sphere->radius), distance = sqrt(length2(sub(center, ray->origin)));
        const double size = sqrt(length2(center)) + sqrt(length2(ray->origin)) + radius;
        return fabs(distance - radius) <= 4 * DBL_EPSILON * size;
    }
    const Vec a = bp_ref_center(scene, ray, from), b = bp_ref_center(scene, ray, sphere);
    return fabs(from->radius) == fabs(sphere->radius) && a.x == b.x && a.y == b.y && a.z == b.z;
}

/* The book's quadratic a t^2 - 2 h t + c = 0, two ways of it:
 * - Where the ray starts on the sphere, c = 0, so t (a t - 2 h) = 0: one root is the start itself, which does
 *   not count, the other is 2 h / a, and lies ahead only when the ray goes into the sphere. No epsilon.
 * - Else the discriminant comes from the perpendicular distance to the centre (Haines et al., "Precision
 *   improvements for ray/sphere intersection", Ray Tracing Gems, 2019): h^2 - a c would cancel for a small
 *   sphere far away. */
static bool hit_sphere(const BpScene *scene, const BpSphere *sphere, const Ray *ray, double t_max,
                       double *t) {
    const Vec oc = sub(bp_ref_center(scene, ray, sphere), ray->origin);
    const double a = length2(ray->direction), h = dot(ray->direction, oc);
    double root;
    if (starts_on(scene, ray, sphere)) {
        root = 2 * h / a;
    } else {
        const double r = sphere->radius;
        const double room = r * r - length2(sub(oc, scale(h / a, ray->direction)));
        if (room < 0) return false;
        const double half_chord = sqrt(room / a);
        root = h / a - half_chord;
        if (root <= 0) root = h / a + half_chord;
    }
    if (!(root > 0 && root < t_max)) return false;
    *t = root;
    return true;
}

/* A triangle by the three volumes that the ray spans with its sides (Pluecker), which all have one sign where
 * it passes between them. The origin may lie in the triangle's plane but for rounding, as it does of the one
 * that it was found on and of those beside that one: a plane that the ray starts from is not met again. */
static bool hit_triangle(const BpTriangle *triangle, const Ray *ray, double t_max, double *t) {
    if (ray->quits == triangle) return false;
    const Vec a = sub(vec(triangle->vertices[0]), ray->origin),
              b = sub(vec(triangle->vertices[1]), ray->origin),
              c = sub(vec(triangle->vertices[2]), ray->origin);
    const double u = dot(ray->direction, cross(c, b)), v = dot(ray->direction, cross(a, c)),
                 w = dot(ray->direction, cross(b, a));
    if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0))) return false;
    const Vec normal = cross(sub(b, a), sub(c, a));
    const double along = dot(ray->direction, normal), height = dot(a, normal);
    if (along == 0) return false;
    const double size = sqrt(length2(a)) + sqrt(length2(ray->origin));
    if (ray->quits != NULL && fabs(height) <= 16 * DBL_EPSILON * size * sqrt(length2(normal))) return false;
    if (!(height / along > 0 && height / along < t_max)) return false;
    *t = height / along;
    return true;
}

static void set_triangle_hit(const BpScene *scene, const Ray *ray, const BpTriangle *triangle, double t,
                             Hit *hit) {
    const Vec first = vec(triangle->vertices[0]);
    const Vec outward =
        unit(cross(sub(vec(triangle->vertices[1]), first), sub(vec(triangle->vertices[2]), first)));
    const Vec point = add(ray->origin, scale(t, ray->direction));
    hit->t = t;
    hit->sphere = NULL;
    hit->triangle = triangle;
    hit->capsule = NULL;
    hit->material = &scene->materials[triangle->material];
    /* Back onto the plane, off which rounding has moved it. */
    hit->point = sub(point, scale(dot(sub(point, first), outward), outward));
    hit->front_face = dot(ray->direction, outward) < 0;
    hit->radial = outward;
    hit->normal = hit->front_face ? outward : scale(-1, outward);
    hit->normal = bp_ref_shown_normal(scene, hit, unit(ray->direction), hit->normal);
}

static bool is_beyond(const BpCapsule *capsule, Vec point) {
    const Vec first = vec(capsule->ends[0]), axis = sub(vec(capsule->ends[1]), first);
    return 2 * dot(sub(point, first), axis) > length2(axis);
}

/* Where the ray's line is within a ball, from *from to *to; both stay where it is nowhere. Widens what is
 * there. */
static void widen_by_ball(const Ray *ray, Vec center, double radius, double *from, double *to) {
    const Vec oc = sub(center, ray->origin);
    const double a = length2(ray->direction), h = dot(ray->direction, oc) / a;
    const double room = radius * radius - length2(sub(oc, scale(h, ray->direction)));
    if (room < 0) return;
    *from = fmin(*from, h - sqrt(room / a));
    *to = fmax(*to, h + sqrt(room / a));
}

/* The same of a cylinder without ends: between its wall and the planes through the ends of its axis. */
static void widen_by_cylinder(const Ray *ray, const BpCapsule *capsule, double *from, double *to) {
    const Vec first = vec(capsule->ends[0]), axis = sub(vec(capsule->ends[1]), first);
    const double length = sqrt(length2(axis));
    if (length == 0) return;
    const Vec up = scale(1 / length, axis), oc = sub(first, ray->origin);
    const Vec across = cross(ray->direction, up), aside = cross(oc, up);
    const double a = length2(across), climb = dot(ray->direction, up), height = -dot(oc, up);
    double begin = -INFINITY, end = INFINITY;
    if (a > 0) {
        /* The line's distance from the axis is constant along it, so nothing large cancels. */
        const double apart = dot(oc, cross(ray->direction, up)) / sqrt(a);
        const double room = capsule->radius * capsule->radius - apart * apart;
        if (room < 0) return;
        begin = (dot(across, aside) - sqrt(room * a)) / a;
        end = (dot(across, aside) + sqrt(room * a)) / a;
    } else if (length2(aside) > capsule->radius * capsule->radius) {
        return;
    }
    if (climb != 0) {
        const double low = -height / climb, high = (length - height) / climb;
        begin = fmax(begin, fmin(low, high));
        end = fmin(end, fmax(low, high));
    } else if (height < 0 || height > length) {
        return;
    }
    if (begin > end) return;
    *from = fmin(*from, begin);
    *to = fmax(*to, end);
}

/* A capsule is the union of a cylinder and two balls, and convex, so where a line is in it is one stretch. A
 * ray that starts on it ends at the other end of the stretch, if it goes inward. */
static bool hit_capsule(const BpCapsule *capsule, const Ray *ray, double t_max, double *t) {
    double from = INFINITY, to = -INFINITY;
    for (int k = 0; k < 2; ++k) widen_by_ball(ray, vec(capsule->ends[k]), capsule->radius, &from, &to);
    widen_by_cylinder(ray, capsule, &from, &to);
    if (from > to) return false;
    double root = from > 0 ? from : to;
    if (ray->parts == capsule) {
        if (dot(ray->direction, bp_ref_from_axis(capsule, ray->origin)) >= 0) return false;
        root = to;
    }
    if (!(root > 0 && root < t_max)) return false;
    *t = root;
    return true;
}

static void set_capsule_hit(const BpScene *scene, const Ray *ray, const BpCapsule *capsule, double t,
                            Hit *hit) {
    const Vec point = add(ray->origin, scale(t, ray->direction)), away = bp_ref_from_axis(capsule, point);
    const Vec outward = unit(away);
    hit->t = t;
    hit->sphere = NULL;
    hit->triangle = NULL;
    hit->capsule = capsule;
    hit->beyond = is_beyond(capsule, point);
    hit->material = &scene->materials[capsule->material];
    hit->point = add(sub(point, away), scale(capsule->radius, outward));
    hit->front_face = dot(ray->direction, outward) < 0;
    hit->radial = outward;
    hit->normal = hit->front_face ? outward : scale(-1, outward);
}

bool bp_ref_hit(const BpScene *scene, const Ray *ray, Hit *hit) {
    double closest = INFINITY;
    const BpCapsule *capsule = NULL;
    const BpSphere *sphere = NULL;
    const BpTriangle *triangle = NULL;
    for (size_t i = 0; i < scene->sphere_count; ++i)
        if (hit_sphere(scene, &scene->spheres[i], ray, closest, &closest)) sphere = &scene->spheres[i];
    for (size_t i = 0; i < scene->triangle_count; ++i)
        if (hit_triangle(&scene->triangles[i], ray, closest, &closest)) triangle = &scene->triangles[i];
    for (size_t i = 0; i < scene->capsule_count; ++i)
        if (hit_capsule(&scene->capsules[i], ray, closest, &closest)) capsule = &scene->capsules[i];
    if (capsule != NULL) {
        set_capsule_hit(scene, ray, capsule, closest, hit);
        return true;
    }
    if (triangle != NULL) {
        set_triangle_hit(scene, ray, triangle, closest, hit);
        return true;
    }
    if (sphere == NULL) return false;

    hit->t = closest;
    hit->sphere = sphere;
    hit->triangle = NULL;
    hit->capsule = NULL;
    hit->material = &scene->materials[sphere->material];
    const Vec point = add(ray->origin, scale(closest, ray->direction)),
              center = bp_ref_center(scene, ray, sphere);
    /* unit() removes the error that rounding left in the radius, so that the point lies on the sphere. */
    const Vec radial = unit(sub(point, center));
    hit->point = add(center, scale(fabs(sphere->radius), radial));
    const Vec outward = sphere->radius < 0 ? scale(-1, radial) : radial;
    hit->front_face = dot(ray->direction, outward) < 0;
    hit->radial = radial;
    hit->normal = hit->front_face ? outward : scale(-1, outward);
    return true;
}

/* What stops the ray: each surface does by chance, and else the ray begins anew there. */
typedef struct Sight {
    bool meets;
    Hit hit; /* t: from where the ray began */
} Sight;

static Sight look(const BpScene *scene, const Ray *ray, Random *random) {
    Sight sight;
    Ray rest = *ray;
    double behind = 0;
    while ((sight.meets = bp_ref_hit(scene, &rest, &sight.hit))) {
        const Hit *hit = &sight.hit;
        const double opacity = hit->material->opacity > 0 ? hit->material->opacity : 1; /* 0: not said */
        if (opacity >= 1 || random_real(random) < opacity) break;
        behind += hit->t;
        rest = (Ray){hit->point, ray->direction, hit->sphere, ray->time, false, hit->triangle, hit->capsule};
    }
    sight.hit.t = sight.meets ? behind + sight.hit.t : INFINITY;
    return sight;
}

static Vec mixed(const double bottom[3], const double top[3], double a) {
    return add(scale(1 - a, vec(bottom)), scale(a, vec(top)));
}

static bool in_disc(const BpDisc *disc, Vec direction) {
    const Vec middle = vec(disc->direction);
    const double angle = atan2(sqrt(length2(cross(middle, direction))), dot(middle, direction));
    return angle * (180 / PI) <= disc->half_angle_degrees;
}

static Vec gradient(const BpScene *scene, Vec direction) {
    const Vec own = vec(scene->background_up);
    const Vec up = length2(own) > 0 ? unit(own) : (Vec){0, 1, 0};
    const double a = fmin(fmax(0.5 * (dot(unit(direction), up) + 1), 0), 1);
    return mixed(scene->background_bottom, scene->background_top, a);
}

static Vec background(const BpScene *scene, const Ray *ray) {
    Vec color = gradient(scene, ray->direction);
    if (scene->environment != NULL) color = bp_ref_environment(scene, ray->direction);
    for (size_t i = 0; i < scene->disc_count; ++i) {
        const BpDisc *disc = &scene->discs[i];
        const bool from_camera =
            ray->leaves == NULL && ray->quits == NULL && ray->parts == NULL && !ray->scattered;
        if ((disc->visible_to_camera || !from_camera) && in_disc(disc, ray->direction))
            color = add(color, vec(disc->radiance));
    }
    return color;
}

static double luminance(Vec color) {
    return 0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z;
}

/* A unit direction at `cosine` from a unit axis. */
static Vec around(Vec axis, double cosine, double turn) {
    const Vec aside = fabs(axis.x) < 0.5 ? (Vec){1, 0, 0} : (Vec){0, 1, 0};
    const Vec one = unit(cross(axis, aside)), other = cross(axis, one);
    const double sine = sqrt(fmax(0, 1 - cosine * cosine));
    return add(scale(cosine, axis), scale(sine, add(scale(cos(turn), one), scale(sin(turn), other))));
}

/* Whether light is kept from a point of the shadow catcher: a direction of the hemisphere above it, drawn
 * with a density proportional to the light that would come from there times the cosine. First a part of the
 * light, the gradient or a disc, by the most that it could bring; then a direction, uniform over that part;
 * by its share of that most it is taken, else all begins anew. */
static bool is_dark(const BpScene *scene, Vec point, double time, Random *random) {
    enum { TRIES = 10000 };
    const Vec normal = vec(scene->shadow_catcher.normal);
    const double brightest =
        fmax(luminance(vec(scene->background_bottom)), luminance(vec(scene->background_top)));
    double most[BP_DISCS_MAX + 1] = {2 * PI * brightest}, sum = most[0];
    for (size_t i = 0; i < scene->disc_count; ++i) {
        const BpDisc *disc = &scene->discs[i];
        const double half = disc->half_angle_degrees * (PI / 180);
        const bool rises = dot(unit(vec(disc->direction)), normal) > -sin(half);
        most[i + 1] = rises ? 2 * PI * (1 - cos(half)) * luminance(vec(disc->radiance)) : 0;
        sum += most[i + 1];
    }
    Ray ray = {.origin = point, .time = time, .scattered = true};
    for (int i = 0; i < TRIES && sum > 0; ++i) {
        double part = random_real(random) * sum, share = 0;
        size_t disc = 0; /* 0: the gradient */
        while (disc < scene->disc_count && part >= most[disc]) part -= most[disc++];
        const double turn = 2 * PI * random_real(random), u = random_real(random);
        if (disc == 0) {
            ray.direction = around(normal, u, turn);
            share = luminance(gradient(scene, ray.direction)) / brightest;
        } else {
            const BpDisc *chosen = &scene->discs[disc - 1];
            const double cap = 1 - cos(chosen->half_angle_degrees * (PI / 180));
            ray.direction = around(unit(vec(chosen->direction)), 1 - u * cap, turn);
            share = 1;
        }
        if (random_real(random) < share * dot(ray.direction, normal)) return look(scene, &ray, random).meets;
    }
    return false;
}

/* Whether the ray meets the upper side of the shadow catcher before any sphere. */
static bool meets_catcher(const BpScene *scene, const Ray *ray, const Sight *sight, double *t) {
    if (!scene->shadow_catcher.present) return false;
    const Vec normal = vec(scene->shadow_catcher.normal);
    const double above = dot(normal, ray->origin) - scene->shadow_catcher.distance;
    const double down = -dot(normal, ray->direction);
    if (!(above > 0 && down > 0)) return false;
    *t = above / down;
    return *t <= sight->hit.t;
}

static Vec color_of(const BpScene *scene, const Ray *ray, const Sight *sight, uint32_t depth, Random *random,
                    Path *path);

Vec bp_ref_camera_color(const BpScene *scene, const Ray *ray, double height, uint32_t depth, Random *random,
                        Path *path) {
    const Vec black = {0, 0, 0};
    double t;
    if (depth == 0) return bp_ref_color(scene, ray, depth, random, path);
    const Sight sight = look(scene, ray, random);
    if (meets_catcher(scene, ray, &sight, &t)) {
        Ray scattered;
        Vec left;
        ++path->segments;
        if (bp_ref_fly(scene, ray, t, random, path, &scattered, &left))
            return mul(left, bp_ref_color(scene, &scattered, depth - 1, random, path));
        if (is_dark(scene, add(ray->origin, scale(t, ray->direction)), ray->time, random)) return black;
        if (scene->backdrop == BP_BACKDROP_SKY) return mul(left, background(scene, ray));
        return scene->backdrop == BP_BACKDROP_NONE
                   ? black
                   : mul(left, mixed(scene->backdrop_bottom, scene->backdrop_top, height));
    }
    if (scene->backdrop != BP_BACKDROP_SKY && !sight.meets) {
        Ray scattered;
        Vec left;
        ++path->segments;
        if (bp_ref_fly(scene, ray, INFINITY, random, path, &scattered, &left))
            return mul(left, bp_ref_color(scene, &scattered, depth - 1, random, path));
        return scene->backdrop == BP_BACKDROP_NONE
                   ? black
                   : mul(left, mixed(scene->backdrop_bottom, scene->backdrop_top, height));
    }
    return color_of(scene, ray, &sight, depth, random, path);
}

Vec bp_ref_color(const BpScene *scene, const Ray *ray, uint32_t depth, Random *random, Path *path) {
    const Vec black = {0, 0, 0};
    if (depth == 0) {
        path->cut = true;
        return black;
    }
    const Sight sight = look(scene, ray, random);
    return color_of(scene, ray, &sight, depth, random, path);
}

/* The radiance along a ray, from what it meets. */
static Vec color_of(const BpScene *scene, const Ray *ray, const Sight *sight, uint32_t depth, Random *random,
                    Path *path) {
    const Hit *hit = &sight->hit;
    Ray flown;
    Vec left;
    ++path->segments;
    if (bp_ref_fly(scene, ray, hit->t, random, path, &flown, &left))
        return mul(left, bp_ref_color(scene, &flown, depth - 1, random, path));
    if (!sight->meets) return mul(left, background(scene, ray));

    Vec emitted = bp_ref_varied(scene, hit, BP_MEMBER_EMIT, hit->material->emit);
    if (hit->material->kind == BP_MATERIAL_NORMALS)
        emitted = add(emitted, scale(0.5, add(hit->normal, (Vec){1, 1, 1})));
    Vec direction, attenuation;
    if (!bp_ref_scatter(scene, ray, hit, random, &direction, &attenuation)) return mul(left, emitted);
    direction = bp_ref_folded(hit, direction);
    const Ray scattered = {hit->point, direction, hit->sphere, ray->time, false, hit->triangle, hit->capsule};
    const Vec onward = mul(attenuation, bp_ref_color(scene, &scattered, depth - 1, random, path));
    return mul(left, add(emitted, onward));
}
