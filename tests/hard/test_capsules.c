/* test_capsules.c: hard cases of capsules against 113 bits: outlines and distances over decades of size,
 * length and distance, along the axis, without a length, left outward and inward, and the mean chord. Exit
 * code 1: one has another value. */
#include "turns.h"

#include <stdio.h>
#include <string.h>

enum { RAYS = 20000, MOST = 48 };

static double rays[RAYS * RAY_REALS], directions[RAYS * 3], out[RAYS * TURN_REALS];
static BpCapsule capsules[MOST];
static size_t capsule_count;
static uint64_t state = 11;
static bool fine; /* a ray's numbers are doubles, whose low part is at most half a unit of the high part */

static double between(double low, double high) {
    return low + (high - low) * lab_unit(&state);
}

/* Between powers of ten, evenly in their logarithm. */
static double decade(double low, double high) {
    return pow(10, between(low, high));
}

static BpCapsule *add(const double from[3], const double way[3], double radius) {
    BpCapsule *capsule = &capsules[capsule_count++];
    *capsule = (BpCapsule){.radius = lab_float(radius), .albedo = {BP_NO_ALBEDO, BP_NO_ALBEDO}};
    for (int a = 0; a < 3; ++a) {
        /* Both ends and their difference are floats. */
        capsule->ends[0][a] = lab_float(from[a]);
        capsule->ends[1][a] = capsule->ends[0][a] + lab_float(way[a]);
    }
    return capsule;
}

static void run(const Lab *lab) {
    BpWorker *worker = turns_capsules(lab, capsules, capsule_count);
    lab_unit_rays(lab, RAYS, rays);
    turns_run(lab, worker, RAYS, rays, directions, out);
    bp_worker_destroy(&worker);
}

static void wide_ray(const double *ray, Wide origin[3], Wide d[3]) {
    for (int a = 0; a < 3; ++a) {
        origin[a] = (Wide)ray[RAY_HIGH + a] + (Wide)ray[RAY_LOW + a];
        d[a] = (Wide)ray[RAY_DIRECTION + a];
    }
}

/* Hits and misses that are wrong beyond `band` of a radius from outlines; relative errors of distances to
 * what is hit deeper than 0.9 of its radius, and of chords. */
typedef struct Score {
    size_t hits, wrong, not_finite, no_exit;
    double worst_t, worst_chord;
} Score;

static double distance_of(TurnsStretch stretch) {
    return stretch.from > 0 ? (double)stretch.from : (double)stretch.to;
}

static Score score(double band) {
    Score found = {0, 0, 0, 0, 0, 0};
    for (size_t i = 0; i < RAYS; ++i) {
        const double *ray = rays + i * RAY_REALS, *row = out + i * TURN_REALS;
        Wide origin[3], d[3];
        double nearest = INFINITY, chord = 0;
        bool sure_hit = false, close = false, deep = false;
        wide_ray(ray, origin, d);
        for (size_t c = 0; c < capsule_count; ++c) {
            const TurnsStretch all = turns_through(&capsules[c], origin, d, 1);
            const bool less = turns_through(&capsules[c], origin, d, 1 - band).meets,
                       more = turns_through(&capsules[c], origin, d, 1 + band).meets;
            close = close || less != more;
            if (!all.meets || all.to <= 0) continue;
            sure_hit = sure_hit || less;
            if (distance_of(all) >= nearest) continue;
            nearest = distance_of(all);
            chord = (double)(all.to - all.from);
            deep = turns_through(&capsules[c], origin, d, 0.9).meets && all.from > 0;
        }
        const bool met = row[TURN_MET] >= 0;
        if (met && !isfinite(row[TURN_T])) ++found.not_finite;
        if (!close && met != sure_hit) ++found.wrong;
        if (!met || !deep || close) continue;
        ++found.hits;
        found.worst_t = fmax(found.worst_t, fabs(row[TURN_T] / nearest - 1));
        if (row[TURN_NEXT] < 0) ++found.no_exit;
        if (capsule_count == 1)
            found.worst_chord = fmax(found.worst_chord, fabs(row[TURN_NEXT_T] / chord - 1));
    }
    return found;
}

/* On their way through. */
static void go_on(void) {
    for (size_t i = 0; i < RAYS; ++i)
        memcpy(directions + 3 * i, rays + i * RAY_REALS + RAY_DIRECTION, 3 * sizeof *directions);
}

static bool judge(const Lab *lab, const char *what, Score found, size_t hits, double worst_t,
                  double worst_chord) {
    printf("%s, %s: %zu hits, %zu wrong, %zu not finite, %zu without an exit, distances to %.2g, chords to "
           "%.2g\n",
           lab->name, what, found.hits, found.wrong, found.not_finite, found.no_exit, found.worst_t,
           found.worst_chord);
    return found.hits >= hits && found.wrong == 0 && found.not_finite == 0 && found.no_exit == 0 &&
           found.worst_t <= worst_t && found.worst_chord <= worst_chord;
}

/* At the rim for every second ray: beside the axis by about a radius, to a millionth. */
static void aim_at_capsule(double *ray, const BpCapsule *capsule, double distance, bool at_rim, bool along) {
    double u[3], v[3], x[3], to[3], from[3];
    const double place = between(-0.1, 1.1), side = lab_bits(&state) & 1 ? 1 : -1;
    const double impact = at_rim ? 1 + side * decade(-6, 0) : between(0, 1.2);
    lab_direction(&state, u);
    lab_direction(&state, v);
    for (int a = 0; a < 3; ++a) {
        const double axis = capsule->ends[1][a] - capsule->ends[0][a];
        if (along) u[a] = axis + 1e-3 * decade(-6, 0) * v[a];
    }
    const double length = sqrt(lab_dot(u, u));
    for (int a = 0; a < 3; ++a) u[a] /= length;
    lab_cross(u, v, x);
    const double across = sqrt(lab_dot(x, x));
    for (int a = 0; a < 3; ++a) {
        to[a] = capsule->ends[0][a] + place * (capsule->ends[1][a] - capsule->ends[0][a]) +
                impact * capsule->radius * x[a] / across;
        from[a] = to[a] - distance * u[a];
    }
    turns_aim(fine, ray, from, to);
}

/* ---- the cases: true where the value is right ---- */

/* Radii over six decades, lengths to a thousand of them, a quarter far from the origin, distances to a
 * million. */
static bool all_sizes(const Lab *lab) {
    bool right = true;
    for (int step = 0; step < 12; ++step) {
        const double radius = decade(-3, 3), length = radius * decade(-1, 3),
                     far = step % 4 == 3 ? radius * 1e4 : 0;
        double from[3], way[3];
        lab_direction(&state, from);
        lab_direction(&state, way);
        for (int a = 0; a < 3; ++a) {
            from[a] *= far;
            way[a] *= length;
        }
        capsule_count = 0;
        add(from, way, radius);
        for (size_t i = 0; i < RAYS; ++i)
            aim_at_capsule(rays + i * RAY_REALS, &capsules[0], (length + radius) * (1.5 + decade(-2, 3)),
                           i % 2 == 0, i % 8 == 1);
        go_on();
        run(lab);
        right = judge(lab, "all sizes", score(1e-5), RAYS / 20, lab->refined_double ? 1e-9 : 3e-6,
                      lab->refined_double ? 1e-6 : 2e-3) &&
                right;
    }
    return right;
}

/* Rays that begin before the surface, a millionth to a tenth of the radius away, and go in or past. */
static bool near_its_surface(const Lab *lab) {
    bool right = true;
    for (int step = 0; step < 4; ++step) {
        const double radius = decade(-3, 3);
        double way[3];
        lab_direction(&state, way);
        for (int a = 0; a < 3; ++a) way[a] *= 10 * radius;
        capsule_count = 0;
        const BpCapsule *capsule = add((const double[3]){-way[0] / 2, -way[1] / 2, -way[2] / 2}, way, radius);
        for (size_t i = 0; i < RAYS; ++i) {
            const double from = lab_unit(&state), to = between(-0.2, 1.2),
                         away = radius * (1 + decade(-6, -1));
            double axis[3], any[3], beside[3], across[3], origin[3], target[3];
            for (int a = 0; a < 3; ++a) axis[a] = capsule->ends[1][a] - capsule->ends[0][a];
            lab_direction(&state, any);
            lab_cross(axis, any, beside);
            lab_direction(&state, any);
            lab_cross(axis, any, across);
            const double one = sqrt(lab_dot(beside, beside)), other = sqrt(lab_dot(across, across)),
                         impact = between(0, 1.5) * radius;
            for (int a = 0; a < 3; ++a) {
                origin[a] = capsule->ends[0][a] + from * axis[a] + away * beside[a] / one;
                target[a] = capsule->ends[0][a] + to * axis[a] + impact * across[a] / other;
            }
            turns_aim(fine, rays + i * RAY_REALS, origin, target);
        }
        go_on();
        run(lab);
        right = judge(lab, "near its surface", score(1e-5), RAYS / 4, lab->refined_double ? 1e-6 : 1e-3,
                      INFINITY) &&
                right;
    }
    return right;
}

/* Many at once, in a tree, and rays from among them. */
static bool many(const Lab *lab) {
    for (int k = 0; k < MOST; ++k) {
        double from[3], way[3];
        for (int a = 0; a < 3; ++a) {
            from[a] = between(-2, 2);
            way[a] = between(-1, 1);
        }
        add(from, way, between(0.02, 0.3));
    }
    for (size_t i = 0; i < RAYS; ++i)
        aim_at_capsule(rays + i * RAY_REALS, &capsules[i % MOST], between(0, 6), i % 2 == 0, i % 8 == 1);
    go_on();
    run(lab);
    return judge(lab, "many", score(1e-5), RAYS / 20, lab->refined_double ? 1e-9 : 3e-6, INFINITY);
}

/* Along the axis, from outside: from one end to the other. */
static bool along_its_axis(const Lab *lab) {
    const double from[3] = {0.25, -0.5, -3}, way[3] = {0, 0, 2};
    double worst = 0;
    size_t lost = 0;
    add(from, way, 0.125);
    for (size_t i = 0; i < RAYS; ++i) {
        const double start[3] = {0.25, -0.5, i % 2 == 0 ? 4.0 : -7.0}, to[3] = {0.25, -0.5, -2};
        turns_aim(fine, rays + i * RAY_REALS, start, to);
    }
    go_on();
    run(lab);
    for (size_t i = 0; i < RAYS; ++i) {
        const double *row = out + i * TURN_REALS, t = i % 2 == 0 ? 4.875 : 3.875;
        if (!(row[TURN_MET] == 0 && row[TURN_NEXT] == 0)) ++lost;
        worst = fmax(worst, fmax(fabs(row[TURN_T] / t - 1), fabs(row[TURN_NEXT_T] / 2.25 - 1)));
    }
    printf("%s, along its axis: %zu lost, distances to %.2g\n", lab->name, lost, worst);
    return lost == 0 && worst <= (lab->refined_double ? 1e-12 : 1e-6);
}

/* As the sphere that it is, to the bit. */
static bool no_length(const Lab *lab) {
    static double other[RAYS * TURN_REALS];
    const double from[3] = {0.3, -0.2, 0.7}, way[3] = {0, 0, 0};
    add(from, way, 0.4);
    const BpSphere ball = {.center = {capsules[0].ends[0][0], capsules[0].ends[0][1], capsules[0].ends[0][2]},
                           .radius = capsules[0].radius,
                           .albedo = BP_NO_ALBEDO};
    for (size_t i = 0; i < RAYS; ++i)
        aim_at_capsule(rays + i * RAY_REALS, &capsules[0], decade(-1, 3), i % 2 == 0, false);
    for (size_t i = 0; i < RAYS; ++i) lab_direction(&state, directions + 3 * i);
    run(lab);
    memcpy(other, out, sizeof other);
    BpWorker *worker = turns_worker(lab, &ball, 1, NULL, 0);
    turns_run(lab, worker, RAYS, rays, directions, out);
    bp_worker_destroy(&worker);
    size_t differ = 0, hits = 0;
    for (size_t i = 0; i < RAYS; ++i) {
        hits += out[i * TURN_REALS] >= 0;
        differ += memcmp(out + i * TURN_REALS, other + i * TURN_REALS, TURN_REALS * sizeof *out) != 0;
    }
    printf("%s, without a length: %zu hits, %zu rays differ from the sphere's\n", lab->name, hits, differ);
    return differ == 0 && hits > RAYS / 4;
}

/* Left in any direction: outward nothing is met, inward the far side, on the surface. Of floats a chord that
 * ends where the ray only just passes is off by the root of their rounding. */
static bool left_both_ways(const Lab *lab) {
    const double from[3] = {0.3, -0.2, 0.7}, way[3] = {0.5, 0.3, -0.9};
    const BpCapsule *capsule = add(from, way, 0.4);
    for (size_t i = 0; i < RAYS; ++i) aim_at_capsule(rays + i * RAY_REALS, capsule, 3, false, false);
    for (size_t i = 0; i < RAYS; ++i) {
        lab_direction(&state, directions + 3 * i);
        lab_float_unit(directions + 3 * i);
    }
    run(lab);
    size_t outward = 0, inward = 0, wrong = 0;
    double worst = 0;
    for (size_t i = 0; i < RAYS; ++i) {
        const double *row = out + i * TURN_REALS, *d = directions + 3 * i;
        Wide point[3], w[3];
        if (row[TURN_MET] < 0) continue;
        const double slope = row[13] * d[0] + row[14] * d[1] + row[15] * d[2];
        outward += slope > 0;
        inward += slope < 0;
        wrong += (row[TURN_NEXT] >= 0) != (slope < 0);
        if (!(slope < 0) || row[TURN_NEXT] < 0) continue;
        wrong += row[TURN_NEXT_OUTSIDE] != 0 || row[TURN_NEXT_T] < 0;
        for (int a = 0; a < 3; ++a) {
            point[a] = (Wide)row[TURN_HIGH + a] + (Wide)row[TURN_LOW + a];
            w[a] = (Wide)d[a];
        }
        const TurnsStretch through = turns_through(capsule, point, w, 1);
        worst = fmax(worst, fabs(row[TURN_NEXT_T] - (double)through.to) / capsule->radius);
    }
    printf("%s, left both ways: %zu outward, %zu inward, %zu wrong, exits to %.2g of the radius\n", lab->name,
           outward, inward, wrong, worst);
    return wrong == 0 && outward > RAYS / 8 && inward > RAYS / 8 &&
           worst <= (lab->refined_double ? 1e-9 : 1e-3);
}

/* Of lines of every direction the mean chord in a convex body is 4 V / S: 0.188889 for radius 0.1 and
 * length 1. */
static bool mean_chord(const Lab *lab) {
    enum { ROUNDS = 12 };
    const double from[3] = {-0.5, 0, 0}, way[3] = {1, 0, 0}, exact = 0.188889, around = 0.62;
    double sum = 0, square = 0;
    size_t hits = 0;
    add(from, way, 0.1);
    for (int round = 0; round < ROUNDS; ++round) {
        for (size_t i = 0; i < RAYS; ++i) {
            double u[3], v[3], x[3], start[3], to[3];
            lab_direction(&state, u);
            lab_direction(&state, v);
            lab_cross(u, v, x);
            const double across = around * sqrt(lab_unit(&state)) / sqrt(lab_dot(x, x));
            for (int a = 0; a < 3; ++a) {
                to[a] = across * x[a];
                start[a] = to[a] - 3 * u[a];
            }
            turns_aim(fine, rays + i * RAY_REALS, start, to);
        }
        go_on();
        run(lab);
        for (size_t i = 0; i < RAYS; ++i) {
            const double *row = out + i * TURN_REALS, chord = row[TURN_NEXT_T];
            if (row[TURN_MET] < 0) continue;
            ++hits;
            sum += chord;
            square += chord * chord;
        }
    }
    const double mean = sum / (double)hits,
                 error = sqrt((square / (double)hits - mean * mean) / (double)hits);
    printf("%s, mean chord: %.6f +- %.6f of %zu, 4 V / S is %.6f\n", lab->name, mean, error, hits, exact);
    return fabs(mean - exact) < 4.5 * error && error < 0.001;
}

int main(int argc, char **argv) {
    static bool (*const cases[])(const Lab *) = {all_sizes, near_its_surface, many,      along_its_axis,
                                                 no_length, left_both_ways,   mean_chord};
    Lab lab;
    int failed = 0;
    if (argc != 2) {
        fprintf(stderr, "usage: hard_capsules double|float|all-double\n");
        return 2;
    }
    if (!lab_open(&lab, argv[1])) return 77;
    fine = lab.real_double;
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; ++c) {
        capsule_count = 0;
        if (!cases[c](&lab)) {
            printf("  WRONG\n");
            ++failed;
        }
    }
    lab_close(&lab);
    return failed > 0 ? 1 : 0;
}
