/* test_triangle_cases.c: single hard cases of triangles, each with the value that it must have.
 *
 *     hard_triangle_cases double|float|all-double
 *
 * hard_triangles aims at the edges and vertices of closed meshes; these are what meshes seldom have:
 * triangles that are far, tiny, huge, thin, seen from their edge or in one place, rays along the axes, and
 * balls that lie on triangles. test_triangle_list.py has all hard cases of triangles, and where each is
 * tested. Exit code 1: one of them has another value. */
#include "turns.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RAYS = 20000, MOST = 600 };

static double rays[RAYS * RAY_REALS], directions[RAYS * 3], out[RAYS * TURN_REALS];
static BpTriangle triangles[MOST];
static size_t triangle_count;
static BpSphere ball;
static size_t ball_count;
static uint64_t state = 7;

static void add(double ax, double ay, double az, double bx, double by, double bz, double cx, double cy,
                double cz) {
    const double at[3][3] = {{ax, ay, az}, {bx, by, bz}, {cx, cy, cz}};
    BpTriangle *triangle = &triangles[triangle_count++];
    *triangle = (BpTriangle){.albedo = BP_NO_ALBEDO};
    for (int k = 0; k < 3; ++k)
        for (int a = 0; a < 3; ++a) triangle->vertices[k][a] = lab_float(at[k][a]);
}

/* A square in the plane z = 0, in 2 n^2 triangles, all of one side. */
static void add_square(int n, double size) {
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double x = size * (2.0 * i / n - 1), y = size * (2.0 * j / n - 1), s = 2 * size / n;
            add(x, y, 0, x + s, y, 0, x + s, y + s, 0);
            add(x, y, 0, x + s, y + s, 0, x, y + s, 0);
        }
}

static double between(double low, double high) {
    return low + (high - low) * lab_unit(&state);
}

static bool fine; /* a ray's numbers are doubles, whose low part is at most half a unit of the high part */

static void run(const Lab *lab) {
    BpWorker *worker = turns_worker(lab, &ball, ball_count, triangles, triangle_count);
    lab_unit_rays(lab, RAYS, rays);
    turns_run(lab, worker, RAYS, rays, directions, out);
    bp_worker_destroy(&worker);
}

/* Against 113 bits: hits and misses that are wrong, farther than `band` of the edges' lengths from them, and
 * the largest relative error of a distance. */
typedef struct Score {
    size_t hits, wrong, not_finite;
    double worst_t;
} Score;

static Score score(double band) {
    Score found = {0, 0, 0, 0};
    for (size_t i = 0; i < RAYS; ++i) {
        const double *ray = rays + i * RAY_REALS, *row = out + i * TURN_REALS;
        Wide origin[3], d[3], w[3], t = 0, best = -1;
        bool outside = false, close = false;
        for (int a = 0; a < 3; ++a) {
            origin[a] = (Wide)ray[RAY_HIGH + a] + (Wide)ray[RAY_LOW + a];
            d[a] = (Wide)ray[RAY_DIRECTION + a];
        }
        for (size_t f = 0; f < triangle_count; ++f) {
            const bool passed = turns_passes(&triangles[f], origin, d, 0, w, &t, &outside);
            const double sum = fabs((double)w[0]) + fabs((double)w[1]) + fabs((double)w[2]);
            for (int k = 0; k < 3; ++k) close = close || fabs((double)w[k]) <= band * sum;
            if (passed && t > 0 && (best < 0 || t < best)) best = t;
        }
        const bool met = row[TURN_MET] >= 0;
        if (met && !isfinite(row[TURN_T])) ++found.not_finite;
        if (met != (best >= 0) && !close) ++found.wrong;
        if (met && best > 0) {
            ++found.hits;
            found.worst_t = fmax(found.worst_t, fabs(row[TURN_T] / (double)best - 1));
        }
    }
    return found;
}

/* Prints, and returns whether the case has its value. */
static bool judge(const Lab *lab, const char *what, Score found, size_t hits, double worst_t) {
    printf("%s, %s: %zu hits, %zu wrong, %zu not finite, distances to %.2g\n", lab->name, what, found.hits,
           found.wrong, found.not_finite, found.worst_t);
    return found.hits >= hits && found.wrong == 0 && found.not_finite == 0 && found.worst_t <= worst_t;
}

static void aim_at_triangle(double *ray, const double from[3], double more) {
    const double(*v)[3] = (const double(*)[3])triangles[lab_bits(&state) % triangle_count].vertices;
    const double b = between(-more, 1 + more), c = between(-more, 1 + more);
    double to[3];
    for (int a = 0; a < 3; ++a) to[a] = v[0][a] + b * (v[1][a] - v[0][a]) + c * (v[2][a] - v[0][a]);
    turns_aim(fine, ray, from, to);
}

/* ---- the cases: true where the value is right ---- */

/* A float has 24 bits; a pair of floats and a double keep distances as floats or better. */
static double distance_error(const Lab *lab) {
    return lab->refined_double ? 1e-12 : 1e-7;
}

/* A millionth of its distance in size, half of the rays beside it. */
static bool small_from_afar(const Lab *lab) {
    add(1, 0.2, 0.1, -0.4, 0.9, -0.3, -0.5, -0.8, 0.4);
    for (size_t i = 0; i < RAYS; ++i) {
        double way[3];
        lab_direction(&state, way);
        for (int a = 0; a < 3; ++a) way[a] *= 1e6;
        aim_at_triangle(rays + i * RAY_REALS, way, 0.3);
    }
    run(lab);
    return judge(lab, "size a millionth of the distance", score(1e-5), RAYS / 100, distance_error(lab));
}

/* As small, from the origin: an error that follows from the origin's size is 0 there. */
static bool far_from_the_camera(const Lab *lab) {
    const double from[3] = {0, 0, 0};
    add(1e6, -2e5, 3e5, 1e6 + 1, -2e5 + 0.5, 3e5 + 2, 1e6 - 1, -2e5 + 1, 3e5 + 3);
    for (size_t i = 0; i < RAYS; ++i) aim_at_triangle(rays + i * RAY_REALS, from, 0.3);
    run(lab);
    return judge(lab, "the same from the origin", score(1e-5), RAYS / 100, distance_error(lab));
}

/* 2e6 wide, from 1 above. */
static bool ground(const Lab *lab) {
    add(-1e6, -1e6, -1, 1e6, -1e6, -1, 1e6, 1e6, -1);
    add(-1e6, -1e6, -1, 1e6, 1e6, -1, -1e6, 1e6, -1);
    for (size_t i = 0; i < RAYS; ++i) {
        const double far = pow(10, between(-1, 5.8)), turn = between(0, 6.283185307179586);
        const double to[3] = {far * cos(turn), far * sin(turn), -1}, from[3] = {0, 0, 0};
        turns_aim(fine, rays + i * RAY_REALS, from, to);
    }
    run(lab);
    return judge(lab, "a ground of 2e6, 1 below", score(0), RAYS, 5e-7);
}

/* Where it leans: the point lies no farther off the plane than the bound that goes with it. */
static bool leaning_ground(const Lab *lab) {
    add(-1e6, -2e5, -7e5, 1e6, 1e5, -6e5, 0, 1e5 - 9, 1.3e6); /* 3 below the origin, in its middle */
    const BpTriangle *ground_triangle = &triangles[0];
    Wide u[3], v[3], n[3], length = 0, worst = 0;
    size_t met = 0, off = 0;
    for (int a = 0; a < 3; ++a) {
        u[a] = (Wide)ground_triangle->vertices[1][a] - (Wide)ground_triangle->vertices[0][a];
        v[a] = (Wide)ground_triangle->vertices[2][a] - (Wide)ground_triangle->vertices[0][a];
    }
    for (int a = 0; a < 3; ++a) n[a] = u[(a + 1) % 3] * v[(a + 2) % 3] - u[(a + 2) % 3] * v[(a + 1) % 3];
    length = wide_sqrt(wide_dot(n, n));
    for (size_t i = 0; i < RAYS; ++i) {
        const double s = 1.0 / 3 + between(-1e-6, 1e-6), t = 1.0 / 3 + between(-1e-6, 1e-6);
        double to[3], from[3];
        for (int a = 0; a < 3; ++a) {
            to[a] = (double)((Wide)ground_triangle->vertices[0][a] + (Wide)s * u[a] + (Wide)t * v[a]);
            from[a] = to[a] + between(-1, 1) + (a == 1 ? 2 : 0);
        }
        turns_aim(fine, rays + i * RAY_REALS, from, to);
    }
    run(lab);
    for (size_t i = 0; i < RAYS; ++i) {
        const double *row = out + i * TURN_REALS;
        if (row[TURN_MET] < 0) continue;
        Wide height = 0;
        for (int a = 0; a < 3; ++a)
            height +=
                ((Wide)row[TURN_HIGH + a] + (Wide)row[TURN_LOW + a] - (Wide)ground_triangle->vertices[0][a]) *
                n[a] / length;
        ++met;
        off += wide_abs(height) > (Wide)row[TURN_ERROR];
        worst = wide_abs(height) > worst ? wide_abs(height) : worst;
    }
    printf("%s, a ground of 2e6 that leans: %zu hits, %zu off the plane, at most %.2g\n", lab->name, met, off,
           (double)worst);
    return off == 0 && met > RAYS / 2;
}

/* Points of slivers and of common triangles, of 1e-3 to 1e6 and up to a million sizes from the origin, lie in
 * their planes but for 2^-45 of their place and of the longest edge; of the edge 2^-42 in pairs of floats. */
static bool on_their_planes(const Lab *lab) {
    enum { SHAPES = 40 };
    Wide worst = 0;
    size_t met = 0;
    for (int shape = 0; shape < SHAPES; ++shape) {
        const double size = pow(10, between(-3, 6)), width = shape % 2 == 0 ? size : 1e-3 * size;
        const double far = size * pow(10, between(-1, 6));
        double way[3], corner[3][3];
        lab_direction(&state, way);
        if (far > 1e9) continue;
        for (int a = 0; a < 3; ++a) {
            corner[0][a] = way[a] * far;
            corner[1][a] = corner[0][a] + size * between(-1, 1);
            corner[2][a] = corner[0][a] + width * between(-1, 1);
        }
        triangle_count = 0;
        add(corner[0][0], corner[0][1], corner[0][2], corner[1][0], corner[1][1], corner[1][2], corner[2][0],
            corner[2][1], corner[2][2]);
        const double(*v)[3] = (const double(*)[3])triangles[0].vertices;
        Wide u[3], w[3], n[3], edge = 0;
        for (int a = 0; a < 3; ++a)
            u[a] = (Wide)v[1][a] - (Wide)v[0][a], w[a] = (Wide)v[2][a] - (Wide)v[0][a];
        for (int a = 0; a < 3; ++a) n[a] = u[(a + 1) % 3] * w[(a + 2) % 3] - u[(a + 2) % 3] * w[(a + 1) % 3];
        const Wide length = wide_sqrt(wide_dot(n, n));
        if (length == 0) continue; /* as floats, so far away, without an area */
        for (int k = 0; k < 3; ++k) {
            Wide side[3];
            for (int a = 0; a < 3; ++a) side[a] = (Wide)v[(k + 1) % 3][a] - (Wide)v[k][a];
            const Wide longer = wide_sqrt(wide_dot(side, side));
            edge = longer > edge ? longer : edge;
        }
        for (size_t i = 0; i < RAYS; ++i) {
            double from[3];
            lab_direction(&state, from);
            for (int a = 0; a < 3; ++a) from[a] = corner[0][a] + from[a] * size * between(0.1, 3);
            aim_at_triangle(rays + i * RAY_REALS, from, 0);
        }
        run(lab);
        for (size_t i = 0; i < RAYS; ++i) {
            const double *row = out + i * TURN_REALS;
            if (row[TURN_MET] < 0) continue;
            Wide height = 0, size_of_point = 0;
            for (int a = 0; a < 3; ++a) {
                const Wide place = (Wide)row[TURN_HIGH + a] + (Wide)row[TURN_LOW + a];
                height += (place - (Wide)v[0][a]) * n[a] / length;
                size_of_point += wide_abs(place);
            }
            const Wide bound = 0x1p-45 * size_of_point + (lab->refined_double ? 0x1p-45 : 0x1p-42) * edge;
            const Wide used = wide_abs(height) / bound;
            ++met;
            worst = used > worst ? used : worst;
        }
    }
    printf("%s, points on their planes: %zu hits, %.2g of the bound used\n", lab->name, met, (double)worst);
    return worst <= 1 && met > RAYS;
}

/* Rays in the plane of a triangle, some of them through it. */
static bool in_its_plane(const Lab *lab) {
    add(0, 0, 0.5, 1, 0, 0.5, 0, 1, 0.5);
    for (size_t i = 0; i < RAYS; ++i) {
        const double from[3] = {between(-3, 3), between(-3, 3), 0.5};
        const double to[3] = {between(0, 1), between(0, 1), 0.5};
        turns_aim(fine, rays + i * RAY_REALS, from, to);
        if (i % 4 == 0) { /* along an edge */
            rays[i * RAY_REALS + RAY_HIGH + 1] = rays[i * RAY_REALS + RAY_LOW + 1] = 0;
            rays[i * RAY_REALS + RAY_DIRECTION] = i % 8 == 0 ? 1 : -1;
            rays[i * RAY_REALS + RAY_DIRECTION + 1] = 0;
        }
    }
    run(lab);
    size_t met = 0;
    for (size_t i = 0; i < RAYS; ++i) met += out[i * TURN_REALS + TURN_MET] >= 0;
    printf("%s, in a triangle's plane: %zu hits\n", lab->name, met);
    return met == 0;
}

/* At 1e-7 to the plane. */
static bool grazing(const Lab *lab) {
    add_square(1, 1);
    for (size_t i = 0; i < RAYS; ++i) {
        const double turn = between(0, 6.283185307179586), height = 1e-7 * between(0, 3);
        const double from[3] = {-cos(turn) * 1.5, -sin(turn) * 1.5, height},
                     to[3] = {from[0] + cos(turn), from[1] + sin(turn), height - 1e-7};
        turns_aim(fine, rays + i * RAY_REALS, from, to);
    }
    run(lab);
    return judge(lab, "grazing by 1e-7", score(1e-5), RAYS / 4, 1e-6);
}

/* A million times as long as wide. */
static bool sliver(const Lab *lab) {
    add(-0.5, 0.3, 2, 0.5, 0.3, 2.5, 0.1, 0.300001, 2.3);
    for (size_t i = 0; i < RAYS; ++i) {
        const double from[3] = {between(-1, 1), between(-1, 1), between(-1, 1)};
        aim_at_triangle(rays + i * RAY_REALS, from, 0);
    }
    run(lab);
    return judge(lab, "a sliver of 1 : 1e6", score(1e-3), RAYS / 100, distance_error(lab));
}

static bool of_size(const Lab *lab, double size, const char *what) {
    add(size, 0, 0.1 * size, -0.5 * size, 0.9 * size, 0, -0.5 * size, -0.9 * size, 0.2 * size);
    for (size_t i = 0; i < RAYS; ++i) {
        double way[3];
        lab_direction(&state, way);
        for (int a = 0; a < 3; ++a) way[a] *= size * between(0.5, 5);
        aim_at_triangle(rays + i * RAY_REALS, way, 0.5);
    }
    run(lab);
    return judge(lab, what, score(1e-5), RAYS / 10, lab->refined_double ? 1e-9 : 1e-5);
}
static bool tiny(const Lab *lab) {
    return of_size(lab, 1e-9, "size 1e-9");
}
static bool huge(const Lab *lab) {
    return of_size(lab, 0.99e9, "size 1e9");
}

/* From the middle of a cube along all axes and diagonals, with zeros of both signs: through vertices, middles
 * of edges and diagonals. */
static bool along_axes(const Lab *lab) {
    for (int axis = 0; axis < 3; ++axis)
        for (int side = -1; side <= 1; side += 2) {
            double corner[4][3];
            for (int k = 0; k < 4; ++k) {
                corner[k][axis] = side;
                corner[k][(axis + 1) % 3] = k == 1 || k == 2 ? 1 : -1;
                corner[k][(axis + 2) % 3] = k >= 2 ? 1 : -1;
            }
            for (int half = 0; half < 2; ++half) {
                const double *b = corner[1 + half], *c = corner[2 + half], *a = corner[0];
                add(a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]);
            }
        }
    size_t wrong = 0;
    memset(rays, 0, sizeof rays);
    for (size_t i = 0; i < RAYS; ++i) {
        double *d = rays + i * RAY_REALS + RAY_DIRECTION;
        size_t digits = i % 125; /* of each: -1, -0, 0, 1, 1/2 */
        for (int a = 0; a < 3; ++a, digits /= 5) d[a] = (const double[]){-1, -0.0, 0, 1, 0.5}[digits % 5];
        if (d[0] == 0 && d[1] == 0 && d[2] == 0) d[2] = 1;
    }
    run(lab);
    for (size_t i = 0; i < RAYS; ++i) {
        const double *d = rays + i * RAY_REALS + RAY_DIRECTION, *row = out + i * TURN_REALS;
        const double t = 1 / fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2])));
        wrong += row[TURN_MET] < 0 || fabs(row[TURN_T] - t) > 1e-6 * t;
    }
    printf("%s, along axes and diagonals: %zu wrong\n", lab->name, wrong);
    return wrong == 0;
}

/* The origin's high part lies in a plane of many triangles, whose boxes have no thickness; its low part above
 * or below it. */
static bool no_thickness(const Lab *lab) {
    if (fine) return true; /* no low part of this size there */
    add_square(16, 1);
    size_t wrong = 0;
    for (size_t i = 0; i < RAYS; ++i) {
        double *ray = rays + i * RAY_REALS;
        const double height = (i % 2 == 0 ? 1 : -1) * lab_float(1e-9 * between(0.5, 1));
        const double from[3] = {between(-0.9, 0.9), between(-0.9, 0.9), 0};
        double way[3];
        lab_direction(&state, way);
        way[2] = i % 4 < 2 ? fabs(way[2]) + 0.1 : -fabs(way[2]) - 0.1;
        for (int a = 0; a < 3; ++a) way[a] += from[a];
        turns_aim(fine, ray, from, way);
        ray[RAY_LOW + 2] = height;
    }
    run(lab);
    for (size_t i = 0; i < RAYS; ++i) {
        const double *ray = rays + i * RAY_REALS, *row = out + i * TURN_REALS;
        const double t = -ray[RAY_LOW + 2] / ray[RAY_DIRECTION + 2];
        wrong += (row[TURN_MET] >= 0) != (t > 0) || (t > 0 && fabs(row[TURN_T] / t - 1) > 1e-6);
    }
    printf("%s, a box of no thickness: %zu wrong\n", lab->name, wrong);
    return wrong == 0;
}

/* From the origin to edges in a plane of many triangles, along which the boxes of leaves and nodes end. */
static bool edges_of_boxes(const Lab *lab) {
    const double from[3] = {0, 0, 0};
    add_square(16, 1);
    for (size_t f = 0; f < triangle_count; ++f)
        for (int k = 0; k < 3; ++k) triangles[f].vertices[k][2] = -0.75;
    for (size_t i = 0; i < RAYS; ++i) {
        const double(*v)[3] = (const double(*)[3])triangles[lab_bits(&state) % triangle_count].vertices;
        const double s = between(0, 1);
        double to[3];
        for (int a = 0; a < 3; ++a) to[a] = v[0][a] + s * (v[1 + i % 2][a] - v[0][a]);
        if (fabs(to[0]) > 0.99 || fabs(to[1]) > 0.99) to[0] = to[1] = 0;
        turns_aim(fine, rays + i * RAY_REALS, from, to);
    }
    run(lab);
    size_t lost = 0;
    for (size_t i = 0; i < RAYS; ++i) lost += out[i * TURN_REALS + TURN_MET] < 0;
    printf("%s, edges of flat boxes: %zu lost\n", lab->name, lost);
    return lost == 0;
}

/* Two planes that meet at an edge, at all angles; the edge is aimed at from between them, and what leaves
 * between the planes' outer sides, beyond the other plane, must meet that. */
static bool concave_edge(const Lab *lab) {
    size_t passed = 0, turns = 0;
    for (int step = 0; step < 8; ++step) {
        const double angle = 0.1 + 0.35 * step, x = lab_float(cos(angle)), z = lab_float(sin(angle));
        triangle_count = 0;
        add(0, -1, 0, 1, -1, 0, 1, 1, 0); /* the ground, whose other half shares the diagonal */
        add(0, -1, 0, 1, 1, 0, 0, 1, 0);
        add(0, -1, 0, 0, 1, 0, x, 1, z);
        add(0, -1, 0, x, 1, z, x, -1, z);
        for (size_t i = 0; i < RAYS; ++i) {
            const double part = angle * between(0.2, 0.8),
                         from[3] = {0.5 * cos(part), between(-0.5, 0.5), 0.5 * sin(part)};
            const double to[3] = {0, between(-0.9, 0.9), 0};
            double *d = directions + 3 * i;
            turns_aim(fine, rays + i * RAY_REALS, from, to);
            lab_direction(&state, d);
            d[1] *= 0.1; /* so that it ends at the planes and not beside them */
            lab_float_unit(d);
        }
        run(lab);
        for (size_t i = 0; i < RAYS; ++i) {
            const double *row = out + i * TURN_REALS, *d = directions + 3 * i;
            if (row[TURN_MET] < 0) {
                ++passed;
                continue;
            }
            /* Heights over both planes, on the side from which the edge is seen. */
            const double over_ground = d[2], over_wall = d[0] * z - d[2] * x;
            const bool on_ground = row[TURN_MET] < 2;
            const double over_own = on_ground ? over_ground : over_wall,
                         over_other = on_ground ? over_wall : over_ground;
            if (fabs(over_own) < 1e-6 || fabs(over_other) < 1e-6 || over_own < 0) continue;
            ++turns;
            /* From the edge, whoever heads below the other plane meets it at once, else nothing. */
            passed += (row[TURN_NEXT] >= 0) != (over_other < 0);
            passed += over_other < 0 &&
                      ((row[TURN_NEXT] < 2) == on_ground || fabs(row[TURN_NEXT_T] * over_other) > 1e-6);
        }
    }
    printf("%s, concave edges: %zu turns, %zu passed\n", lab->name, turns, passed);
    return passed == 0 && turns > RAYS;
}

/* Whatever lies in the plane that is left: neighbours, at their edges, vertices and diagonals, and a copy in
 * the same place. */
static bool left_plane(const Lab *lab, const char *what) {
    size_t met = 0, lost = 0;
    for (size_t i = 0; i < RAYS; ++i) {
        const double from[3] = {between(-1, 1), between(-1, 1), 1};
        const double(*v)[3] = (const double(*)[3])triangles[lab_bits(&state) % triangle_count].vertices;
        const double s = i % 3 == 0 ? 0 : between(0, 1);
        double to[3];
        for (int a = 0; a < 3; ++a) to[a] = v[0][a] + s * (v[1 + i % 2][a] - v[0][a]);
        if (fabs(to[0]) > 0.99 || fabs(to[1]) > 0.99) to[0] = to[1] = 0;
        turns_aim(fine, rays + i * RAY_REALS, from, to);
        lab_direction(&state, directions + 3 * i);
        if (i % 4 == 0) directions[3 * i + 2] *= 1e-4;
        lab_float_unit(directions + 3 * i);
    }
    run(lab);
    for (size_t i = 0; i < RAYS; ++i) {
        const double *row = out + i * TURN_REALS;
        lost += row[TURN_MET] < 0;
        met += row[TURN_NEXT] >= 0;
    }
    printf("%s, %s: %zu lost, %zu met again\n", lab->name, what, lost, met);
    return met == 0 && lost == 0;
}
static bool diagonal(const Lab *lab) {
    add_square(1, 1);
    return left_plane(lab, "the diagonal of a quad");
}
static bool coplanar(const Lab *lab) {
    add_square(8, 1);
    return left_plane(lab, "neighbours in one plane");
}
static bool duplicate(const Lab *lab) {
    add_square(2, 1);
    add_square(2, 1);
    bool right = left_plane(lab, "two in one place");
    for (size_t i = 0; i < RAYS; ++i) /* the earlier of two is met */
        right = right && out[i * TURN_REALS + TURN_MET] < 8;
    return right;
}

/* ---- balls on triangles ---- */

/* A square around a point, in two triangles, whose diagonal passes through it. */
static void add_face(const double middle[3], const double u[3], const double v[3]) {
    double at[4][3];
    for (int k = 0; k < 4; ++k)
        for (int a = 0; a < 3; ++a)
            at[k][a] = middle[a] + (k == 1 || k == 2 ? u[a] : -u[a]) + (k >= 2 ? v[a] : -v[a]);
    for (int half = 0; half < 2; ++half) {
        const double *b = at[1 + half], *c = at[2 + half];
        add(at[0][0], at[0][1], at[0][2], b[0], b[1], b[2], c[0], c[1], c[2]);
    }
}

static void put_ball(double x, double y, double z, double radius) {
    const double center[3] = {x, y, z};
    ball = (BpSphere){.radius = lab_float(radius), .albedo = BP_NO_ALBEDO};
    for (int a = 0; a < 3; ++a) ball.center[a] = lab_float(center[a]);
    ball_count = 1;
}

/* From within the ball to where it touches each face, and beside that by `least` to `most` radii, and out of
 * it there, or back into it. What is met next is compared with the ray in 113 bits from the exact place: a
 * face that the origin lies on is met at once. Faces are pairs of triangles, and face f is touched at
 * `at[f]`. */
static bool leave_ball(const Lab *lab, const char *what, size_t faces, const double (*at)[3], double least,
                       double most) {
    const double r = ball.radius;
    const double sphere[4] = {ball.center[0], ball.center[1], ball.center[2], r};
    size_t turns = 0, at_once = 0, through = 0, wrong = 0, apart = 0;
    for (size_t i = 0; i < RAYS; ++i) {
        const size_t face = lab_bits(&state) % faces;
        const double part = most * r * pow(10, i % 3 == 0 ? 0 : between(log10(least / most), 0));
        double from[3], to[3], n[3], way[3], *d = directions + 3 * i;
        for (int a = 0; a < 3; ++a) n[a] = (at[face][a] - ball.center[a]) / r;
        lab_direction(&state, from);
        lab_direction(&state, way);
        lab_direction(&state, d);
        const double lean = lab_dot(way, n), down = lab_dot(d, n);
        for (int a = 0; a < 3; ++a) {
            from[a] = ball.center[a] + 0.7 * r * from[a];
            to[a] = at[face][a] + part * (way[a] - lean * n[a]) / sqrt(1 - lean * lean);
            if (i % 4 == 0) d[a] += (1e-4 - 1) * down * n[a]; /* grazing */
        }
        turns_aim(fine, rays + i * RAY_REALS, from, to);
        lab_float_unit(d);
    }
    run(lab);
    for (size_t i = 0; i < RAYS; ++i) {
        const double *ray = rays + i * RAY_REALS, *row = out + i * TURN_REALS;
        if (row[TURN_MET] != 0) continue; /* a face, by rounding before the ball's own surface */
        const Exact exact = exact_roots(ray, sphere);
        Wide origin[3], d[3], w[3], t = 0, best = 1e30;
        double outward[3], lean = 0;
        bool outside = false, unsure = false;
        long expected = -1;
        for (int a = 0; a < 3; ++a) {
            origin[a] =
                (Wide)ray[RAY_HIGH + a] + (Wide)ray[RAY_LOW + a] + exact.far * (Wide)ray[RAY_DIRECTION + a];
            d[a] = (Wide)directions[3 * i + (size_t)a];
            outward[a] = (double)(origin[a] - (Wide)ball.center[a]) / r;
        }
        const double leaves = lab_dot(outward, directions + 3 * i);
        if (fabs(leaves) < 1e-6) continue; /* rounding may turn it to the other side */
        if (leaves < 0) {                  /* to the end of a chord, unless a face cuts it */
            best = (Wide)(-2 * r * leaves);
            expected = 0;
        }
        for (size_t f = 0; f < triangle_count; ++f) {
            const BpTriangle *triangle = &triangles[f];
            double u[3], v[3], n[3], to_ball[3];
            for (int a = 0; a < 3; ++a) {
                u[a] = triangle->vertices[1][a] - triangle->vertices[0][a];
                v[a] = triangle->vertices[2][a] - triangle->vertices[0][a];
                to_ball[a] = ball.center[a] - triangle->vertices[0][a];
            }
            lab_cross(u, v, n);
            const double heads = lab_dot(n, directions + 3 * i), cosine = fabs(heads) / sqrt(lab_dot(n, n));
            const bool from_ball = heads * lab_dot(n, to_ball) < 0;
            const Wide near = 4 * (Wide)row[TURN_ERROR];
            unsure = unsure || near > (Wide)cosine; /* along its plane, which is met anywhere */
            if (!turns_passes(triangle, origin, d, 1e-9, w, &t, &outside)) continue;
            /* In its plane: met from the ball's side. Where a chord ends: rounding may take either first. */
            if (t * (Wide)cosine < (from_ball ? -near : near)) continue;
            unsure = unsure || (leaves < 0 && wide_abs(t - best) * (Wide)cosine < near);
            if (t >= best) continue;
            best = t;
            lean = cosine;
            expected = (long)(f / 2) + 1;
        }
        if (unsure) continue;
        const long next = row[TURN_NEXT] < 1 ? (long)row[TURN_NEXT] : (long)(row[TURN_NEXT] + 1) / 2;
        const double off = fabs(row[TURN_NEXT_T] - fmax((double)best, 0)) * lean;
        ++turns;
        at_once += next > 0 && row[TURN_NEXT_T] == 0;
        through += next < expected;
        wrong += next != expected;
        apart += next > 0 && off > 4 * row[TURN_ERROR] + 1e-6 * fabs((double)best) * lean;
    }
    printf("%s, %s: %zu turns, %zu at once, %zu through, %zu wrong, %zu at another distance\n", lab->name,
           what, turns, at_once, through, wrong, apart);
    return turns > RAYS / 4 && at_once > 0 && wrong == 0 && apart == 0;
}

/* Touched at the floor's diagonal, and in the middle of one of its triangles. */
static bool ball_on_a_floor(const Lab *lab) {
    const double u[3] = {900, 0, 0}, v[3] = {0, 900, 0}, middle[3] = {100, 40, -7},
                 at[2][3] = {{100, 40, -7}, {350, 40, -7}};
    bool right = true;
    add_face(middle, u, v);
    for (int k = 0; k < 2; ++k) {
        put_ball(at[k][0], at[k][1], -7 + 1.5, 1.5);
        right = leave_ball(lab, k == 0 ? "a ball on a floor's diagonal" : "a ball on a floor", 1, &at[k],
                           1e-13, 1e-3) &&
                right;
    }
    return right;
}

/* By less than a float can place it: the floor is met in a circle. */
static bool ball_that_dips(const Lab *lab) {
    const double u[3] = {900, 0, 0}, v[3] = {0, 900, 0}, at[1][3] = {{100, 40, -7}};
    add_face(at[0], u, v);
    put_ball(100, 40, -7 + 1.5, 1.5);
    ball.radius = 1.5 + 0x1p-22;
    const double circle = sqrt(ball.radius * ball.radius - 1.5 * 1.5) / ball.radius;
    return leave_ball(lab, "a ball that dips into a floor", 1, at, circle, circle * (1 + 1e-9));
}

/* Three faces at right angles that lean, and a point on each that has whole numbers. */
static bool ball_in_a_corner(const Lab *lab) {
    static const double n[3][3] = {{1, 2, 2}, {2, 1, -2}, {2, -2, 1}};
    const double corner[3] = {-60, 11, 35};
    double at[3][3];
    put_ball(corner[0] + 5, corner[1] + 1, corner[2] + 1, 3);
    for (int f = 0; f < 3; ++f) {
        double u[3], v[3], middle[3];
        for (int a = 0; a < 3; ++a) {
            at[f][a] = ball.center[a] - n[f][a];
            u[a] = 2 * n[(f + 1) % 3][a];
            v[a] = 2 * n[(f + 2) % 3][a];
            middle[a] = corner[a] + u[a] + v[a];
        }
        add_face(middle, u, v);
    }
    return leave_ball(lab, "a ball in a corner", 3, (const double(*)[3])at, 1e-13, 1e-3);
}

int main(int argc, char **argv) {
    static bool (*const cases[])(const Lab *) = {small_from_afar,
                                                 far_from_the_camera,
                                                 ground,
                                                 leaning_ground,
                                                 on_their_planes,
                                                 in_its_plane,
                                                 grazing,
                                                 sliver,
                                                 tiny,
                                                 huge,
                                                 along_axes,
                                                 no_thickness,
                                                 edges_of_boxes,
                                                 concave_edge,
                                                 diagonal,
                                                 coplanar,
                                                 duplicate,
                                                 ball_on_a_floor,
                                                 ball_that_dips,
                                                 ball_in_a_corner};
    Lab lab;
    int failed = 0;
    if (argc != 2) {
        fprintf(stderr, "usage: hard_triangle_cases double|float|all-double\n");
        return 2;
    }
    if (!lab_open(&lab, argv[1])) return 77;
    fine = lab.real_double;
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; ++c) {
        triangle_count = ball_count = 0;
        for (size_t i = 0; i < 3 * RAYS; ++i) directions[i] = i % 3 == 2 ? 1 : 0;
        if (!cases[c](&lab)) {
            printf("  WRONG\n");
            ++failed;
        }
    }
    lab_close(&lab);
    return failed > 0 ? 1 : 0;
}
