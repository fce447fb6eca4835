/* test_winding.c: how often closed surfaces wind around a point, against whole numbers, in which nothing is
 * rounded.
 *
 * Corners are small whole numbers, so that vertices and edges often stand in the way of the ray that is
 * counted along, times a scale that is none, and nearly flat ones in which products nearly cancel. */
#include "packed/winding.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

typedef struct Place {
    int64_t at[3];
} Place;

static uint64_t state = 1;

static int64_t chance(int64_t count) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (int64_t)(state >> 33) % count;
}

/* Six times the volume of the tetrahedron of three points and a fourth. */
static int64_t volume(const Place *a, const Place *b, const Place *c, const Place *d) {
    int64_t m[3][3];
    for (int i = 0; i < 3; i++) {
        m[0][i] = a->at[i] - d->at[i];
        m[1][i] = b->at[i] - d->at[i];
        m[2][i] = c->at[i] - d->at[i];
    }
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

static int crossing(const Place *a, const Place *b, const Place *c, const Place *point, double scale) {
    const Place *corners[3] = {a, b, c};
    double at[3][3];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) at[k][i] = scale * (double)(corners[k]->at[i] - point->at[i]);
    return bp_axis_crossing(at[0], at[1], at[2]);
}

/* Of tetrahedra: all four volumes that a point makes with the faces have one sign inside. */
static void tetrahedra(void **unused) {
    (void)unused;
    unsigned inside = 0, outside = 0, aligned = 0;
    for (int i = 0; i < 400000; i++) {
        Place v[5];
        const int64_t range = i % 4 == 3 ? 1000000 : 7; /* volumes below 2^63 */
        for (int k = 0; k < 5; k++)
            for (int a = 0; a < 3; a++) v[k].at[a] = chance(range);
        if (i % 3 == 0) /* beside the middle of a side */
            for (int a = 0; a < 3; a++)
                v[4].at[a] = (v[0].at[a] + v[1].at[a] + v[2].at[a]) / 3 + chance(3) - 1;
        const int64_t whole = volume(&v[0], &v[1], &v[2], &v[3]);
        const int64_t parts[4] = {volume(&v[4], &v[1], &v[2], &v[3]), volume(&v[0], &v[4], &v[2], &v[3]),
                                  volume(&v[0], &v[1], &v[4], &v[3]), volume(&v[0], &v[1], &v[2], &v[4])};
        bool is_inside = true, is_on = false;
        for (int k = 0; k < 4; k++) {
            is_inside = is_inside && parts[k] != 0 && (parts[k] > 0) == (whole > 0);
            is_on = is_on || parts[k] == 0;
        }
        if (whole == 0) continue;
        bool on_surface = is_on;
        for (int k = 0; k < 4; k++)
            on_surface = on_surface && (parts[k] == 0 || (parts[k] > 0) == (whole > 0));
        if (on_surface) continue;
        for (int k = 0; k < 4; k++) aligned += v[k].at[1] == v[4].at[1] && v[k].at[2] == v[4].at[2];
        const double scale = i % 2 == 0 ? 1 : 0x1.6a09e667f3bcdp-13;
        const int sum =
            crossing(&v[0], &v[1], &v[2], &v[4], scale) + crossing(&v[0], &v[3], &v[1], &v[4], scale) +
            crossing(&v[1], &v[3], &v[2], &v[4], scale) + crossing(&v[2], &v[3], &v[0], &v[4], scale);
        /* Where the volume is positive, the first three corners run counter-clockwise, seen from outside. */
        assert_int_equal(sum, is_inside ? (whole > 0 ? 1 : -1) : 0);
        inside += is_inside;
        outside += !is_inside;
    }
    assert_true(inside > 5000 && outside > 100000 && aligned > 1000);
}

/* The sign of a volume that is 2^-52 of the products that it is made of: a plane that passes the origin at
 * such a distance. */
static void nearly_through_the_origin(void **unused) {
    (void)unused;
    static const double around[3][2] = {{3, -1}, {-1, 3}, {-1, -2}};
    for (int side = -1; side <= 1; side++) {
        double at[3][3];
        for (int k = 0; k < 3; k++) {
            at[k][1] = 0x1p25 * around[k][0];
            at[k][2] = 0x1p25 * around[k][1];
            at[k][0] = at[k][1] / 4 + side * 0x1p-27;
        }
        assert_int_equal(bp_axis_crossing(at[0], at[1], at[2]), side > 0 ? 1 : 0);
        assert_int_equal(bp_axis_crossing(at[0], at[2], at[1]), side > 0 ? -1 : 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(tetrahedra),
                                       cmocka_unit_test(nearly_through_the_origin)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
