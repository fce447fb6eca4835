/* test_pilot_pass.c: lights that are seen in mirrors and through glass (host/render/pilot_pass.h), against
 * mirrors whose rays are known on paper.
 *
 * Parallel rays, spread evenly over the cross-section of a mirror ball of radius R, leave it evenly over all
 * directions: a ray at the distance b from the axis meets the ball at the angle i with sin i = b / R, and is
 * turned by pi - 2 i; so 2 pi b db = pi R^2 sin(t) dt / 2 with t = 2 i. A sun that fills the solid angle W is
 * met by W / (4 pi) of the rays on the ball, wherever it stands. */
#include "base/random.h"
#include "render/pilot_pass.h"
#include "support/unit_test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
enum { RAYS = 40000, PIXELS = 16 };

static const BpScene spheres = {.sphere_count = 8}; /* by way of which light comes */

typedef struct Fixture {
    BpPilotRay rays[RAYS];
    size_t count;
    double mean[PIXELS], square[PIXELS], by_way[8];
    BpPilotParts parts;
} Fixture;

static Fixture *fixture_create(void) {
    Fixture *fixture = calloc(1, sizeof *fixture);
    assert_non_null(fixture);
    fixture->parts.chance = (BpPilotSums){
        .pixels = PIXELS, .mean = fixture->mean, .square = fixture->square, .by_way = fixture->by_way};
    return fixture;
}

static BpPilotRay *add_ray(Fixture *fixture) {
    BpPilotRay *ray = &fixture->rays[fixture->count];
    *ray = (BpPilotRay){.length = INFINITY,
                        .carried = {1, 1, 1},
                        .share = 1,
                        .way = 77,
                        .pixel = (uint32_t)(fixture->count % PIXELS),
                        .shape = UINT32_MAX,
                        .through = 3,
                        .number = (uint32_t)fixture->count};
    ++fixture->count;
    return ray;
}

static BpPilotLight sun(double x, double y, double z, double degrees) {
    const double length = sqrt(x * x + y * y + z * z), sine = sin(degrees * PI / 360);
    return (BpPilotLight){.distant = true,
                          .seen = true,
                          .place = {x / length, y / length, z / length},
                          .cap = 2 * sine * sine,
                          .radiance = {1, 1, 1},
                          .share = 1};
}

/* Rays along -z at the points (x, y) over the cross-section of a mirror ball of radius R around the origin,
 * one of each square; those that miss it go on elsewhere and are none. */
static void see_in_ball(Fixture *fixture, double radius, uint64_t seed) {
    enum { SIDE = 100 };
    BpRandom random = {.state = seed};
    for (int row = 0; row < SIDE; ++row)
        for (int column = 0; column < SIDE; ++column) {
            const double x = (column + bp_random_next(&random)) * 2 / SIDE - 1;
            const double y = (row + bp_random_next(&random)) * 2 / SIDE - 1, z2 = 1 - x * x - y * y;
            if (z2 <= 0) continue;
            const double normal[3] = {x, y, sqrt(z2)};
            BpPilotRay *ray = add_ray(fixture);
            for (int a = 0; a < 3; ++a) {
                ray->origin[a] = radius * normal[a];
                ray->direction[a] = (a == 2 ? -1 : 0) + 2 * normal[2] * normal[a];
            }
        }
}

static double total(const double *values, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; ++i) sum += values[i];
    return sum;
}

/* Over many places of the sun in the half before the ball, the probability is right in the mean; for one, to
 * the root of the number of rays that tell it. */
static void suns_in_a_mirror_ball(void **state) {
    (void)state;
    enum { SUNS = 40 };
    BpRandom random = {.state = 21};
    double all = 0;
    for (int s = 0; s < SUNS; ++s) {
        const double up = bp_random_next(&random), turn = 2 * PI * bp_random_next(&random),
                     side = sqrt(1 - up * up);
        const BpPilotLight light = sun(side * cos(turn), side * sin(turn), up, 0.27);
        Fixture *fixture = fixture_create();
        see_in_ball(fixture, 2, 100 + (uint64_t)s);
        bp_pilot_pass(&spheres, false, &light, 1, fixture->rays, fixture->count, &fixture->parts);
        const double expected = light.cap / 2 * (double)fixture->count; /* W / (4 pi) of the rays */
        const double found = total(fixture->mean, PIXELS) / expected;
        if (!(found > 0.4 && found < 2.2)) fail_msg("sun %d: %g of what it should be", s, found);
        all += found / SUNS;
        assert_true(fabs(total(fixture->square, PIXELS) / expected - found) < 1e-9);
        assert_true(fabs(fixture->by_way[3] / expected - found) < 1e-9);
        for (int c = 0; c < 3; ++c)
            assert_true(fabs(fixture->parts.chance.square_of[c] / expected - found) < 1e-9);
        free(fixture);
    }
    /* Of 15 rays that tell it, 40 times: 4 % */
    if (!(fabs(all - 1) < 0.13)) fail_msg("in the mean %g of what it should be", all);
}

/* A lamp far from the ball is a sun of the same size; near and beyond something else it is hidden. */
static void lamps_in_a_mirror_ball(void **state) {
    (void)state;
    const double away = 1000, radius = 4;
    const BpPilotLight lamp = {
        .seen = true, .shape = 5, .place = {away, 0, 0}, .radius = radius, .radiance = {2, 2, 2}, .share = 1};
    Fixture *fixture = fixture_create();
    see_in_ball(fixture, 1, 31);
    const size_t count = fixture->count;
    bp_pilot_pass(&spheres, false, &lamp, 1, fixture->rays, count, &fixture->parts);
    const double expected = 0.5 * radius * radius / (4 * away * away) * (double)count;
    const double found = total(fixture->mean, PIXELS) / (2 * expected);
    if (!(found > 0.4 && found < 2.2)) fail_msg("%g of what it should be", found);
    assert_true(fabs(total(fixture->square, PIXELS) / (4 * expected) - found) < 1e-9);
    free(fixture);
    static const struct {
        double length;
        uint32_t sphere;
        bool seen;
    } cases[] = {{900, 7, false}, {1100, 7, true}, {990, 5, true}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        fixture = fixture_create();
        see_in_ball(fixture, 1, 31);
        for (size_t r = 0; r < count; ++r) {
            fixture->rays[r].length = cases[i].length;
            fixture->rays[r].shape = cases[i].sphere;
        }
        bp_pilot_pass(&spheres, false, &lamp, 1, fixture->rays, count, &fixture->parts);
        assert_int_equal(total(fixture->mean, PIXELS) > 0, cases[i].seen);
        free(fixture);
    }
    /* Rays that meet anything do not come to a sun. */
    const BpPilotLight light = sun(1, 0, 0, 1);
    fixture = fixture_create();
    see_in_ball(fixture, 1, 31);
    for (size_t r = 0; r < count; ++r) fixture->rays[r].length = 1e9;
    bp_pilot_pass(&spheres, false, &light, 1, fixture->rays, count, &fixture->parts);
    assert_true(total(fixture->mean, PIXELS) <= 0);
    free(fixture);
}

/* What lies behind the ball of a cone of rays, or shines along it, is not on their way. */
static void lights_behind_the_rays(void **state) {
    (void)state;
    const BpPilotLight lamp = {
        .seen = true, .shape = 5, .place = {0, 0, -50}, .radius = 0.1, .radiance = {1, 1, 1}, .share = 1};
    Fixture *fixture = fixture_create();
    for (size_t i = 0; i < 4000; ++i) {
        BpPilotRay *ray = add_ray(fixture);
        BpRandom random = {.state = i};
        ray->direction[0] = 0.2 * (bp_random_next(&random) - 0.5);
        ray->direction[1] = 0.2 * (bp_random_next(&random) - 0.5);
        ray->direction[2] = 1;
    }
    bp_pilot_pass(&spheres, false, &lamp, 1, fixture->rays, fixture->count, &fixture->parts);
    assert_true(total(fixture->mean, PIXELS) <= 0);
    free(fixture);
}

/* In a flat mirror, rays of a picture spread over a square of directions. A sun inside of it is met by its
 * share; one beside it by none, however near: all rays pass it on one side. */
static void suns_in_a_flat_mirror(void **state) {
    (void)state;
    const double half = 0.1; /* of the square's side */
    static const double places[] = {0, 0.5, 0.8, 1.15, 1.3, 2, 4};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; ++i) {
        const BpPilotLight light = sun(places[i] * half, 0.2 * half, 1, 0.1);
        double found = 0;
        for (uint64_t seed = 0; seed < 10; ++seed) {
            Fixture *fixture = fixture_create();
            BpRandom random = {.state = 41 + seed};
            for (int n = 0; n < 2500; ++n) {
                BpPilotRay *ray = add_ray(fixture);
                double length2 = 1;
                for (int a = 0; a < 2; ++a) {
                    const int cell = a == 0 ? n % 50 : n / 50;
                    ray->direction[a] = half * ((cell + bp_random_next(&random)) / 25 - 1);
                    length2 += ray->direction[a] * ray->direction[a];
                }
                ray->direction[2] = 1;
                for (int a = 0; a < 3; ++a) ray->direction[a] /= sqrt(length2);
            }
            bp_pilot_pass(&spheres, false, &light, 1, fixture->rays, fixture->count, &fixture->parts);
            found += total(fixture->mean, PIXELS) / (2 * PI * light.cap / (4 * half * half) * 2500) / 10;
            free(fixture);
        }
        if (places[i] < 1 ? !(fabs(found - 1) < 0.3) : found > 0)
            fail_msg("a sun at %g of the mirror's rim: %g of what one in the middle is", places[i], found);
    }
}

/* Rays that have come different ways are not mixed, and few of a way say nothing. */
static void each_way_by_itself(void **state) {
    (void)state;
    const BpPilotLight light = sun(0.3, 0.2, 1, 0.27);
    Fixture *one = fixture_create(), *mixed = fixture_create(), *few = fixture_create();
    see_in_ball(one, 1, 51);
    see_in_ball(mixed, 1, 51);
    see_in_ball(few, 1, 51);
    bp_pilot_pass(&spheres, false, &light, 1, one->rays, one->count, &one->parts);
    /* The same rays once more, in another order, with rays of another way among them that pass elsewhere. */
    const size_t count = mixed->count;
    for (size_t i = 0; i < count; ++i) {
        BpPilotRay *ray = add_ray(mixed);
        ray->way = 78;
        ray->direction[2] = -1;
    }
    for (size_t i = 0; i < mixed->count; ++i) {
        const size_t other = i * 7919 % mixed->count;
        const BpPilotRay kept = mixed->rays[i];
        mixed->rays[i] = mixed->rays[other];
        mixed->rays[other] = kept;
    }
    bp_pilot_pass(&spheres, false, &light, 1, mixed->rays, mixed->count, &mixed->parts);
    assert_true(total(one->mean, PIXELS) > 0);
    assert_memory_equal(one->mean, mixed->mean, sizeof one->mean); /* bit for bit: they are sorted */
    /* A light that stands for others is no place that rays pass. */
    BpPilotLight shared = light;
    shared.share = 2;
    bp_pilot_pass(&spheres, false, &shared, 1, few->rays, few->count, &few->parts);
    assert_true(total(few->mean, PIXELS) <= 0);
    bp_pilot_pass(&spheres, false, &light, 1, few->rays, 3, &few->parts);
    assert_true(total(few->mean, PIXELS) <= 0);
    /* A light that rays meet often is seen by samples. */
    const BpPilotLight large = sun(0.3, 0.2, 1, 20);
    bp_pilot_pass(&spheres, false, &large, 1, few->rays, few->count, &few->parts);
    assert_true(total(few->mean, PIXELS) <= 0);
    free(one);
    free(mixed);
    free(few);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(suns_in_a_mirror_ball),  cmocka_unit_test(lamps_in_a_mirror_ball),
        cmocka_unit_test(lights_behind_the_rays), cmocka_unit_test(suns_in_a_flat_mirror),
        cmocka_unit_test(each_way_by_itself),
    };
    return cmocka_run_group_tests_name("pilot_pass", tests, NULL, NULL);
}
