/* book_scalar.c: the book's algorithm as its readers write it, in scalar C and double: the yardstick.
 *
 * In:    a scene file.   Out: one line of JSON (peer.h).
 * Knows: the fourth edition (Shirley, Black and Hollasch, 2024): a list of spheres tried one by one (--method
 *        list), or the second book's binary tree with a median split along the longest axis (--method tree);
 *        recursive ray_color, rejection sampling.
 * Does not know: float, vectors, wide trees, ballpark's kernels.
 *
 * Three things are kinder than the book's C++: a fast random generator, threads over rows, and T_MIN. */
#include "../host/base/clock.h"
#include "book_tree.h"
#include "peer.h"

#include <math.h>
#include <string.h>

/* The shortest distance that counts as a hit. The book has 0.001, which lets paths slip into small spheres
 * that overlap, where they are lost; in double this is far enough, and costs the same. */
#define T_MIN 1e-6

typedef struct Vec {
    double x, y, z;
} Vec;

typedef struct Ray {
    Vec origin, direction;
} Ray;

typedef struct Hit {
    double t;
    Vec point, normal; /* unit, facing the ray */
    bool front;
    const BpSphere *sphere;
} Hit;

typedef struct Job {
    const BpScene *scene;
    const BookNode *root; /* NULL: the list */
    PeerCamera camera;
    PeerFilm film;
    uint64_t seed;
} Job;

typedef struct Walk {
    const Job *job;
    uint64_t random;
    uint64_t rays;
} Walk;

static Vec vec(const double v[3]) {
    return (Vec){v[0], v[1], v[2]};
}
static Vec add(Vec a, Vec b) {
    return (Vec){a.x + b.x, a.y + b.y, a.z + b.z};
}
static Vec sub(Vec a, Vec b) {
    return (Vec){a.x - b.x, a.y - b.y, a.z - b.z};
}
static Vec scale(double s, Vec a) {
    return (Vec){s * a.x, s * a.y, s * a.z};
}
static Vec mul(Vec a, Vec b) {
    return (Vec){a.x * b.x, a.y * b.y, a.z * b.z};
}
static double dot(Vec a, Vec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static Vec unit(Vec a) {
    return scale(1 / sqrt(dot(a, a)), a);
}

/* SplitMix64 (Steele, Lea and Flood 2014). */
static double uniform(Walk *walk) {
    uint64_t z = walk->random += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static Vec random_in_ball(Walk *walk) {
    for (;;) {
        const Vec p = {2 * uniform(walk) - 1, 2 * uniform(walk) - 1, 2 * uniform(walk) - 1};
        const double square = dot(p, p);
        if (square < 1 && square > 1e-160) return p;
    }
}

static Vec random_unit_vector(Walk *walk) {
    return unit(random_in_ball(walk));
}

/* ---- hits ---- */

static bool hit_sphere(const BpSphere *sphere, const Ray *ray, double t_min, double t_max, Hit *hit) {
    const Vec oc = sub(vec(sphere->center), ray->origin);
    const double a = dot(ray->direction, ray->direction);
    const double h = dot(ray->direction, oc);
    const double c = dot(oc, oc) - sphere->radius * sphere->radius;
    const double discriminant = h * h - a * c;
    if (discriminant < 0) return false;
    const double root = sqrt(discriminant);
    double t = (h - root) / a;
    if (t <= t_min || t_max <= t) {
        t = (h + root) / a;
        if (t <= t_min || t_max <= t) return false;
    }
    hit->t = t;
    hit->sphere = sphere;
    hit->point = add(ray->origin, scale(t, ray->direction));
    const Vec outward = scale(1 / sphere->radius, sub(hit->point, vec(sphere->center)));
    hit->front = dot(ray->direction, outward) < 0;
    hit->normal = hit->front ? outward : scale(-1, outward);
    return true;
}

static bool hit_list(const BpScene *scene, const Ray *ray, double t_max, Hit *hit) {
    bool any = false;
    for (size_t i = 0; i < scene->sphere_count; i++) {
        if (hit_sphere(&scene->spheres[i], ray, T_MIN, t_max, hit)) {
            any = true;
            t_max = hit->t;
        }
    }
    return any;
}

static bool hit_box(const BookBox *box, const Ray *ray, double t_min, double t_max) {
    const double origin[3] = {ray->origin.x, ray->origin.y, ray->origin.z};
    const double direction[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
    for (int axis = 0; axis < 3; axis++) {
        const double inverse = 1 / direction[axis];
        const double t0 = (box->low[axis] - origin[axis]) * inverse;
        const double t1 = (box->high[axis] - origin[axis]) * inverse;
        if (t0 < t1) {
            if (t0 > t_min) t_min = t0;
            if (t1 < t_max) t_max = t1;
        } else {
            if (t1 > t_min) t_min = t1;
            if (t0 < t_max) t_max = t0;
        }
        if (t_max <= t_min) return false;
    }
    return true;
}

static bool hit_node(const BookNode *node, const Ray *ray, double t_max, Hit *hit) {
    if (node->sphere != NULL) return hit_sphere(node->sphere, ray, T_MIN, t_max, hit);
    if (!hit_box(&node->box, ray, T_MIN, t_max)) return false;
    const bool left = hit_node(node->left, ray, t_max, hit);
    const bool right = hit_node(node->right, ray, left ? hit->t : t_max, hit);
    return left || right;
}

static bool hit_world(Walk *walk, const Ray *ray, Hit *hit) {
    walk->rays++;
    const Job *job = walk->job;
    if (job->root != NULL) return hit_node(job->root, ray, INFINITY, hit);
    return hit_list(job->scene, ray, INFINITY, hit);
}

/* ---- materials ---- */

static Vec reflect(Vec v, Vec n) {
    return sub(v, scale(2 * dot(v, n), n));
}

static Vec refract(Vec v, Vec n, double ratio, double cosine) {
    const Vec perpendicular = scale(ratio, add(v, scale(cosine, n)));
    const double parallel = -sqrt(fabs(1 - dot(perpendicular, perpendicular)));
    return add(perpendicular, scale(parallel, n));
}

static double reflectance(BpFresnel fresnel, double cosine, double ratio) {
    if (fresnel == BP_FRESNEL_NONE) return 0;
    if (fresnel == BP_FRESNEL_SCHLICK) { /* Schlick 1994 */
        const double root = (1 - ratio) / (1 + ratio), r0 = root * root;
        return r0 + (1 - r0) * pow(1 - cosine, 5);
    }
    const double transmitted = sqrt(fmax(0, 1 - ratio * ratio * (1 - cosine * cosine)));
    const double across = (ratio * cosine - transmitted) / (ratio * cosine + transmitted);
    const double along = (cosine - ratio * transmitted) / (cosine + ratio * transmitted);
    return 0.5 * (across * across + along * along);
}

static Vec diffuse_direction(Walk *walk, BpScatter scatter, Vec normal) {
    if (scatter == BP_SCATTER_COSINE_CUBED) return add(normal, random_in_ball(walk));
    const Vec random = random_unit_vector(walk);
    if (scatter == BP_SCATTER_HEMISPHERE) return dot(random, normal) > 0 ? random : scale(-1, random);
    const Vec direction = add(normal, random);
    return dot(direction, direction) < 1e-16 ? normal : direction;
}

/* False when the ray is absorbed. */
static bool scatter(Walk *walk, const BpMaterial *material, const Ray *ray, const Hit *hit, Vec *direction,
                    Vec *attenuation) {
    const BpSphere *sphere = hit->sphere;
    *attenuation = vec(material->albedo);
    if (sphere->albedo != BP_NO_ALBEDO) {
        const float *albedo = walk->job->scene->albedos[sphere->albedo];
        *attenuation = (Vec){(double)albedo[0], (double)albedo[1], (double)albedo[2]};
    }
    switch (material->kind) {
    case BP_MATERIAL_LAMBERTIAN:
        *direction = diffuse_direction(walk, material->scatter, hit->normal);
        return true;
    case BP_MATERIAL_METAL: {
        const Vec random =
            material->fuzz_shape == BP_FUZZ_BALL ? random_in_ball(walk) : random_unit_vector(walk);
        *direction = add(unit(reflect(ray->direction, hit->normal)), scale(material->fuzz, random));
        return dot(*direction, hit->normal) > 0;
    }
    case BP_MATERIAL_DIELECTRIC: {
        *attenuation = (Vec){1, 1, 1};
        /* A negative radius has already turned the outward normal, and with it `front`. */
        const double ratio = hit->front ? 1 / material->refraction_index : material->refraction_index;
        const Vec in = unit(ray->direction);
        const double cosine = fmin(-dot(in, hit->normal), 1), sine = sqrt(1 - cosine * cosine);
        bool mirror = false;
        if (ratio * sine > 1 && material->total_reflection != BP_TOTAL_REFRACT) {
            if (material->total_reflection == BP_TOTAL_ABSORB) return false;
            mirror = true;
        } else if (material->fresnel != BP_FRESNEL_NONE) {
            mirror = reflectance(material->fresnel, cosine, ratio) > uniform(walk);
        }
        *direction = mirror ? reflect(in, hit->normal) : refract(in, hit->normal, ratio, cosine);
        return true;
    }
    case BP_MATERIAL_DIFFUSE_LIGHT:
    case BP_MATERIAL_NORMALS:
    case BP_MATERIAL_INTERFACE:
    case BP_MATERIAL_OREN_NAYAR: /* not drawn by this peer, like the next three */
    case BP_MATERIAL_ROUGH_METAL:
    case BP_MATERIAL_GLOSSY:
    case BP_MATERIAL_ROUGH_DIELECTRIC:
        break;
    }
    return false;
}

static Vec ray_color(Walk *walk, const Ray *ray, uint32_t depth) {
    const BpScene *scene = walk->job->scene;
    if (depth == 0) return (Vec){0, 0, 0};
    Hit hit;
    if (!hit_world(walk, ray, &hit)) {
        const double a = 0.5 * (unit(ray->direction).y + 1);
        return add(scale(1 - a, vec(scene->background_bottom)), scale(a, vec(scene->background_top)));
    }
    const BpMaterial *material = &scene->materials[hit.sphere->material];
    Vec radiance = vec(material->emit);
    if (material->kind == BP_MATERIAL_NORMALS)
        return add(radiance, scale(0.5, add(hit.normal, (Vec){1, 1, 1})));
    Vec direction, attenuation;
    if (scatter(walk, material, ray, &hit, &direction, &attenuation)) {
        const Ray scattered = {hit.point, direction};
        radiance = add(radiance, mul(attenuation, ray_color(walk, &scattered, depth - 1)));
    }
    return radiance;
}

/* ---- the picture ---- */

static Ray camera_ray(Walk *walk, uint32_t column, uint32_t row) {
    const PeerCamera *camera = &walk->job->camera;
    const double x = column + (camera->center ? 0.5 : uniform(walk));
    const double y = row + (camera->center ? 0.5 : uniform(walk));
    const Vec target =
        add(vec(camera->corner), add(scale(x, vec(camera->right)), scale(y, vec(camera->down))));
    Vec lens = {0, 0, 0};
    while (camera->lens) { /* rejection in the unit disk */
        const double u = 2 * uniform(walk) - 1, v = 2 * uniform(walk) - 1;
        if (u * u + v * v >= 1) continue;
        lens = add(scale(u, vec(camera->lens_right)), scale(v, vec(camera->lens_up)));
        break;
    }
    return (Ray){add(vec(camera->origin), lens), sub(target, lens)};
}

static uint64_t trace_row(void *argument, unsigned thread, uint32_t row) {
    const Job *job = argument;
    (void)thread;
    Walk walk = {.job = job, .random = job->seed + ((uint64_t)row << 40)};
    const PeerFilm *film = &job->film;
    for (uint32_t column = 0; column < film->width; column++) {
        const size_t at = ((size_t)row * film->width + column) * 3;
        for (uint32_t sample = 0; sample < film->samples; sample++) {
            const Ray ray = camera_ray(&walk, column, row);
            const Vec radiance = ray_color(&walk, &ray, job->scene->camera.max_depth);
            double *sum = film->half[sample & 1] + at;
            sum[0] += radiance.x;
            sum[1] += radiance.y;
            sum[2] += radiance.z;
        }
    }
    return walk.rays;
}

int main(int argc, char **argv) {
    PeerOptions options;
    PeerRun run;
    peer_options(argc, argv, "tree|list", &options);
    if (options.method == NULL) options.method = "tree";
    BpScene *scene = peer_load(&options, false, &run);
    Job job = {.scene = scene, .film = peer_film(scene), .seed = options.seed};
    peer_camera(scene, &job.camera);

    const size_t count = scene->sphere_count;
    if (strcmp(options.method, "tree") == 0 && count > 0) {
        const double start = bp_clock_seconds();
        job.root = book_tree_build(scene);
        run.build_seconds = bp_clock_seconds() - start;
        run.structure_bytes = (uint64_t)(2 * count) * sizeof(BookNode);
    }
    peer_trace(scene, options.threads, trace_row, &job, &run);
    peer_report("book", &options, scene, &job.film, &run);
    return 0;
}
