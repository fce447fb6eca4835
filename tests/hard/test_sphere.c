/* test_sphere.c: tests 1 to 10: a ray and a sphere, against 113 bits on the same float numbers. */
#include "suite.h"

#include "oracle.h"

#include <math.h>
#include <string.h>

#define RAYS 20000

/* `count` rays of the cell, on the device. */
static Score run_cell(const Lab *lab, const Cell *cell, double band, uint64_t seed) {
    Cases cases;
    cases_init(&cases, RAYS);
    cases_aim(&cases, 0, RAYS, cell, &seed);
    cases_run(lab, &cases, NULL);
    const Score score = cases_score(&cases, 0, RAYS, band);
    cases_clear(&cases);
    print_message("    r %-6g distance %-6g translation %-6g t %.2g (median %.2g) off %.2g, false hits %zu "
                  "misses %zu\n",
                  cell->radius, cell->distance, cell->translation, score.worst_t, score.median_t,
                  score.worst_off, score.false_hits, score.false_misses);
    return score;
}

static void expect_right(const Score *score, double t_limit) {
    assert_true(score->right_hits > score->rays / 3);
    assert_int_equal(score->false_hits, 0);
    assert_int_equal(score->false_misses, 0);
    assert_int_equal(score->not_finite, 0);
    assert_int_equal(score->filtered, 0);
    assert_true(score->worst_t <= t_limit);
    assert_true(score->worst_off <= 4e-7);
}

/* 1 */
static void sphere_far_small(void **state) {
    const Cell cell = {.radius = 1e-3, .distance = 1e3, .impact_high = 1.5};
    const Score score = run_cell(*state, &cell, 1e-5, 1);
    expect_right(&score, 1.2e-7);
}

/* 2 */
static void sphere_far_unit(void **state) {
    const Cell cell = {.radius = 1, .distance = 1e3, .impact_high = 1.5};
    const Score score = run_cell(*state, &cell, 1e-5, 2);
    expect_right(&score, 1.2e-7);
    /* The book's form fails on the very same rays. */
    Cases cases;
    uint64_t seed = 2;
    cases_init(&cases, RAYS);
    cases_aim(&cases, 0, RAYS, &cell, &seed);
    cases_host(FORM_BOOK, 1e-3f, &cases);
    const Score book = cases_score(&cases, 0, RAYS, 1e-2);
    print_message("    book: t %.2g (median %.2g), false hits %zu misses %zu outside 1 %% of tangency\n",
                  book.worst_t, book.median_t, book.false_hits, book.false_misses);
    assert_true(book.worst_t > 1e-5 && book.false_hits + book.false_misses > RAYS / 100);
    cases_clear(&cases);
}

/* 3 */
static void sphere_unit_1e6(void **state) {
    const Cell cell = {.radius = 1, .distance = 1e6, .impact_high = 1.5};
    const Score score = run_cell(*state, &cell, 1e-5, 3);
    expect_right(&score, 1.2e-7);
}

static void aim_at(Cases *cases, size_t item, double ox, double oy, double oz, double dx, double dy,
                   double dz, double radius) {
    const double ray[RAY_REALS] = {ox, oy, oz, 0, 0, 0, dx, dy, dz, 0};
    memcpy(cases->rays + item * RAY_REALS, ray, sizeof ray);
    cases->spheres[item * 4 + 3] = lab_float(radius);
}

/* 4: the book's ground, from 1 above it. */
static void ground_1000(void **state) {
    Cases cases;
    cases_init(&cases, 1);
    aim_at(&cases, 0, 0, 1, 0, 0, -1, 0, 1000);
    cases.spheres[1] = -1000;
    cases_run(*state, &cases, NULL);
    assert_true(cases.hits[HIT_MET] == 1 && cases.hits[HIT_ENTERS] == 1);
    assert_true(fabs(cases.hits[HIT_T] - 1) <= 2e-7);
    cases_clear(&cases);
    const Cell rotated = {.radius = 1000, .distance = 1, .impact_high = 1.2};
    const Score score = run_cell(*state, &rotated, 1e-5, 4);
    expect_right(&score, 5e-7);
}

/* 5 */
static void wall_1e5(void **state) {
    const Cell cells[] = {{.radius = 1e5, .distance = 1, .impact_high = 1.2},
                          {.radius = 1e6, .distance = 1, .impact_high = 1.2},
                          {.radius = 1e6, .distance = 1e-2, .impact_high = 0.9}};
    for (size_t i = 0; i < sizeof cells / sizeof cells[0]; ++i) {
        const Score score = run_cell(*state, &cells[i], 1e-5, 50 + i);
        expect_right(&score, 5e-7);
    }
}

/* 6: aimed within 16 steps of 2^-20 of the rim; a ray within 1e-5 of it may count as hit or miss, and what it
 * hits is finite and on the sphere. */
static void tangent_band(void **state) {
    const double width = 16 * 0x1p-20;
    const double distances[] = {1, 1e3, 1e5};
    for (size_t i = 0; i < 3; ++i) {
        const Cell cell = {
            .radius = 1, .distance = distances[i], .impact_low = 1 - width, .impact_high = 1 + width};
        const Score score = run_cell(*state, &cell, 1e-5, 60 + i);
        assert_int_equal(score.false_hits + score.false_misses + score.not_finite + score.filtered, 0);
        assert_true(score.right_hits > RAYS / 4);
        assert_true(score.worst_off <= 4e-7);
    }
}

/* 7: grazing, from 1e8 radii away. */
static void far_grazing(void **state) {
    Cases cases;
    cases_init(&cases, 1);
    aim_at(&cases, 0, -1e7, (double)0.095f, 0, 1, 0, 0, 0.1);
    cases_run(*state, &cases, NULL);
    assert_true(cases.hits[HIT_MET] == 1);
    assert_true(fabs(cases.hits[HIT_T] - 1e7) <= 1); /* an ulp of a float there is 1 */
    cases_clear(&cases);
}

/* 8: kernels see directions of unit length within rounding only, so scale is lost where directions are made:
 * normalising 2^k a gives the bits of normalising a. And a direction as far off unit length as normalising
 * leaves it is intersected right, with t in its own lengths. */
static void nonunit_dir(void **state) {
    const Lab *lab = *state;
    enum { COUNT = 2000, SCALES = 21 };
    static double in[COUNT * SCALES * 3], out[COUNT * SCALES * 3];
    uint64_t seed = 8;
    double longest = 0;
    for (int i = 0; i < COUNT; ++i) {
        double v[3];
        lab_direction(&seed, v);
        for (int s = 0; s < SCALES; ++s)
            for (int a = 0; a < 3; ++a) in[(i * SCALES + s) * 3 + a] = ldexp(lab_float(v[a]), s - 10);
    }
    const LabArgument arguments[] = {{LAB_REALS, in, COUNT * SCALES * 3},
                                     {LAB_OUT_REFINED, out, COUNT * SCALES * 3}};
    lab_run(lab, "probe_normalise", COUNT * SCALES, arguments, 2, NULL);
    for (int i = 0; i < COUNT * SCALES; ++i) {
        const Wide v[3] = {(Wide)out[3 * i], (Wide)out[3 * i + 1], (Wide)out[3 * i + 2]};
        const double off = (double)wide_abs(wide_sqrt(wide_dot(v, v)) - 1);
        if (off > longest) longest = off;
        for (int a = 0; a < 3; ++a) assert_true(out[3 * i + a] == out[i / SCALES * SCALES * 3 + a]);
    }
    const double roundoff = lab->real_double ? 0x1p-53 : 0x1p-24;
    print_message("    unit length within %.2f roundoffs\n", longest / roundoff);
    assert_true(longest <= 4 * roundoff);
    /* Lengths off by up to 4 roundoffs of float, against a sphere where that matters most. */
    Cases cases;
    const Cell cell = {.radius = 1e3, .distance = 1, .impact_high = 1.2};
    cases_init(&cases, RAYS);
    cases_aim(&cases, 0, RAYS, &cell, &seed);
    for (size_t i = 0; i < RAYS; ++i)
        for (int a = 0; a < 3; ++a)
            cases.rays[i * RAY_REALS + RAY_DIRECTION + (size_t)a] =
                lab_float(cases.rays[i * RAY_REALS + RAY_DIRECTION + (size_t)a] *
                          (1 + (i % 2 == 0 ? 3 : -3) * 0x1p-24));
    cases_run(lab, &cases, NULL);
    const Score score = cases_score(&cases, 0, RAYS, 1e-5);
    print_message("    3 roundoffs off unit length: t %.2g\n", score.worst_t);
    expect_right(&score, 5e-7);
    cases_clear(&cases);
}

/* 9: the largest and smallest spheres and distances of the grammar: no NaN. (A direction of length 0 cannot
 * arise: test 28 and 30 hold its makers to that.) */
static void degenerate_size(void **state) {
    const double sizes[] = {1e12, 1e6, 1, 1e-6, 1e-12};
    Cases cases;
    cases_init(&cases, (size_t)5 * 5 * 100);
    uint64_t seed = 9;
    for (size_t r = 0; r < 5; ++r)
        for (size_t d = 0; d < 5; ++d) {
            const Cell cell = {.radius = sizes[r], .distance = sizes[d], .impact_high = 1.2};
            cases_aim(&cases, (r * 5 + d) * 100, 100, &cell, &seed);
        }
    cases_run(*state, &cases, NULL);
    for (size_t i = 0; i < cases.count; ++i)
        for (size_t k = 0; k < HIT_REALS; ++k) assert_true(isnan(cases.hits[i * HIT_REALS + k]) == 0);
    cases_clear(&cases);
}

/* 10: the point that a path goes on from lies on its sphere, its own bound on its error included. */
static void hit_on_sphere(void **state) {
    const Lab *lab = *state;
    const double radii[] = {1e-3, 1, 1e3, 1e6}, distances[] = {1e-2, 1, 1e3, 1e6},
                 translations[] = {0, 1e3, 1e6};
    enum { EACH = 500, CELLS = 4 * 4 * 3 };
    Cases cases;
    cases_init(&cases, EACH * CELLS);
    uint64_t seed = 10;
    for (size_t c = 0; c < CELLS; ++c) {
        const Cell cell = {.radius = radii[c % 4],
                           .distance = radii[c % 4] * distances[c / 4 % 4],
                           .translation = translations[c / 16],
                           .impact_high = 1.01};
        cases_aim(&cases, c * EACH, EACH, &cell, &seed);
    }
    cases_run(lab, &cases, NULL);
    double *points = suite_calloc(cases.count * POINT_REALS, sizeof *points);
    const LabArgument arguments[] = {{LAB_REALS, cases.rays, cases.count * RAY_REALS},
                                     {LAB_REALS, cases.spheres, cases.count * 4},
                                     {LAB_REFINED, cases.hits, cases.count * HIT_REALS},
                                     {LAB_OUT_REFINED, points, cases.count * POINT_REALS}};
    lab_run(lab, "probe_point", cases.count, arguments, 4, NULL);
    double worst = 0, worst_bound = 0;
    size_t hits = 0;
    for (size_t i = 0; i < cases.count; ++i) {
        if (cases.hits[i * HIT_REALS + HIT_MET] == 0) continue;
        ++hits;
        const double *point = points + i * POINT_REALS, *sphere = cases.spheres + i * 4;
        const double at[RAY_REALS] = {point[0], point[1], point[2], point[3], point[4], point[5]};
        const double off = fabs(exact_off_sphere(at, sphere, 0));
        worst = fmax(worst, off);
        worst_bound = fmax(worst_bound, off * sphere[3] / point[POINT_SLACK]);
    }
    print_message("    %zu hits: off the sphere by %.2g r, at most %.2g of the bound\n", hits, worst,
                  worst_bound);
    assert_true(hits > cases.count / 2);
    assert_true(worst <= 4e-7);
    assert_true(worst_bound <= 1);
    free(points);
    cases_clear(&cases);
}

int run_sphere(Lab *lab) {
    const struct CMUnitTest tests[] = {
        HARD_TEST(sphere_far_small), HARD_TEST(sphere_far_unit), HARD_TEST(sphere_unit_1e6),
        HARD_TEST(ground_1000),      HARD_TEST(wall_1e5),        HARD_TEST(tangent_band),
        HARD_TEST(far_grazing),      HARD_TEST(nonunit_dir),     HARD_TEST(degenerate_size),
        HARD_TEST(hit_on_sphere),
    };
    return cmocka_run_group_tests_name("sphere", tests, NULL, NULL);
}
