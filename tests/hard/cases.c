/* cases.c: see cases.h. */
#include "cases.h"
#include "base/quantile.h"

#include "oracle.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

void cases_init(Cases *cases, size_t count) {
    cases->count = count;
    cases->rays = calloc(count, RAY_REALS * sizeof(double));
    cases->spheres = calloc(count, 4 * sizeof(double));
    cases->hits = calloc(count, HIT_REALS * sizeof(double));
    if (cases->rays == NULL || cases->spheres == NULL || cases->hits == NULL) abort();
}

void cases_clear(Cases *cases) {
    free(cases->rays);
    free(cases->spheres);
    free(cases->hits);
    memset(cases, 0, sizeof *cases);
}

/* The ray starts `distance` from the surface and passes the centre at the impact distance, as nearly as
 * floats can say it. A ray from close by that is aimed at the rim starts tilted: the impact is that of its
 * line. */
void cases_aim(Cases *cases, size_t first, size_t count, const Cell *cell, uint64_t *random) {
    for (size_t i = first; i < first + count; ++i) {
        double *ray = cases->rays + i * RAY_REALS, *sphere = cases->spheres + i * 4;
        double towards[3], other[3], side[3], shift[3];
        lab_direction(random, towards);
        lab_direction(random, other);
        lab_direction(random, shift);
        lab_cross(towards, other, side);
        const double length = sqrt(lab_dot(side, side));
        const double away = cell->radius + cell->distance;
        const double impact =
            cell->radius * (cell->impact_low + (cell->impact_high - cell->impact_low) * lab_unit(random));
        /* sin of the angle between the ray and the line to the centre */
        const double sine = impact / away < 1 ? impact / away : 1, cosine = sqrt(1 - sine * sine);
        sphere[3] = lab_float(cell->radius);
        for (int a = 0; a < 3; ++a) {
            /* A tenth of the radius keeps the centre from being a round number where nothing is translated.
             */
            const double centre = cell->translation * shift[a] + 0.1 * cell->radius * other[a];
            sphere[a] = lab_float(centre);
            ray[RAY_HIGH + a] = lab_float(centre - away * towards[a]);
            ray[RAY_LOW + a] = 0;
            ray[RAY_DIRECTION + a] = cosine * towards[a] + sine * side[a] / length;
        }
        lab_float_unit(ray + RAY_DIRECTION);
        ray[RAY_SLACK] = 0;
    }
}

void cases_run(const Lab *lab, Cases *cases, const uint32_t *own) {
    const uint32_t width = lab->options.tree_width;
    double *leaves = malloc(cases->count * 4 * width * sizeof *leaves);
    uint32_t *none = calloc(cases->count, sizeof *none);
    double boxes[6 * 8];
    uint32_t children[8], slots[8];
    if (leaves == NULL || none == NULL) abort();
    lab_unit_rays(lab, cases->count, cases->rays);
    for (size_t i = 0; i < cases->count * 4 * width; ++i) leaves[i] = i / width % 4 == 3 ? -1 : NAN;
    for (size_t i = 0; i < cases->count; ++i)
        for (uint32_t row = 0; row < 4; ++row)
            leaves[(i * 4 + row) * width + i % width] = cases->spheres[i * 4 + row];
    for (uint32_t i = 0; i < 6 * width; ++i) boxes[i] = i < 3 * width ? 1e30 : -1e30;
    for (uint32_t i = 0; i < width; ++i) {
        children[i] = 0x80000000u;
        slots[i] = i;
    }
    const LabArgument arguments[] = {
        {LAB_REALS, cases->rays, cases->count * RAY_REALS},
        {LAB_WORDS, (void *)(size_t)(own != NULL ? own : none), cases->count},
        {LAB_REALS, leaves, cases->count * 4 * width},
        {LAB_REALS, boxes, 6 * width},
        {LAB_WORDS, children, width},
        {LAB_WORDS, slots, width},
        {LAB_OUT_REFINED, cases->hits, cases->count * HIT_REALS},
    };
    lab_run(lab, "probe_leaf", cases->count, arguments, sizeof arguments / sizeof arguments[0], NULL);
    free(leaves);
    free(none);
}

/* The book's quadratic, as its third and fourth editions have it, in float. */
static bool book_roots(const float oc[3], const float d[3], float r, float *near, float *far) {
    const float a = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], h = d[0] * oc[0] + d[1] * oc[1] + d[2] * oc[2];
    const float c = oc[0] * oc[0] + oc[1] * oc[1] + oc[2] * oc[2] - r * r, discriminant = h * h - a * c;
    if (discriminant < 0) return false;
    const float root = sqrtf(discriminant);
    *near = (h - root) / a;
    *far = (h + root) / a;
    return true;
}

/* E. Haines, J. Guenther and T. Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection", Ray
 * Tracing Gems, 2019, ch. 7: the discriminant from the part of oc across the ray, the roots by the stable
 * quadratic. */
static bool gems_roots(const float oc[3], const float d[3], float r, float *near, float *far) {
    const float a = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], h = d[0] * oc[0] + d[1] * oc[1] + d[2] * oc[2];
    float l[3];
    for (int i = 0; i < 3; ++i) l[i] = oc[i] - h / a * d[i];
    const float discriminant = a * (r * r - (l[0] * l[0] + l[1] * l[1] + l[2] * l[2]));
    if (discriminant < 0) return false;
    const float q = h + copysignf(sqrtf(discriminant), h);
    const float c = oc[0] * oc[0] + oc[1] * oc[1] + oc[2] * oc[2] - r * r;
    const float first = c / q, second = q / a;
    *near = first < second ? first : second;
    *far = first < second ? second : first;
    return true;
}

void cases_host(HostForm form, float t_min, Cases *cases) {
    for (size_t i = 0; i < cases->count; ++i) {
        const double *ray = cases->rays + i * RAY_REALS, *sphere = cases->spheres + i * 4;
        double *hit = cases->hits + i * HIT_REALS;
        float oc[3], d[3], near = 0, far = 0;
        for (int a = 0; a < 3; ++a) {
            oc[a] = (float)sphere[a] - (float)ray[RAY_HIGH + a];
            d[a] = (float)ray[RAY_DIRECTION + a];
        }
        const float r = (float)sphere[3];
        const bool meets =
            form == FORM_BOOK ? book_roots(oc, d, r, &near, &far) : gems_roots(oc, d, r, &near, &far);
        const float t = near > t_min ? near : far;
        memset(hit, 0, HIT_REALS * sizeof *hit);
        hit[HIT_T] = (double)t;
        hit[HIT_MET] = meets && t > t_min;
        hit[HIT_ENTERS] = near > t_min;
    }
}

Score cases_score(const Cases *cases, size_t first, size_t count, double band) {
    Score score = {.rays = count};
    double *errors = malloc((count + 1) * sizeof *errors);
    size_t error_count = 0;
    if (errors == NULL) abort();
    for (size_t i = first; i < first + count; ++i) {
        const double *ray = cases->rays + i * RAY_REALS, *sphere = cases->spheres + i * 4;
        const double *hit = cases->hits + i * HIT_REALS;
        const Exact exact = exact_roots(ray, sphere);
        const bool inside = exact.power < 0;
        const bool expected = exact.meets && (inside || exact.near > 0);
        const bool met = hit[HIT_MET] != 0;
        if (hit[HIT_MEETS] != 0 && !met && (inside || hit[HIT_NEAR] > 0)) ++score.filtered;
        if (met && !isfinite(hit[HIT_T])) ++score.not_finite;
        const bool tangent = fabs(exact.impact - 1) <= band;
        if (met != expected && !tangent) {
            if (met)
                ++score.false_hits;
            else
                ++score.false_misses;
        }
        if (!met || !expected) continue;
        ++score.right_hits;
        const double t = (double)(inside ? exact.far : exact.near);
        if (exact.impact < 0.9 && fabs(exact.power) > 1e-6) {
            const double error = fabs((hit[HIT_T] - t) / t);
            errors[error_count++] = error;
            if (inside) {
                score.worst_inside = fmax(score.worst_inside, error);
            } else if (error > score.worst_t) {
                score.worst_t = error;
                score.worst_case = i;
            }
        } else if (exact.impact >= 0.9) {
            const double off =
                fabs(exact_off_sphere(ray, sphere, hit[HIT_T])) - 0x1p-24 * fabs(hit[HIT_T]) / sphere[3];
            if (off > score.worst_off) score.worst_off = off;
        }
    }
    bp_sort_doubles(errors, error_count);
    score.median_t = error_count > 0 ? errors[error_count / 2] : 0;
    free(errors);
    return score;
}

void score_add(Score *sum, const Score *score) {
    sum->rays += score->rays;
    sum->right_hits += score->right_hits;
    sum->false_hits += score->false_hits;
    sum->false_misses += score->false_misses;
    sum->not_finite += score->not_finite;
    sum->filtered += score->filtered;
    if (score->worst_t > sum->worst_t) {
        sum->worst_t = score->worst_t;
        sum->worst_case = score->worst_case;
    }
    if (score->worst_inside > sum->worst_inside) sum->worst_inside = score->worst_inside;
    if (score->worst_off > sum->worst_off) sum->worst_off = score->worst_off;
}
