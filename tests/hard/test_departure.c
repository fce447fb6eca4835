/* test_departure.c: tests 11 to 13: the normal, and leaving a surface outward and inward. */
#include "suite.h"

#include "oracle.h"

#include <math.h>
#include <string.h>

static void run_points(const Lab *lab, const Cases *cases, double *points) {
    const LabArgument arguments[] = {{LAB_REALS, cases->rays, cases->count * RAY_REALS},
                                     {LAB_REALS, cases->spheres, cases->count * 4},
                                     {LAB_REFINED, cases->hits, cases->count * HIT_REALS},
                                     {LAB_OUT_REFINED, points, cases->count * POINT_REALS}};
    lab_run(lab, "probe_point", cases->count, arguments, 4, NULL);
}

/* 11: at translation 1e6 the normal stands as it does at the origin; the rounded point's does not. */
static void normal_local(void **state) {
    const Lab *lab = *state;
    enum { COUNT = 20000 };
    const Cell cell = {.radius = 1, .distance = 3, .translation = 1e6, .impact_high = 0.99};
    Cases cases;
    uint64_t seed = 11;
    double worst = 0, worst_point = 0;
    size_t hits = 0;
    cases_init(&cases, COUNT);
    cases_aim(&cases, 0, COUNT, &cell, &seed);
    cases_run(lab, &cases, NULL);
    double *points = suite_calloc(COUNT * POINT_REALS, sizeof *points);
    run_points(lab, &cases, points);
    for (size_t i = 0; i < COUNT; ++i) {
        const double *ray = cases.rays + i * RAY_REALS, *sphere = cases.spheres + i * 4;
        const Exact exact = exact_roots(ray, sphere);
        if (cases.hits[i * HIT_REALS + HIT_MET] == 0 || exact.impact > 0.99) continue;
        ++hits;
        const Wide t = exact.power < 0 ? exact.far : exact.near;
        double off = 0, off_point = 0;
        for (int a = 0; a < 3; ++a) {
            const Wide n =
                ((Wide)ray[a] + (Wide)ray[3 + a] + t * (Wide)ray[6 + a] - (Wide)sphere[a]) / (Wide)sphere[3];
            const double rounded = lab_float((double)t * ray[6 + a] + ray[a]) - sphere[a];
            off += pow((double)((Wide)points[i * POINT_REALS + POINT_NORMAL + (size_t)a] - n), 2);
            off_point += pow(rounded / sphere[3] - (double)n, 2);
        }
        worst = fmax(worst, sqrt(off));
        worst_point = fmax(worst_point, sqrt(off_point));
    }
    print_message("    normals off by %.2g; by the rounded point %.2g\n", worst, worst_point);
    assert_true(hits > COUNT / 2);
    assert_true(worst <= 2e-6);
    assert_true(worst_point > 1e-2);
    free(points);
    cases_clear(&cases);
}

typedef struct Departures {
    size_t outward, again;          /* rays that go out; of them, those that meet their sphere again */
    size_t inward, missed;          /* rays that go in; of them, those that meet nothing */
    double worst_chord;             /* relative, steeper than 1/4 */
    double worst_off;               /* of the chord's end, in radii */
    size_t book_again, book_missed; /* the book's form with t_min 1e-3 from the rounded point */
} Departures;

/* Hits `count` rays of the cell, then leaves each point in a random direction: even items outward, odd ones
 * inward, every fourth of them within 1e-6 .. 1 of the tangent plane. */
static void depart(const Lab *lab, const Cell *cell, size_t count, uint64_t *seed, Departures *sum) {
    Cases cases, left, book;
    cases_init(&cases, count);
    cases_init(&left, count);
    cases_init(&book, count);
    cases_aim(&cases, 0, count, cell, seed);
    cases_run(lab, &cases, NULL);
    double *points = suite_calloc(count * POINT_REALS, sizeof *points);
    uint32_t *own = suite_calloc(count, sizeof *own);
    run_points(lab, &cases, points);
    for (size_t i = 0; i < count; ++i) {
        const double *point = points + i * POINT_REALS, *normal = point + POINT_NORMAL;
        double *ray = left.rays + i * RAY_REALS, *direction = ray + RAY_DIRECTION;
        memcpy(ray, point, 6 * sizeof *ray); /* high, low */
        ray[RAY_SLACK] = point[POINT_SLACK];
        memcpy(left.spheres + i * 4, cases.spheres + i * 4, 4 * sizeof(double));
        lab_direction(seed, direction);
        const double along = lab_dot(direction, normal);
        double wanted = fabs(along);
        if (i % 8 < 2) wanted = pow(10, -6 * lab_unit(seed));
        if (i % 2 == 1) wanted = -wanted;
        const double rest = sqrt((1 - wanted * wanted) / (1 - along * along + 1e-12));
        for (int a = 0; a < 3; ++a)
            direction[a] = rest * (direction[a] - along * normal[a]) + wanted * normal[a];
        lab_float_unit(direction);
        own[i] = i % 2 == 1 ? 2 : 1;
    }
    memcpy(book.rays, left.rays, count * RAY_REALS * sizeof(double));
    memcpy(book.spheres, left.spheres, count * 4 * sizeof(double));
    cases_run(lab, &left, own);
    cases_host(FORM_BOOK, 1e-3f, &book);
    for (size_t i = 0; i < count; ++i) {
        if (cases.hits[i * HIT_REALS + HIT_MET] == 0) continue;
        const bool met = left.hits[i * HIT_REALS + HIT_MET] != 0;
        const bool book_met = book.hits[i * HIT_REALS + HIT_MET] != 0;
        if (own[i] == 1) {
            ++sum->outward;
            sum->again += met;
            sum->book_again += book_met;
            continue;
        }
        ++sum->inward;
        sum->missed += !met;
        sum->book_missed += !book_met;
        if (!met) continue;
        const double *ray = left.rays + i * RAY_REALS, *sphere = left.spheres + i * 4;
        const Exact exact = exact_roots(ray, sphere);
        const double t = left.hits[i * HIT_REALS + HIT_T], chord = (double)(2 * exact.middle);
        if (chord > 0.5 * sphere[3]) sum->worst_chord = fmax(sum->worst_chord, fabs(t - chord) / chord);
        sum->worst_off =
            fmax(sum->worst_off, fabs(exact_off_sphere(ray, sphere, t)) - 0x1p-24 * t / sphere[3]);
    }
    free(points);
    free(own);
    cases_clear(&cases);
    cases_clear(&left);
    cases_clear(&book);
}

/* 12, 13: a thousand spheres, a thousand rays each. Never met again from outside, always from inside, at the
 * chord's end. (After pbrt's test FullSphere.Reintersect.) */
static void reintersect_and_chord_inside(void **state) {
    Departures sum = {0};
    uint64_t seed = 12;
    for (int batch = 0; batch < 50; ++batch) {
        /* 20 spheres a batch: the cases of a cell turn and shift it for every ray. */
        for (int sphere = 0; sphere < 4; ++sphere) {
            const double radius = pow(10, -4 + 10 * lab_unit(&seed));
            const double translation = sphere == 0 ? 0 : pow(10, 6 * lab_unit(&seed));
            const Cell cell = {.radius = radius,
                               .distance = radius * pow(10, -1 + 3 * lab_unit(&seed)),
                               .translation = translation,
                               .impact_high = 1};
            depart(*state, &cell, 5000, &seed, &sum);
        }
    }
    print_message("    %zu outward, %zu again; %zu inward, %zu missed; chords off by %.2g, ends off the "
                  "sphere by %.2g r\n",
                  sum.outward, sum.again, sum.inward, sum.missed, sum.worst_chord, sum.worst_off);
    print_message("    book from the rounded point, t from 1e-3: %.1f %% again, %.1f %% missed\n",
                  100.0 * (double)sum.book_again / (double)sum.outward,
                  100.0 * (double)sum.book_missed / (double)sum.inward);
    assert_true(sum.outward > 300000 && sum.inward > 300000);
    assert_int_equal(sum.again, 0);
    assert_int_equal(sum.missed, 0);
    assert_true(sum.worst_chord <= 1e-6);
    assert_true(sum.worst_off <= 4e-7);
    assert_true(sum.book_again > sum.outward / 100 && sum.book_missed > sum.inward / 100);
}

int run_departure(Lab *lab) {
    const struct CMUnitTest tests[] = {HARD_TEST(normal_local), HARD_TEST(reintersect_and_chord_inside)};
    return cmocka_run_group_tests_name("departure", tests, NULL, NULL);
}
