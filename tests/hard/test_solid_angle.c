/* test_solid_angle.c: the solid angle of a triangle, and directions to it, against 113 bits.
 *
 *     hard_solid_angle double|float|all-double
 *
 * Triangles of a millionth to a million times their distance, half of them slivers, from points at random and
 * from points near their plane. Exit code 1: a solid angle or a direction is off by more than it may be. */
#define BP_HOST
#include "lab.h"
#include "oracle.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { COUNT = 200000, DECADES = 12, ROW = 8 };

static double points[COUNT * ROW], corners[COUNT * 9], out[COUNT * 5];

static void difference(const double *p, const double *q, Wide v[3]) {
    for (int a = 0; a < 3; ++a) v[a] = (Wide)p[a] - ((Wide)q[a] + (Wide)q[3 + a]);
}

static void cross(const Wide a[3], const Wide b[3], Wide n[3]) {
    n[0] = a[1] * b[2] - a[2] * b[1];
    n[1] = a[2] * b[0] - a[0] * b[2];
    n[2] = a[0] * b[1] - a[1] * b[0];
}

/* By the three angles of the spherical triangle where it is large, by the tangent of its half in any case:
 * with 113 bits both hold; the second one is taken. */
static double exact_solid_angle(const Wide v[3][3]) {
    Wide n[3], length[3];
    cross(v[1], v[2], n);
    for (int k = 0; k < 3; ++k) length[k] = wide_sqrt(wide_dot(v[k], v[k]));
    const Wide volume = wide_abs(wide_dot(v[0], n));
    const Wide sum = length[0] * length[1] * length[2] + wide_dot(v[0], v[1]) * length[2] +
                     wide_dot(v[1], v[2]) * length[0] + wide_dot(v[2], v[0]) * length[1];
    return 2 * (double)atan2l((long double)(volume / length[0]), (long double)(sum / length[0]));
}

/* How far outside of the triangle a direction is, in radians. */
static double outside(const Wide v[3][3], const double direction[3]) {
    const Wide d[3] = {(Wide)direction[0], (Wide)direction[1], (Wide)direction[2]};
    Wide n[3];
    cross(v[1], v[2], n);
    const double side = wide_dot(v[0], n) < 0 ? -1 : 1;
    double worst = 0;
    for (int k = 0; k < 3; ++k) {
        cross(v[k], v[(k + 1) % 3], n);
        const Wide length = wide_sqrt(wide_dot(n, n));
        if (length > 0) worst = fmax(worst, -side * (double)(wide_dot(d, n) / length));
    }
    return worst;
}

static void make(uint64_t *state, size_t i) {
    const double size = pow(10, DECADES * ((double)i / COUNT) - DECADES / 2.0);
    const bool sliver = i % 2 == 1, low = i % 8 >= 6;
    double center[3], way[3][3], *row = points + i * ROW, *triangle = corners + i * 9;
    lab_direction(state, center);
    for (int k = 0; k < 3; ++k) lab_direction(state, way[k]);
    const double thin = sliver ? pow(10, -4 * lab_unit(state)) : 1;
    const double lift = low ? pow(10, -4 * lab_unit(state)) : 1; /* the second half of the way to the plane */
    for (int a = 0; a < 3; ++a) {
        triangle[a] = lab_float(center[a] + size * way[0][a]);
        triangle[3 + a] = lab_float(center[a] + size * way[1][a]);
        triangle[6 + a] = lab_float(triangle[3 + a] + thin * size * (way[2][a] - way[1][a]));
        const double middle = (triangle[a] + triangle[3 + a] + triangle[6 + a]) / 3;
        const double place = (1 - lift) * middle;
        row[a] = lab_float(place);
        row[3 + a] = lab_float(place - row[a]);
    }
    row[6] = lab_float(0.999 * lab_unit(state));
    row[7] = lab_float(0.999 * lab_unit(state));
}

int main(int argc, char **argv) {
    Lab lab;
    if (argc != 2 || !lab_open(&lab, argv[1])) return argc == 2 ? 77 : 2;
    uint64_t state = 5;
    for (size_t i = 0; i < COUNT; ++i) make(&state, i);
    const LabArgument arguments[] = {
        {LAB_REALS, points, COUNT * ROW}, {LAB_REALS, corners, COUNT * 9}, {LAB_OUT_REFINED, out, COUNT * 5}};
    lab_run(&lab, "probe_solid_angle", COUNT, arguments, 3, NULL);
    bool right = true;
    for (int decade = 0; decade < DECADES; ++decade) {
        const size_t first = (size_t)decade * COUNT / DECADES, end = (size_t)(decade + 1) * COUNT / DECADES;
        size_t seen = 0, flat = 0;
        double worst = 0, sum = 0, worst_outside = 0;
        for (size_t i = first; i < end; ++i) {
            Wide v[3][3], n[3], e[3], f[3];
            for (int k = 0; k < 3; ++k) difference(corners + i * 9 + 3 * k, points + i * ROW, v[k]);
            const double exact = exact_solid_angle((const Wide(*)[3])v);
            if (out[i * 5] == 0) {
                for (int a = 0; a < 3; ++a) {
                    e[a] = v[1][a] - v[0][a];
                    f[a] = v[2][a] - v[0][a];
                }
                cross(e, f, n);
                const Wide height = wide_abs(wide_dot(v[0], n)), area = wide_sqrt(wide_dot(n, n));
                /* Of what is not sampled, all lies near the plane or beside an edge, or is too small to hold.
                 */
                const bool near_plane = height <= 0x1p-15 * area * wide_sqrt(wide_dot(v[0], v[0]));
                double angle = 0;
                for (int k = 0; k < 3; ++k) {
                    const Wide *a = v[k], *b = v[(k + 1) % 3];
                    const Wide cosine = wide_dot(a, b) / wide_sqrt(wide_dot(a, a) * wide_dot(b, b));
                    angle = fmax(angle, acos(fmax(-1, (double)cosine)));
                }
                flat += !(near_plane || angle > 3.12 || exact < 0x1p-80);
                continue;
            }
            ++seen;
            const double error = fabs(out[i * 5 + 1] * 6.283185307179586 / exact - 1);
            worst = fmax(worst, error);
            sum += error;
            worst_outside = fmax(worst_outside, outside((const Wide(*)[3])v, out + i * 5 + 2));
        }
        printf("%s, size over distance 1e%+d: %zu sampled, solid angles to %.1e (mean %.1e), directions "
               "outside by %.1e; %zu left "
               "out for no reason\n",
               lab.name, decade - DECADES / 2, seen, worst, seen > 0 ? sum / (double)seen : 0, worst_outside,
               flat);
        right = right && flat == 0 && worst <= 1e-6 && worst_outside <= 2e-7;
    }
    lab_close(&lab);
    return right ? 0 : 1;
}
