/* map_capsules.c: where each form of the intersection with capsules is right and where it fails; see map.h.
 */
#include "map.h"

#include "turns.h"

#include <stdio.h>
#include <stdlib.h>

static const char *const of_capsules[FORMS] = {"closed form", "plain", "ours in float", "ours in double"};

typedef struct Rods {
    BpCapsule *capsules;  /* one for each radius */
    double *rays, *found; /* of found: the distance, and whether it is met */
    uint32_t *numbers;
    size_t count;
} Rods;

/* Ten radii long, around the origin. Its ends and their difference are floats. */
static BpCapsule rod(double radius, uint64_t *random) {
    BpCapsule capsule = {.radius = lab_float(radius), .albedo = {BP_NO_ALBEDO, BP_NO_ALBEDO}};
    double way[3];
    lab_direction(random, way);
    for (int a = 0; a < 3; ++a) {
        capsule.ends[0][a] = lab_float(-5 * radius * way[a]);
        capsule.ends[1][a] = -capsule.ends[0][a];
    }
    return capsule;
}

/* From a place so far from the surface, beside the axis, to one within 1.5 radii of the axis. */
static void aim_at_rod(const BpCapsule *capsule, double distance, double *ray, uint64_t *random) {
    const double r = capsule->radius, from = lab_unit(random), to = 1.4 * lab_unit(random) - 0.2,
                 impact = 1.5 * r * lab_unit(random);
    double axis[3], any[3], beside[3], across[3], away[3], origin[3], target[3];
    for (int a = 0; a < 3; ++a) axis[a] = capsule->ends[1][a] - capsule->ends[0][a];
    lab_direction(random, any);
    lab_cross(axis, any, beside);
    lab_direction(random, any);
    lab_cross(axis, any, across);
    lab_direction(random, away);
    const double sign = lab_dot(away, beside) < 0 ? -1 : 1, one = sqrt(lab_dot(beside, beside)),
                 other = sqrt(lab_dot(across, across));
    for (int a = 0; a < 3; ++a) {
        origin[a] =
            lab_float(capsule->ends[0][a] + from * axis[a] + r * beside[a] / one + distance * sign * away[a]);
        target[a] = capsule->ends[0][a] + to * axis[a] + impact * across[a] / other;
    }
    turns_aim(false, ray, origin, target);
}

/* The closed form of collections for shaders (Quilez), in float: a quadratic for the cylinder, one for an
 * end. */
static bool closed_form(const BpCapsule *capsule, const double *ray, double *distance) {
    float ba[3], oa[3], ob[3], d[3];
    for (int i = 0; i < 3; ++i) {
        const float a = (float)capsule->ends[0][i], b = (float)capsule->ends[1][i], o = (float)ray[i];
        ba[i] = b - a;
        oa[i] = o - a;
        ob[i] = o - b;
        d[i] = (float)ray[RAY_DIRECTION + i];
    }
#define DOT(x, y) ((x)[0] * (y)[0] + (x)[1] * (y)[1] + (x)[2] * (y)[2])
    const float r2 = (float)capsule->radius * (float)capsule->radius, baba = DOT(ba, ba), bard = DOT(ba, d),
                baoa = DOT(ba, oa);
    const float a = baba - bard * bard, b = baba * DOT(d, oa) - baoa * bard,
                c = baba * DOT(oa, oa) - baoa * baoa - r2 * baba;
    const float h = b * b - a * c;
    if (!(h >= 0)) return false;
    const float t = (-b - sqrtf(h)) / a, y = baoa + t * bard;
    *distance = (double)t;
    if (y > 0 && y < baba) return t > 0;
    const float *end = y <= 0 ? oa : ob;
    const float be = DOT(d, end), ce = DOT(end, end) - r2, he = be * be - ce;
#undef DOT
    if (!(he > 0)) return false;
    *distance = (double)(-be - sqrtf(he));
    return *distance > 0;
}

static void run_capsules(const Atlas *atlas, int form, const Rods *rods) {
    const Lab *lab = form == 1 ? &atlas->plain : &atlas->labs[form - 2];
    BpWorker *worker = turns_capsules(lab, rods->capsules, SIDE);
    const LabArgument arguments[] = {{LAB_REALS, rods->rays, rods->count * RAY_REALS},
                                     {LAB_WORDS, rods->numbers, rods->count},
                                     {LAB_OUT_REFINED, rods->found, rods->count * 2}};
    lab_run(lab, "probe_capsules", rods->count, arguments, 3, worker);
    bp_worker_destroy(&worker);
}

/* As of spheres: the worst error of t within 0.9 r, from 5e-7 r off the surface on, and the share of wrong
 * answers 1 % off the rim or more. Rays that begin inside are not judged. */
static void judge_square(const Rods *rods, size_t first, double *worst, double *wrong) {
    size_t hits = 0, bad = 0;
    *worst = 0;
    for (size_t i = first; i < first + EACH; ++i) {
        const BpCapsule *capsule = &rods->capsules[rods->numbers[i]];
        Wide origin[3], d[3];
        for (int a = 0; a < 3; ++a) {
            origin[a] = (Wide)rods->rays[i * RAY_REALS + (size_t)a];
            d[a] = (Wide)rods->rays[i * RAY_REALS + RAY_DIRECTION + (size_t)a];
        }
        const TurnsStretch all = turns_through(capsule, origin, d, 1),
                           deep = turns_through(capsule, origin, d, 0.9),
                           less = turns_through(capsule, origin, d, 0.99),
                           more = turns_through(capsule, origin, d, 1.01);
        if (all.meets && all.to > 0 && !((double)all.from > 5e-7 * capsule->radius)) continue;
        const bool ahead = all.meets && all.from > 0, met = rods->found[2 * i + 1] > 0;
        if (less.meets == more.meets && ahead != met) ++bad;
        if (!deep.meets || !ahead || !met) continue;
        ++hits;
        *worst = fmax(*worst, fmax(fabs(rods->found[2 * i] / (double)all.from - 1), 1e-30));
    }
    if (hits == 0) *worst = NAN;
    *wrong = (double)bad / EACH;
}

/* Radius across, distance up. */
void map_capsules(const Atlas *atlas) {
    Map error = {.file = "map-capsule-error.png",
                 .title = "capsules   relative error of t   worst of 600 rays",
                 .across = "log10 of the radius",
                 .up = "log10 of the distance",
                 .best = "1e-7",
                 .worst = "1e-1",
                 .forms = of_capsules,
                 .column_low = -3,
                 .row_low = -3,
                 .low = -7,
                 .high = -1};
    Map wrong = error;
    wrong.file = "map-capsule-wrong.png";
    wrong.title = "capsules   wrong hits and misses 1 % off the rim";
    wrong.best = "none of 600";
    wrong.worst = "half of them";
    wrong.low = -3.2;
    wrong.high = -0.3;
    BpCapsule capsules[SIDE];
    Rods rods = {.capsules = capsules, .count = (size_t)SIDE * SIDE * EACH};
    rods.rays = calloc(rods.count * RAY_REALS, sizeof *rods.rays);
    rods.found = calloc(rods.count * 2, sizeof *rods.found);
    rods.numbers = calloc(rods.count, sizeof *rods.numbers);
    if (rods.rays == NULL || rods.found == NULL || rods.numbers == NULL) abort();
    uint64_t random = 5;
    for (int column = 0; column < SIDE; ++column) capsules[column] = rod(pow(10, -3 + column), &random);
    for (size_t i = 0; i < rods.count; ++i) {
        const size_t row = i / EACH / SIDE, column = i / EACH % SIDE;
        rods.numbers[i] = (uint32_t)column;
        aim_at_rod(&capsules[column], pow(10, -3 + (double)row), rods.rays + i * RAY_REALS, &random);
    }
    for (int form = 0; form < FORMS; ++form) {
        for (size_t i = 0; i < rods.count && form == 0; ++i)
            rods.found[2 * i + 1] =
                closed_form(&capsules[rods.numbers[i]], rods.rays + i * RAY_REALS, &rods.found[2 * i]);
        if (form > 0) run_capsules(atlas, form, &rods);
        double far = 0, near = 0, most = 0;
        for (size_t square = 0; square < (size_t)SIDE * SIDE; ++square) {
            double *const off = &error.value[form][square / SIDE][square % SIDE],
                          *const bad = &wrong.value[form][square / SIDE][square % SIDE];
            judge_square(&rods, square * EACH, off, bad);
            if (square / SIDE > square % SIDE)
                far = fmax(far, *off);
            else
                near = fmax(near, *off);
            most = fmax(most, *bad);
        }
        printf("capsules, %s: errors to %.2g from ten radii away on, to %.2g from nearer, in a square at "
               "most %.3g "
               "wrong\n",
               of_capsules[form], far, near, most);
    }
    map_draw(atlas, &error);
    map_draw(atlas, &wrong);
    free(rods.rays);
    free(rods.found);
    free(rods.numbers);
}
