/* trace.h: one path through a scene, in double, as the book writes it.
 *
 * In:    Scene, a ray, random numbers.   Out: radiance.
 * Knows: Scene.                          Does not know: packed data, kernels, pictures, threads. */
#ifndef BP_REFERENCE_TRACE_H
#define BP_REFERENCE_TRACE_H

#include "scene/scene.h"
#include "vec.h"

typedef struct Ray {
    Vec origin, direction;   /* the direction need not be of unit length */
    const BpSphere *leaves;  /* the sphere whose surface the origin lies on, or NULL */
    double time;             /* 0 when the shutter opens, 1 when it closes */
    bool scattered;          /* it begins where a medium scattered it */
    const BpTriangle *quits; /* the triangle that the origin lies on, or NULL */
    const BpCapsule *parts;  /* the capsule that it lies on, or NULL */
} Ray;

typedef struct Hit {
    double t; /* in lengths of the ray's direction */
    Vec point;
    Vec radial;             /* unit length, away from the centre; of a triangle to its outside */
    Vec normal;             /* unit length, faces the ray; of a smooth triangle what it shows (smooth.c) */
    bool front_face;        /* the ray comes from the side that the outward normal points to */
    const BpSphere *sphere; /* or NULL */
    const BpTriangle *triangle; /* or NULL */
    const BpCapsule *capsule;   /* or NULL */
    bool beyond;                /* of a capsule: its second end is the closer one */
    const BpMaterial *material;
} Hit;

typedef struct Path {
    uint64_t segments; /* ray segments traced */
    bool cut;          /* the depth limit ended it */
    bool flies; /* through a medium, by a colour; likelihood: of its flights by each, over their mean */
    int color;
    double likelihood[3];
} Path;

/* The camera of the fourth edition, prepared for a scene. */
typedef struct Camera {
    Vec origin, first_pixel, pixel_right, pixel_down, lens_right, lens_up;
    uint32_t rows;
    Vec ahead; /* to the plane in focus */
    bool lens, center, orthographic;
} Camera;
Camera bp_ref_camera(const BpCamera *camera);
/* `height`: where the ray stands in the picture, from 0 at its lower edge to 1 at the upper. */
Ray bp_ref_camera_ray(const Camera *camera, uint32_t column, uint32_t row, Random *random, double *height);

/* The nearest hit with t > 0; of equal ones spheres before triangles, these before capsules, and what stands
 * first. */
bool bp_ref_hit(const BpScene *scene, const Ray *ray, Hit *hit);

/* The normal that a smooth triangle shows to a ray from `incoming`, a unit direction, at a point of it, where
 * the one of its plane is `face`, on the ray's side; `face` of others. And where a direction that was
 * scattered about it goes. */
Vec bp_ref_shown_normal(const BpScene *scene, const Hit *hit, Vec incoming, Vec face);
Vec bp_ref_folded(const Hit *hit, Vec direction);

/* The direction a material sends the ray on to, and what it leaves of the light; false: absorbed. */
bool bp_ref_scatter(const BpScene *scene, const Ray *ray, const Hit *hit, Random *random, Vec *direction,
                    Vec *attenuation);

/* Oren and Nayar's model in the form of Portsmouth, Kutz and Hill (JCGT 14(1), 2025): the values (a BSDF's,
 * per steradian, for unit directions away from the surface) of what a white surface scatters once and more
 * than once; the share that is scattered once, at this cosine of `out`; what an albedo makes of the rest. */
double bp_ref_oren_nayar_once(double roughness, Vec normal, Vec out, Vec in);
double bp_ref_oren_nayar_again(double roughness, Vec normal, Vec out, Vec in);
double bp_ref_oren_nayar_share(double roughness, double cosine);
double bp_ref_oren_nayar_colour(double roughness, double albedo);
/* Returns what is left of the light; `incoming`: a unit direction towards the surface. */
Vec bp_ref_scatter_oren_nayar(double roughness, Vec albedo, Vec normal, Vec incoming, Random *random,
                              Vec *direction);

/* Metal of GGX facets (Walter et al., 2007; heights as Heitz, 2014, equation 99), alpha = roughness^2: its
 * value, of a white surface; a direction, and *weight times what is left. False: absorbed. */
double bp_ref_rough_metal(double roughness, Vec normal, Vec out, Vec in);
/* A matte surface under a coat: the values of its two parts, over the albedo for none of them. */
double bp_ref_coat_reflects(double index);
double bp_ref_glossy_coat(double roughness, double index, Vec normal, Vec out, Vec in);
double bp_ref_glossy_base(double albedo, double index, Vec normal, Vec out, Vec in);
bool bp_ref_scatter_glossy(double roughness, double index, Vec albedo, Vec normal, Vec incoming,
                           Random *random, Vec *direction, Vec *weight);
/* Glass of such facets (Walter et al., 2007, equations 20 and 21), `ratio` the index on the normal's side
 * over that of the other: its value for radiance over the squared index; `in` on either side. A direction,
 * and *weight times what is left. */
double bp_ref_rough_dielectric(double roughness, double ratio, Vec normal, Vec out, Vec in);
bool bp_ref_scatter_rough_dielectric(double roughness, double ratio, Vec normal, Vec incoming, Random *random,
                                     Vec *direction, Vec *weight);
bool bp_ref_scatter_rough_metal(double roughness, Vec normal, Vec incoming, Random *random, Vec *direction,
                                Vec *weight);

/* Radiance along a camera ray: the backdrop at that height of the picture where it meets nothing. */
Vec bp_ref_camera_color(const BpScene *scene, const Ray *ray, double height, uint32_t depth, Random *random,
                        Path *path);

/* A flight through the medium around the ray's origin, `distance` (in lengths of the direction, INFINITY for
 * no end) to the next surface: true if the medium scatters it before, into *scattered. *weight: what is left.
 */
bool bp_ref_fly(const BpScene *scene, const Ray *ray, double distance, Random *random, Path *path,
                Ray *scattered, Vec *weight);

/* To a point, from the point of a capsule's axis that is closest. */
static inline Vec bp_ref_from_axis(const BpCapsule *capsule, Vec point) {
    const Vec first = vec(capsule->ends[0]), axis = sub(vec(capsule->ends[1]), first),
              way = sub(point, first);
    const double square = length2(axis);
    const double place = square > 0 ? fmin(1, fmax(0, dot(way, axis) / square)) : 0;
    return sub(way, scale(place, axis));
}

/* The centre of the sphere at the ray's time. */
static inline Vec bp_ref_center(const BpScene *scene, const Ray *ray, const BpSphere *sphere) {
    const size_t i = (size_t)(sphere - scene->spheres);
    const Vec first = vec(sphere->center);
    if (i >= scene->moving_count) return first;
    return add(scale(1 - ray->time, first), scale(ray->time, vec(scene->center_ends[i])));
}

/* Radiance along the ray. `depth`: segments still allowed; 0 is black. */
Vec bp_ref_color(const BpScene *scene, const Ray *ray, uint32_t depth, Random *random, Path *path);

/* The value of a member of the material at a hit: its texture's value, or `constant` where it has none. */
Vec bp_ref_varied(const BpScene *scene, const Hit *hit, BpMember member, const double constant[3]);

/* The radiance of an image around the scene in a direction of any length. */
Vec bp_ref_environment(const BpScene *scene, Vec direction);

/* Reflectance, `ratio` = index on the ray's side over index beyond, `cosine` of the incident angle. Schlick's
 * form (1994, eq. 15) as the third and fourth editions use it; exact, unpolarised (Fresnel's equations). */
double bp_ref_schlick(double cosine, double ratio);
double bp_ref_fresnel(double cosine, double ratio);

#endif
