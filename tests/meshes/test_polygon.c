/* test_polygon.c: polygons cut into triangles, beside counting by brute force: where a point lies in as many
 * triangles as the outline goes around it, the cut is right. */
#include "base/orient.h"
#include "meshes/polygon.h"
#include "support/unit_test.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CORNERS_MAX = 512 };
/* Sanitizers take forty times as long, and look for other faults than wrong areas. */
#ifdef __SANITIZE_ADDRESS__
enum { ROUNDS = 20000 };
#else
enum { ROUNDS = 400000 };
#endif

__extension__ typedef __int128 Wide;

typedef struct Outline {
    int count;
    int at[CORNERS_MAX][2];
} Outline;

static uint64_t state = 88172645463325252u;

static unsigned draw(unsigned below) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (unsigned)((state >> 20) % below);
}

/* ---- brute force -------------------------------------------------------------------------------------- */

/* How often an outline goes around a point, by the crossings of a ray to the right. */
static int winding(const Outline *o, double x, double y) {
    int turns = 0;
    for (int i = 0; i < o->count; i++) {
        const int *const a = o->at[i], *const b = o->at[(i + 1) % o->count];
        if ((a[1] > y) == (b[1] > y)) continue;
        const double at = a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1]);
        if (at > x) turns += b[1] > a[1] ? 1 : -1;
    }
    return turns;
}

static int64_t twice_area(const Outline *o) {
    int64_t area = 0;
    for (int i = 0; i < o->count; i++) {
        const int *const a = o->at[i], *const b = o->at[(i + 1) % o->count];
        area += (int64_t)a[0] * b[1] - (int64_t)a[1] * b[0];
    }
    return area;
}

static int side(const int *a, const int *b, const int *c) {
    const int64_t s = (int64_t)(b[0] - a[0]) * (c[1] - a[1]) - (int64_t)(b[1] - a[1]) * (c[0] - a[0]);
    return (s > 0) - (s < 0);
}

static bool is_between(const int *a, const int *b, const int *p) {
    return side(a, b, p) == 0 && (p[0] - a[0]) * (p[0] - b[0]) <= 0 && (p[1] - a[1]) * (p[1] - b[1]) <= 0;
}

static bool do_touch(const int *a, const int *b, const int *c, const int *d) {
    if (is_between(a, b, c) || is_between(a, b, d) || is_between(c, d, a) || is_between(c, d, b)) return true;
    return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

/* Whether no two edges meet but neighbours at their corner. */
static bool is_simple(const Outline *o) {
    for (int i = 0; i < o->count; i++) {
        const int *const a = o->at[i], *const b = o->at[(i + 1) % o->count],
                         *const c = o->at[(i + 2) % o->count];
        if ((a[0] == b[0] && a[1] == b[1]) || is_between(a, b, c) || is_between(b, c, a)) return false;
        for (int j = i + 2; j < o->count - (i == 0); j++)
            if (do_touch(a, b, o->at[j], o->at[(j + 1) % o->count])) return false;
    }
    return true;
}

/* ---- the cut ------------------------------------------------------------------------------------------ */

/* Cuts the outline in a plane in space: `axis` is that which depends on the other two. */
static PolygonResult cut(PolygonCutter *cutter, const Outline *o, int axis, bool backwards) {
    double positions[CORNERS_MAX][3];
    uint32_t vertices[CORNERS_MAX];
    for (int i = 0; i < o->count; i++) {
        const double u = o->at[i][0], v = o->at[i][1];
        positions[i][(axis + 1) % 3] = u;
        positions[i][(axis + 2) % 3] = v;
        positions[i][axis] = 0.25 * u - 0.5 * v + 3;
        vertices[i] = (uint32_t)(backwards ? o->count - 1 - i : i);
    }
    return polygon_cut(cutter, (const double(*)[3])positions, vertices, (size_t)o->count);
}

/* Every sample point lies in as many triangles as the outline goes around it, which is 0 or 1, and the areas
 * add up. `sign`: that of the triangles' areas. */
static void check_cover(const PolygonCutter *cutter, const Outline *o, int sign, int low, int high) {
    int64_t area = 0;
    const int turned = twice_area(o) > 0 ? 1 : -1;
    Outline *const triangles = calloc(cutter->triangle_count + 1, sizeof *triangles);
    assert_non_null(triangles);
    for (size_t t = 0; t < cutter->triangle_count; t++) {
        triangles[t].count = 3;
        for (int i = 0; i < 3; i++)
            memcpy(triangles[t].at[i], o->at[cutter->triangles[t][i]], sizeof triangles[t].at[i]);
        const int64_t one = twice_area(&triangles[t]);
        assert_true(sign * one > 0);
        area += one;
    }
    assert_int_equal(area, sign * turned * twice_area(o));
    for (int x = low; x < high; x++) {
        for (int y = low; y < high; y++) {
            const double px = x + 0.3183098861, py = y + 0.5772156649;
            int covers = 0;
            for (size_t t = 0; t < cutter->triangle_count; t++) covers += abs(winding(&triangles[t], px, py));
            const int turns = turned * winding(o, px, py);
            assert_true(turns == 0 || turns == 1);
            assert_int_equal(covers, turns);
        }
    }
    free(triangles);
}

static void check_all_ways(const Outline *o, bool is_whole, int low, int high) {
    PolygonCutter cutter = {0};
    const int sign = twice_area(o) > 0 ? 1 : -1;
    for (int way = 0; way < 6; way++) {
        assert_int_equal(cut(&cutter, o, way / 2, way % 2 == 1), POLYGON_CUT);
        if (is_whole) assert_int_equal(cutter.triangle_count, o->count - 2);
        check_cover(&cutter, o, way % 2 == 1 ? -sign : sign, low, high);
    }
    polygon_clear(&cutter);
}

/* ---- cases -------------------------------------------------------------------------------------------- */

static void outlines_by_hand(void **unused) {
    (void)unused;
    static const Outline l = {6, {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}};
    static const Outline flat = {7, {{0, 0}, {2, 0}, {4, 0}, {4, 2}, {4, 4}, {2, 4}, {0, 4}}};
    static const Outline arrow = {4, {{0, 0}, {4, 4}, {0, 2}, {-4, 4}}};
    /* A square with a square hole, joined by an edge that is walked both ways. */
    static const Outline holed = {
        10, {{0, 0}, {8, 0}, {8, 8}, {0, 8}, {0, 0}, {2, 2}, {2, 6}, {6, 6}, {6, 2}, {2, 2}}};
    /* Two squares that touch at a corner. */
    static const Outline touching = {8, {{0, 0}, {3, 0}, {3, 3}, {6, 3}, {6, 6}, {3, 6}, {3, 3}, {0, 3}}};
    /* Two triangles that touch at the first corner, where an ear of both would have the edges of both inside.
     */
    static const Outline pair = {6, {{0, 1}, {1, 0}, {3, 3}, {0, 1}, {2, 3}, {0, 3}}};
    check_all_ways(&pair, false, -1, 5);
    check_all_ways(&l, true, -1, 5);
    check_all_ways(&flat, true, -1, 5);
    check_all_ways(&arrow, true, -5, 5);
    check_all_ways(&holed, true, -1, 9);
    check_all_ways(&touching, false, -1, 7);
    PolygonCutter cutter = {0};
    assert_int_equal(cut(&cutter, &touching, 0, false), POLYGON_CUT);
    assert_int_equal(cutter.triangle_count, 4); /* two for each square */
    polygon_clear(&cutter);
}

static void combs_and_spirals(void **unused) {
    (void)unused;
    Outline comb = {.count = 0}, spiral = {.count = 0};
    for (int i = 0; i < 40; i++) {
        memcpy(comb.at[comb.count++], (int[2]){2 * i, 0}, sizeof comb.at[0]);
        memcpy(comb.at[comb.count++], (int[2]){2 * i + 1, i % 5 == 0 ? 1 : 20 + i % 3}, sizeof comb.at[0]);
    }
    memcpy(comb.at[comb.count++], (int[2]){80, -3}, sizeof comb.at[0]);
    memcpy(comb.at[comb.count++], (int[2]){0, -3}, sizeof comb.at[0]);
    check_all_ways(&comb, true, -4, 82);
    /* A square spiral, out along one side and back along the other. */
    static const int ways[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    int x = 0, y = 0, out[48][2];
    for (int i = 0; i < 48; i++) {
        out[i][0] = x, out[i][1] = y;
        x += ways[i % 4][0] * (4 * (i / 2 + 1)), y += ways[i % 4][1] * (4 * (i / 2 + 1));
    }
    for (int i = 0; i < 48; i++) memcpy(spiral.at[spiral.count++], out[i], sizeof out[i]);
    for (int i = 47; i >= 0; i--) {
        /* The other side of the wall lies to the right of the way, one further out. */
        const int *const before = ways[(i + 3) % 4], *const after = ways[i % 4];
        const int dx = (i > 0 ? before[1] : 0) + (i < 47 ? after[1] : 0);
        const int dy = -(i > 0 ? before[0] : 0) - (i < 47 ? after[0] : 0);
        memcpy(spiral.at[spiral.count++], (int[2]){out[i][0] + dx, out[i][1] + dy}, sizeof out[i]);
    }
    assert_true(is_simple(&spiral));
    check_all_ways(&spiral, true, -52, 52);
}

static void crossings_are_refused(void **unused) {
    (void)unused;
    static const Outline crossing[] = {
        {4, {{0, 0}, {4, 4}, {4, 0}, {0, 4}}},                                 /* a bow tie of equal halves */
        {4, {{0, 0}, {4, 4}, {4, 0}, {0, 1}}},                                 /* of unequal ones */
        {5, {{0, 10}, {6, -8}, {-9, 3}, {9, 3}, {-6, -8}}},                    /* five points, twice around */
        {8, {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {4, 0}, {4, 4}, {0, 4}}}, /* a square, twice around */
        {6, {{0, 0}, {6, 0}, {6, 6}, {2, -2}, {1, 6}, {0, 6}}}};
    PolygonCutter cutter = {0};
    for (size_t i = 0; i < sizeof crossing / sizeof *crossing; i++)
        for (int way = 0; way < 6; way++)
            assert_int_equal(cut(&cutter, &crossing[i], way / 2, way % 2 == 1), POLYGON_CROSSES);
    polygon_clear(&cutter);
}

static void no_area_makes_no_triangles(void **unused) {
    (void)unused;
    static const Outline none[] = {{3, {{0, 0}, {1, 1}, {2, 2}}},
                                   {4, {{0, 0}, {1, 1}, {2, 2}, {3, 3}}},
                                   {4, {{5, 5}, {5, 5}, {5, 5}, {5, 5}}},
                                   {5, {{0, 0}, {4, 8}, {1, 2}, {3, 6}, {2, 4}}},
                                   {2, {{0, 0}, {1, 0}}}};
    PolygonCutter cutter = {0};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        assert_int_equal(cut(&cutter, &none[i], 0, false), POLYGON_CUT);
        assert_int_equal(cutter.triangle_count, 0);
    }
    /* A corner twice, a spike: what has an area stays. */
    static const Outline twice = {5, {{0, 0}, {4, 0}, {4, 0}, {4, 4}, {0, 4}}};
    static const Outline spike = {6, {{0, 0}, {4, 0}, {9, 0}, {4, 0}, {4, 4}, {0, 4}}};
    check_all_ways(&twice, false, -1, 10);
    check_all_ways(&spike, false, -1, 10);
    /* Two triangles and a way between them along a line, beyond both. */
    static const Outline tail = {5, {{4, 3}, {3, 3}, {4, 2}, {2, 3}, {1, 3}}};
    check_all_ways(&tail, false, -1, 10);
    assert_int_equal(cut(&cutter, &twice, 0, false), POLYGON_CUT);
    assert_int_equal(cutter.triangle_count, 2);
    assert_int_equal(cut(&cutter, &spike, 0, false), POLYGON_CUT);
    assert_int_equal(cutter.triangle_count, 2);
    polygon_clear(&cutter);
}

/* Outlines at random: the simple ones are all cut into n - 2 triangles, and whatever is cut is covered once.
 */
static void random_outlines(void **unused) {
    (void)unused;
    int simple = 0, touching = 0, refused = 0;
    PolygonCutter cutter = {0};
    for (int round = 0; round < ROUNDS; round++) {
        Outline o = {.count = 4 + (int)draw(6)};
        const unsigned size = 4 + draw(6);
        for (int i = 0; i < o.count; i++) o.at[i][0] = (int)draw(size), o.at[i][1] = (int)draw(size);
        const bool whole = is_simple(&o);
        const int sign = twice_area(&o) > 0 ? 1 : -1;
        const PolygonResult result = cut(&cutter, &o, (int)draw(3), false);
        if (whole) {
            assert_int_equal(result, POLYGON_CUT);
            assert_int_equal(cutter.triangle_count, o.count - 2);
        }
        if (result == POLYGON_CUT) check_cover(&cutter, &o, sign, -1, (int)size + 1);
        simple += whole;
        touching += !whole && result == POLYGON_CUT;
        refused += result == POLYGON_CROSSES;
    }
    polygon_clear(&cutter);
    print_message("%d simple, %d that touch themselves, %d refused\n", simple, touching, refused);
    assert_true(simple > ROUNDS / 20 && touching > ROUNDS / 400 && refused > ROUNDS / 4);
}

/* Large outlines: around a centre at random distances, which is never simple to clip but always simple. */
static void stars(void **unused) {
    (void)unused;
    for (int round = 0; round < 20; round++) {
        Outline star = {.count = 300};
        for (int i = 0; i < star.count; i++) {
            const double angle = 2 * 3.14159265358979 * i / star.count,
                         radius = 20000 + 900000.0 * draw(1000) / 1000;
            star.at[i][0] = (int)(radius * cos(angle));
            star.at[i][1] = (int)(radius * sin(angle));
        }
        assert_true(is_simple(&star));
        check_all_ways(&star, true, -3, 3);
    }
}

static void too_many_corners(void **unused) {
    (void)unused;
    const size_t count = POLYGON_CORNERS_MAX + 2;
    double *const numbers = calloc(3 * count, sizeof *numbers);
    double(*const positions)[3] = (double(*)[3])numbers;
    uint32_t *const vertices = calloc(count, sizeof *vertices);
    assert_non_null(numbers);
    assert_non_null(vertices);
    PolygonCutter cutter = {0};
    for (size_t shape = 0; shape < 3; shape++) {
        const size_t corners = shape == 2 ? POLYGON_CORNERS_MAX : count;
        for (size_t i = 0; i < corners; i++) { /* a circle, and teeth around it */
            const double angle = 2 * 3.14159265358979 * (double)i / (double)corners;
            const double radius = shape > 0 && i % 2 == 1 ? 5 : 6;
            positions[i][0] = radius * cos(angle);
            positions[i][1] = radius * sin(angle);
            vertices[i] = (uint32_t)i;
        }
        assert_int_equal(polygon_cut(&cutter, (const double(*)[3])positions, vertices, corners),
                         shape == 1 ? POLYGON_TOO_LARGE : POLYGON_CUT);
        if (shape != 1) assert_int_equal(cutter.triangle_count, corners - 2);
    }
    polygon_clear(&cutter);
    free(numbers);
    free(vertices);
}

/* The sign beside integers of 128 bits, for points that lie nearly, or exactly, on one line. */
static void signs_are_exact(void **unused) {
    (void)unused;
    int zeros = 0, doubtful = 0;
    for (int round = 0; round < ROUNDS * 5 / 2; round++) {
        int64_t p[3][2];
        const int64_t size = (int64_t)1 << (8 + draw(40));
        const int64_t steps = (int64_t)draw(2000) - 1000;
        for (int k = 0; k < 2; k++) {
            p[0][k] = (int64_t)(draw(1u << 30) * (uint64_t)draw(1u << 30) % (uint64_t)size) - size / 2;
            p[1][k] = p[0][k] + (int64_t)draw(1000) - 500;
            p[2][k] = p[0][k] + (p[1][k] - p[0][k]) * steps + (int64_t)draw(3) - 1;
        }
        const Wide one = (Wide)(p[0][0] - p[2][0]) * (p[1][1] - p[2][1]);
        const Wide other = (Wide)(p[0][1] - p[2][1]) * (p[1][0] - p[2][0]);
        const int sign = (one > other) - (one < other);
        double at[3][2];
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 2; k++) at[i][k] = (double)p[i][k] / 1048576;
        assert_int_equal(orient(at[0], at[1], at[2]), sign);
        assert_int_equal(orient(at[1], at[0], at[2]), -sign);
        zeros += sign == 0;
    }
    /* Differences that doubles round, since one point is far nearer to 0: in units of 2^-62. */
    for (int round = 0; round < ROUNDS / 4; round++) {
        double at[3][2];
        int64_t p[3][2];
        const double steps = draw(1000) / 1000.0;
        for (int k = 0; k < 2; k++) {
            at[0][k] = ldexp((double)((int64_t)draw(1u << 30) << 23 | draw(1u << 23)), -62);
            at[1][k] = 0.5 + draw(1u << 30) / 4294967296.0;
            at[2][k] = at[1][k] + (at[1][k] - at[0][k]) * steps;
            for (int i = 0; i < 3; i++) p[i][k] = (int64_t)ldexp(at[i][k], 62);
        }
        const Wide one = (Wide)(p[0][0] - p[2][0]) * (p[1][1] - p[2][1]);
        const Wide other = (Wide)(p[0][1] - p[2][1]) * (p[1][0] - p[2][0]);
        const double rounded =
            (at[0][0] - at[2][0]) * (at[1][1] - at[2][1]) - (at[0][1] - at[2][1]) * (at[1][0] - at[2][0]);
        const int sign = (one > other) - (one < other);
        assert_int_equal(orient(at[0], at[1], at[2]), sign);
        doubtful += rounded != 0 && sign != (rounded > 0 ? 1 : -1);
    }
    assert_true(zeros > 1000);
    print_message("%d on one line, %d whose sign doubles get wrong\n", zeros, doubtful);
    assert_true(doubtful > 10);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(outlines_by_hand),      cmocka_unit_test(combs_and_spirals),
        cmocka_unit_test(crossings_are_refused), cmocka_unit_test(no_area_makes_no_triangles),
        cmocka_unit_test(random_outlines),       cmocka_unit_test(stars),
        cmocka_unit_test(too_many_corners),      cmocka_unit_test(signs_are_exact)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
