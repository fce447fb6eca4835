/* pilot_lobes.c: see pilot_lobes.h. */
#include "pilot_lobes.h"

#include "base/color.h"
#include "pilot_shapes.h"
#include "scene/vector.h"

#include <math.h>

#define PI 3.14159265358979323846

double bp_pilot_solid_angle(const BpScene *scene, const BpPilotLight *light, const double point[3]) {
    if (light->distant) return 2 * PI * light->cap;
    const double away2 = bp_distance2(light->place, point), sine2 = light->radius * light->radius / away2;
    if (!bp_pilot_is_triangle(scene, light->shape))
        return sine2 < 1 ? 2 * PI * sine2 / (1 + sqrt(1 - sine2)) : 4 * PI;
    double normal[3], cosine = 0;
    bp_pilot_area(bp_pilot_triangle(scene, light->shape), normal);
    for (int a = 0; a < 3; ++a) cosine += normal[a] * (light->place[a] - point[a]);
    return fmin(PI * sine2 * fabs(cosine) / sqrt(away2), 2 * PI);
}

/* ---- densities, as the files of kernels/bsdf explain them ---- */

double bp_pilot_reflectance(double c, double n) {
    const double t2 = 1 - (1 - c * c) / (n * n), t = sqrt(fmax(t2, 0));
    const double across = (c - n * t) / (c + n * t), along = (n * c - t) / (n * c + t);
    return 0.5 * (across * across + along * along);
}

/* Around a mirror direction, as kernels/bsdf/metal.cl explains. */
static double metal_density(const BpMaterial *material, double cosine) {
    const double f = material->fuzz, sine2 = fmax(0, 1 - cosine * cosine), h2 = f * f - sine2;
    if (!(h2 > 0) || cosine <= 0) return 0;
    const double h = sqrt(h2);
    if (material->fuzz_shape == BP_FUZZ_BALL) return h * (3 * cosine * cosine + h2) / (2 * PI * f * f * f);
    return (cosine * cosine + h2) / (2 * PI * f * h);
}

double bp_pilot_density(const BpMaterial *material, const double axis[3], const double direction[3]) {
    const double cosine = bp_dot(axis, direction);
    if (material->kind == BP_MATERIAL_METAL) return metal_density(material, cosine);
    /* What is glossy counts as its base, by the cosine: its coat is a part of its own, which few paths draw.
     */
    if (cosine <= 0) return 0;
    if (material->scatter == BP_SCATTER_COSINE_CUBED) return 2 * cosine * cosine * cosine / PI;
    return material->scatter == BP_SCATTER_HEMISPHERE ? 1 / (2 * PI) : cosine / PI;
}

static double fuzz_density(const BpMaterial *material, const BpPilotTurn *turn) {
    double mirrored[3];
    const double up = bp_dot(turn->leaves, turn->normal);
    for (int a = 0; a < 3; ++a) mirrored[a] = 2 * up * turn->normal[a] - turn->leaves[a];
    return bp_pilot_density(material, mirrored, turn->to_light);
}

/* Of facets that reflect, or, if the light is below the surface, refract. */
static double facet_density(const BpMaterial *material, const BpPilotTurn *turn) {
    const double alpha = pow(fmax(material->roughness, BP_LIT_ROUGHNESS_MIN), 2);
    const bool below = bp_dot(turn->to_light, turn->normal) < 0;
    const double n = below ? turn->index : 1, co = bp_dot(turn->leaves, turn->normal);
    double facet[3];
    for (int a = 0; a < 3; ++a) facet[a] = turn->leaves[a] + n * turn->to_light[a];
    const double length = bp_normalize(facet);
    const double side = bp_dot(facet, turn->normal) < 0 ? -1 : 1;
    for (int a = 0; a < 3; ++a) facet[a] *= side;
    const double up = bp_dot(facet, turn->normal), c = bp_dot(facet, turn->leaves);
    const double d = bp_dot(facet, turn->to_light);
    if (!(length > 0 && co > 0 && c > 0) || (below ? d >= 0 : d <= 0)) return 0;
    const double spread = alpha * alpha * up * up + 1 - up * up;
    const double root = sqrt(alpha * alpha * (1 - co * co) + co * co);
    const double density = alpha * alpha / (2 * PI * spread * spread * (co + root));
    if (material->kind != BP_MATERIAL_ROUGH_DIELECTRIC) return density;
    const double reflected = bp_pilot_reflectance(fmin(c, 1), turn->index);
    return density * (below ? (1 - reflected) * -4 * n * n * c * d / (length * length) : reflected);
}

double bp_pilot_lobe_density(const BpMaterial *material, const BpPilotTurn *turn) {
    return material->kind == BP_MATERIAL_METAL ? fuzz_density(material, turn) : facet_density(material, turn);
}

/* ---- what a path finds ---- */

/* A light's share in the choice of one: by the irradiance, and only those that the cone of fuzzy metal
 * touches. */
static double importance(const BpScene *scene, const BpPilotLight *light, const BpMaterial *material,
                         const BpPilotTurn *turn) {
    double to[3], mirrored[3];
    for (int a = 0; a < 3; ++a) to[a] = light->place[a] - (light->distant ? 0 : turn->point[a]);
    bp_normalize(to);
    double cosine = bp_dot(to, turn->normal);
    if (material->kind == BP_MATERIAL_ROUGH_DIELECTRIC) cosine = fabs(cosine);
    if (material->kind == BP_MATERIAL_METAL) {
        const double up = bp_dot(turn->leaves, turn->normal);
        for (int a = 0; a < 3; ++a) mirrored[a] = 2 * up * turn->normal[a] - turn->leaves[a];
        const double apart = acos(fmin(fmax(bp_dot(mirrored, to), -1), 1));
        cosine = apart < material->fuzz + bp_pilot_half_angle(light, turn->point) ? 1 : 0;
    }
    return cosine > 0 ? light->share * bp_luminance_of(light->radiance) * cosine *
                            bp_pilot_solid_angle(scene, light, turn->point)
                      : 0;
}

static double chosen(const BpScene *scene, const BpPilotLight *lights, size_t light_count,
                     const BpPilotLight *light, const BpMaterial *material, const BpPilotTurn *turn) {
    if (light_count == 1) return 1;
    double sum = 0;
    for (size_t l = 0; l < light_count; ++l) sum += importance(scene, &lights[l], material, turn);
    const double own = importance(scene, light, material, turn) / light->share;
    return sum > 0 && own > 0 ? own / sum : 1;
}

/* The mean of squares over the mean, where a light is chosen with the probability. */
static double glint(const BpScene *scene, const BpPilotLight *light, double probability,
                    const BpMaterial *material, const BpPilotTurn *turn, double *mean) {
    *mean = bp_pilot_lobe_density(material, turn) * bp_pilot_solid_angle(scene, light, turn->point);
    if (!(*mean > 0)) return *mean = 0;
    /* A ray that is sent to the light, with the probability p, brings r / (1 + r^2), and one that meets it,
     * with r p, brings r^2 / (1 + r^2); both bring both. The mean is r p. */
    const double r = fmin(*mean / probability, 1e6), whole = 1 + r * r;
    return r * (1 + r * r * (2 * probability + r)) / (whole * whole);
}

double bp_pilot_glint(const BpScene *scene, const BpPilotLight *lights, size_t light_count,
                      const BpPilotLight *light, const BpMaterial *material, const BpPilotTurn *turn,
                      double *mean) {
    return glint(scene, light, chosen(scene, lights, light_count, light, material, turn), material, turn,
                 mean);
}

bool bp_pilot_turn_smooth(bool refracts, BpPilotTurn *turn) {
    const double up = bp_dot(turn->leaves, turn->normal), ratio = 1 / turn->index;
    const double down2 = 1 - ratio * ratio * (1 - up * up);
    if (refracts && !(down2 > 0)) return false;
    for (int a = 0; a < 3; ++a)
        turn->to_light[a] =
            refracts ? ratio * (up * turn->normal[a] - turn->leaves[a]) - sqrt(down2) * turn->normal[a]
                     : 2 * up * turn->normal[a] - turn->leaves[a];
    return true;
}

/* Around the middle, each GROWTH times as wide as the next, or as near to the rim. Fuzz is the same all
 * around, and has a pole at the rim of its lobe. */
#define RINGS 20
#define RINGS_OF_FUZZ 48
#define GROWTH 0x1.4p0
#define PLACES 4 /* on each */

double bp_pilot_glint_around(const BpScene *scene, const BpPilotLight *lights, size_t light_count,
                             const BpPilotLight *light, const BpMaterial *material, const BpPilotTurn *turn,
                             double *mean) {
    static const double turns[PLACES][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    const bool fuzzy = material->kind == BP_MATERIAL_METAL;
    const int rings = fuzzy ? RINGS_OF_FUZZ : RINGS, places = fuzzy ? 1 : PLACES;
    const double probability = chosen(scene, lights, light_count, light, material, turn);
    const double width = bp_pilot_lobe_width(material);
    double u[3], v[3], helper[3] = {0}, squares = 0, step = 1 / sqrt(GROWTH);
    helper[fabs(turn->to_light[0]) < 0.5 ? 0 : 1] = 1;
    bp_cross(turn->to_light, helper, u);
    bp_normalize(u);
    bp_cross(turn->to_light, u, v);
    *mean = 0;
    for (int ring = 0; ring < rings; ++ring, step /= GROWTH) {
        const double off = fuzzy ? width * sqrt(1 - step * step) : 4 * width * step; /* a sine */
        if (off >= 1) continue;
        const double aside = sqrt(1 - off * off), area = fuzzy ? width * step * width * step : off * off;
        const double part = 2 * PI * log(GROWTH) / places * area / aside;
        for (int place = 0; place < places; ++place) {
            BpPilotTurn turned = *turn;
            double one;
            for (int a = 0; a < 3; ++a)
                turned.to_light[a] =
                    aside * turn->to_light[a] + off * (turns[place][0] * u[a] + turns[place][1] * v[a]);
            const double bright = glint(scene, light, probability, material, &turned, &one);
            *mean += part * one;
            squares += part * one * bright;
        }
    }
    return *mean > 0 ? squares / *mean : 0;
}
