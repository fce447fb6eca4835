/* test_pilot_join.c: paths from the camera and from lights that come together (host/render/pilot_join.h):
 * against all pairs, one by one, and lobes against the kernels' and against directions drawn by the book's
 * definitions. */
#include "base/random.h"
#include "render/pilot_join.h"
#include "render/pilot_lobes.h"
#include "render/pilot_shapes.h"
#include "support/build_scene.h"
#include "support/probe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
enum { EYES = 3000, PHOTONS = 3000, PIXELS = 64, DEPTH = 6 };

static double between(BpRandom *random, double low, double high) {
    return low + (high - low) * bp_random_next(random);
}

static void unit(BpRandom *random, double v[3]) {
    double length2 = 0;
    do {
        length2 = 0;
        for (int a = 0; a < 3; ++a) {
            v[a] = between(random, -1, 1);
            length2 += v[a] * v[a];
        }
    } while (length2 > 1 || length2 < 0.01);
    for (int a = 0; a < 3; ++a) v[a] /= sqrt(length2);
}

/* ---- pairs ---- */

typedef struct Fixture {
    BuiltScene built;
    BpPilotEye eyes[EYES];
    BpPilotPhoton photons[PHOTONS];
    double mean[2][PIXELS], square[2][PIXELS], by_way[2][4];
} Fixture;

static BpPilotSums sums_of(Fixture *fixture, int part) {
    memset(fixture->mean[part], 0, sizeof fixture->mean[part]);
    memset(fixture->square[part], 0, sizeof fixture->square[part]);
    memset(fixture->by_way[part], 0, sizeof fixture->by_way[part]);
    return (BpPilotSums){.pixels = PIXELS,
                         .mean = fixture->mean[part],
                         .square = fixture->square[part],
                         .by_way = fixture->by_way[part]};
}

static BpPilotParts parts_of(Fixture *fixture) {
    return (BpPilotParts){.chance = sums_of(fixture, 0), .focused = sums_of(fixture, 1)};
}

/* Points all over the octaves from 2^-20 to 2^20 around the origin and around 0x1p8, in balls of radii of as
 * many octaves, so that every level and, at every level, cells on both sides of 0 are used. */
static Fixture *fixture_create(uint64_t seed) {
    Fixture *fixture = calloc(1, sizeof *fixture);
    assert_non_null(fixture);
    built_scene_init(&fixture->built);
    const uint32_t matte = built_material(&fixture->built, BP_MATERIAL_LAMBERTIAN, 0.5, NULL);
    for (int i = 0; i < 3; ++i) built_sphere(&fixture->built, 0, 0, 0, 1, matte);
    BpRandom random = {.state = seed};
    for (size_t i = 0; i < EYES; ++i) {
        BpPilotEye *eye = &fixture->eyes[i];
        const double size = exp2(floor(between(&random, -20, 21)));
        *eye = (BpPilotEye){.pixel = (uint32_t)(i % PIXELS),
                            .share = between(&random, 0.1, 1),
                            .radius = size * between(&random, 0.5, 1),
                            .shape = (uint32_t)(i % 3),
                            .object = (uint32_t)(i % 3),
                            .segments = 1 + (uint32_t)(i % 4)};
        for (int a = 0; a < 3; ++a) {
            eye->point[a] = size * between(&random, -2, 2) + (i % 5 == 0 ? 0x1p8 : 0);
            eye->throughput[a] = between(&random, 0, 1);
        }
        unit(&random, eye->normal);
        memcpy(eye->outgoing, eye->normal, sizeof eye->outgoing);
    }
    for (size_t i = 0; i < PHOTONS; ++i) {
        BpPilotPhoton *photon = &fixture->photons[i];
        const BpPilotEye *near = &fixture->eyes[(size_t)(bp_random_next(&random) * EYES)];
        *photon = (BpPilotPhoton){.measure = near->radius * near->radius * between(&random, 0.01, 1),
                                  .object = i % 7 == 0 ? (uint32_t)(i % 3) : near->object,
                                  .segments = 1 + (uint32_t)(i % 3),
                                  .through = (uint32_t)(i % 3),
                                  .focused = i % 4 == 0};
        for (int a = 0; a < 3; ++a) {
            photon->point[a] = near->point[a] + near->radius * between(&random, -1, 1);
            photon->radiance[a] = between(&random, 0, 10);
        }
        unit(&random, photon->direction);
    }
    return fixture;
}

typedef struct Expected {
    double mean[PIXELS], square[PIXELS], by_way[4], square_of[3];
    size_t pairs;
} Expected;

/* By the definition: a sample of the pixel goes along the photon's way with the density of the lobe times the
 * measure over the area of the disk and the cosine. */
static void expect_pairs(const Fixture *fixture, bool focused, Expected *expected) {
    static const double weights[3] = {0.2126, 0.7152, 0.0722};
    *expected = (Expected){.pairs = 0};
    for (size_t e = 0; e < EYES; ++e)
        for (size_t p = 0; p < PHOTONS; ++p) {
            const BpPilotEye *eye = &fixture->eyes[e];
            const BpPilotPhoton *photon = &fixture->photons[p];
            double away2 = 0, cosine = 0, y = 0;
            for (int a = 0; a < 3; ++a) {
                away2 += (eye->point[a] - photon->point[a]) * (eye->point[a] - photon->point[a]);
                cosine -= eye->normal[a] * photon->direction[a];
            }
            if (photon->focused != focused || eye->object != photon->object ||
                away2 > eye->radius * eye->radius || cosine <= 0 || eye->segments + photon->segments > DEPTH)
                continue;
            const double probability = eye->share * cosine / PI / fmax(cosine, 0.02) * photon->measure /
                                       (PI * eye->radius * eye->radius);
            for (int c = 0; c < 3; ++c) {
                const double light = eye->throughput[c] * photon->radiance[c];
                y += weights[c] * light;
                expected->square_of[c] += light * light * probability;
            }
            expected->mean[eye->pixel] += y * probability;
            expected->square[eye->pixel] += y * y * probability;
            expected->by_way[photon->through] += y * y * probability;
            ++expected->pairs;
        }
}

static void assert_near(double found, double expected, double relative, const char *what) {
    if (!(fabs(found - expected) <= relative * fabs(expected)))
        fail_msg("%s: %.17g, expected %.17g", what, found, expected);
}

static void assert_sums(const BpPilotSums *sums, const Expected *expected) {
    for (int i = 0; i < PIXELS; ++i) {
        assert_near(sums->mean[i], expected->mean[i], 1e-12, "the mean of a pixel");
        assert_near(sums->square[i], expected->square[i], 1e-12, "the mean square of a pixel");
    }
    for (int i = 0; i < 4; ++i)
        assert_near(sums->by_way[i], expected->by_way[i], 1e-12, "the part of a sphere");
    for (int c = 0; c < 3; ++c)
        assert_near(sums->square_of[c], expected->square_of[c], 1e-12, "the mean square of a channel");
}

static void all_pairs_count_once(void **state) {
    (void)state;
    static Expected chance, focused;
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        Fixture *fixture = fixture_create(seed);
        expect_pairs(fixture, false, &chance);
        expect_pairs(fixture, true, &focused);
        assert_true(chance.pairs > 2 * PHOTONS &&
                    focused.pairs > PHOTONS / 2); /* or nothing would be tested */
        BpPilotParts parts = parts_of(fixture);
        assert_int_equal(bp_pilot_join(&fixture->built.scene, fixture->eyes, EYES, fixture->photons, PHOTONS,
                                       DEPTH, &parts, NULL),
                         BP_OK);
        assert_sums(&parts.chance, &chance);
        assert_sums(&parts.focused, &focused);
        free(fixture);
    }
}

/* An end whose ball lies just beside a border of cells, or on it: light on the other side counts as well. */
static void borders_of_cells(void **state) {
    (void)state;
    Fixture *fixture = fixture_create(1);
    for (int exponent = -30; exponent <= 30; ++exponent)
        for (int side = -1; side <= 1; side += 2) {
            const double radius = exp2(exponent), place = side * 8 * radius;
            BpPilotEye eye = {.share = 1,
                              .point = {place, place, place},
                              .normal = {0, 1, 0},
                              .outgoing = {0, 1, 0},
                              .throughput = {1, 1, 1},
                              .radius = radius,
                              .segments = 1};
            BpPilotPhoton photons[8];
            for (int corner = 0; corner < 8; ++corner) {
                photons[corner] = (BpPilotPhoton){.direction = {0, -1, 0},
                                                  .radiance = {1, 1, 1},
                                                  .measure = PI * PI * radius * radius,
                                                  .segments = 1};
                for (int a = 0; a < 3; ++a)
                    photons[corner].point[a] = place + ((corner >> a & 1) != 0 ? 0.5 : -0.5) * radius;
            }
            BpPilotParts parts = parts_of(fixture);
            assert_int_equal(bp_pilot_join(&fixture->built.scene, &eye, 1, photons, 8, DEPTH, &parts, NULL),
                             BP_OK);
            assert_near(parts.chance.mean[0], 8, 1e-12, "light in all eight corners");
        }
    free(fixture);
}

/* Ends on a mesh take light that comes to other triangles of it, if these lie alike: not that of its other
 * side, nor around a corner. A sphere is its own surface. */
static void neighbours_on_a_mesh(void **state) {
    (void)state;
    static const struct {
        uint32_t shape, object;
        double tilt;
        bool counts;
    } cases[] = {{4, 3, 0, true},   {4, 3, 30, true},   {3, 3, 30, true}, {4, 3, 50, false},
                 {4, 3, 90, false}, {4, 3, 180, false}, {4, 1, 0, false}, {1, 1, 90, true}};
    Fixture *fixture = fixture_create(1);
    BpTriangle triangles[2] = {{.vertices = {{0}}}};
    fixture->built.scene.triangles = triangles;
    fixture->built.scene.triangle_count = 2;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const double tilt = cases[i].tilt * PI / 180;
        const uint32_t shape = cases[i].shape;
        BpPilotEye eye = {.share = 1,
                          .normal = {0, 1, 0},
                          .outgoing = {0, 1, 0},
                          .throughput = {1, 1, 1},
                          .radius = 1,
                          .shape = shape,
                          .object = bp_pilot_object(&fixture->built.scene, shape),
                          .segments = 1};
        BpPilotPhoton photon = {.point = {0.1, 0.2, 0.3},
                                .direction = {0, -1, 0},
                                .normal = {sin(tilt), cos(tilt), 0},
                                .radiance = {1, 1, 1},
                                .measure = PI * PI,
                                .object = cases[i].object,
                                .segments = 1};
        BpPilotParts parts = parts_of(fixture);
        assert_int_equal(bp_pilot_object(&fixture->built.scene, shape), shape < 3 ? shape : 3);
        assert_int_equal(bp_pilot_join(&fixture->built.scene, &eye, 1, &photon, 1, DEPTH, &parts, NULL),
                         BP_OK);
        assert_near(parts.chance.mean[0], cases[i].counts ? 1 : 0, 1e-12, "light of a neighbour");
    }
    free(fixture);
}

/* Without one or the other nothing happens. */
static void nothing_to_join(void **state) {
    (void)state;
    Fixture *fixture = fixture_create(1);
    BpPilotParts parts = parts_of(fixture);
    const BpScene *scene = &fixture->built.scene;
    assert_int_equal(bp_pilot_join(scene, fixture->eyes, 0, fixture->photons, PHOTONS, DEPTH, &parts, NULL),
                     BP_OK);
    assert_int_equal(bp_pilot_join(scene, fixture->eyes, EYES, fixture->photons, 0, DEPTH, &parts, NULL),
                     BP_OK);
    for (int i = 0; i < PIXELS; ++i) assert_true(parts.chance.mean[i] == 0 && parts.chance.square[i] == 0);
    free(fixture);
}

/* ---- lobes ---- */

typedef struct Lobe {
    const char *name;
    BpMaterial material;
    int kind; /* the kernels' */
} Lobe;

enum { LOBES = 8 };
static void make_lobes(Lobe lobes[LOBES]) {
    const BpMaterial matte = {.kind = BP_MATERIAL_LAMBERTIAN}, metal = {.kind = BP_MATERIAL_METAL};
    for (int i = 0; i < LOBES; ++i) lobes[i].material = i < 3 ? matte : metal;
    lobes[0].name = "lambertian";
    lobes[1].name = "cosine_cubed";
    lobes[1].material.scatter = BP_SCATTER_COSINE_CUBED;
    lobes[2].name = "hemisphere";
    lobes[2].material.scatter = BP_SCATTER_HEMISPHERE;
    static const double fuzz[5] = {1.0 / 64, 0.3, 0.9, 0.3, 0.9};
    for (int i = 3; i < LOBES; ++i) {
        lobes[i].name = i < 6 ? "fuzz on a sphere" : "fuzz in a ball";
        lobes[i].material.fuzz = fuzz[i - 3];
        lobes[i].material.fuzz_shape = i < 6 ? BP_FUZZ_SPHERE : BP_FUZZ_BALL;
    }
}

/* The share of directions within an angle of the axis, by the density; the substitution takes away the pole
 * at the rim of a fuzzy lobe: sine = rim sin(t). */
static double share_within(const BpMaterial *material, double sine_most) {
    enum { STEPS = 200000 };
    const double axis[3] = {0, 0, 1};
    const double rim = material->kind == BP_MATERIAL_METAL ? material->fuzz : 1;
    const double most = asin(fmin(1, sine_most / rim));
    double sum = 0;
    for (int i = 0; i < STEPS; ++i) {
        const double t = most * (i + 0.5) / STEPS, sine = rim * sin(t), cosine = sqrt(1 - sine * sine);
        const double direction[3] = {sine * 0.6, sine * 0.8, cosine};
        /* dw = 2 pi sine d(angle), d(angle) = rim cos(t) / cosine dt */
        sum += bp_pilot_density(material, axis, direction) * 2 * PI * sine * rim * cos(t) / cosine * most /
               STEPS;
    }
    return sum;
}

static void densities_come_to_one(void **state) {
    (void)state;
    Lobe lobes[LOBES];
    make_lobes(lobes);
    for (int i = 0; i < LOBES; ++i) assert_near(share_within(&lobes[i].material, 1), 1, 1e-4, lobes[i].name);
}

/* A direction as the book's editions draw it: normal or mirror direction plus a point of a unit sphere or
 * ball. */
static void draw(const BpMaterial *material, BpRandom *random, double direction[3]) {
    const bool metal = material->kind == BP_MATERIAL_METAL;
    const bool in_ball =
        metal ? material->fuzz_shape == BP_FUZZ_BALL : material->scatter == BP_SCATTER_COSINE_CUBED;
    unit(random, direction);
    const double radius = in_ball ? cbrt(bp_random_next(random)) : 1;
    for (int a = 0; a < 3; ++a) direction[a] *= radius * (metal ? material->fuzz : 1);
    if (!metal && material->scatter == BP_SCATTER_HEMISPHERE)
        direction[2] = fabs(direction[2]);
    else
        direction[2] += 1;
    double length =
        sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    for (int a = 0; a < 3; ++a) direction[a] /= length;
}

static void densities_are_those_of_what_is_drawn(void **state) {
    (void)state;
    enum { DRAWN = 200000 };
    Lobe lobes[LOBES];
    make_lobes(lobes);
    BpRandom random = {.state = 7};
    for (int i = 0; i < LOBES; ++i) {
        const BpMaterial *material = &lobes[i].material;
        const double rim = material->kind == BP_MATERIAL_METAL ? material->fuzz : 1;
        static const double parts[4] = {0.3, 0.6, 0.8, 0.95};
        size_t within[4] = {0};
        for (int n = 0; n < DRAWN; ++n) {
            double direction[3];
            draw(material, &random, direction);
            const double sine = sqrt(fmax(0, 1 - direction[2] * direction[2]));
            for (int k = 0; k < 4; ++k) within[k] += sine < parts[k] * rim;
        }
        for (int k = 0; k < 4; ++k) {
            const double share = share_within(material, parts[k] * rim);
            const double sigma = sqrt(share * (1 - share) / DRAWN), found = (double)within[k] / DRAWN;
            if (!(fabs(found - share) <= 5 * sigma))
                fail_msg("%s: %g drawn within %g, expected %g", lobes[i].name, found, parts[k] * rim, share);
        }
    }
}

/* For each lobe of make_lobes(), directions at cosines of (i + 0.5) / 64 to its axis. */
static const char probe_text[] =
    "__kernel void densities(uint first, uint second, __global float *out) {\n"
    "    const uint i = get_global_id(0), lobe_number = i / 64u;\n"
    "    const float cosine = ((float)(i % 64u) + 0.5f) / 64.0f;\n"
    "    const float fuzzes[5] = {0.015625f, 0.3f, 0.9f, 0.3f, 0.9f};\n"
    "    const uint kinds[8] = {LOBE_LAMBERTIAN, LOBE_COSINE_CUBED, LOBE_HEMISPHERE, LOBE_FUZZ_SPHERE,\n"
    "                           LOBE_FUZZ_SPHERE, LOBE_FUZZ_SPHERE, LOBE_FUZZ_BALL, LOBE_FUZZ_BALL};\n"
    "    Lobe lobe;\n"
    "    lobe.kind = splat_uint(kinds[lobe_number]);\n"
    "    lobe.axis = lobe.normal = vec3(splat(0), splat(0), splat(1));\n"
    "    lobe.fuzz = splat(lobe_number < 3u ? 0.0f : fuzzes[lobe_number - 3u]);\n"
    "    const Vec3 direction = vec3(splat(sqrt(1.0f - cosine * cosine)), splat(0), splat(cosine));\n"
    "    const vreal density = lobe_number < 3u ? lambertian_pdf(&lobe, direction) : metal_pdf(&lobe, "
    "direction, 0);\n"
    "    out[i] = density;\n"
    "}\n";

static void densities_are_the_kernels(void **state) {
    (void)state;
    Lobe lobes[LOBES];
    make_lobes(lobes);
    Probe probe;
    probe_open(&probe, probe_text);
    static float found[LOBES * 64];
    probe_run(&probe, "densities", 0, 0, LOBES * 64, found, sizeof found);
    probe_close(&probe);
    size_t inside = 0;
    for (int i = 0; i < LOBES * 64; ++i) {
        const double cosine = (i % 64 + 0.5) / 64, axis[3] = {0, 0, 1};
        const double direction[3] = {sqrt(1 - cosine * cosine), 0, cosine};
        const double density = bp_pilot_density(&lobes[i / 64].material, axis, direction);
        inside += density > 0;
        /* Float: near the rim of a fuzzy lobe the density is the inverse of a small difference. */
        assert_near((double)found[i], density, 1e-4, lobes[i / 64].name);
    }
    assert_true(inside > 64 * 4);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_pairs_count_once),      cmocka_unit_test(borders_of_cells),
        cmocka_unit_test(neighbours_on_a_mesh),      cmocka_unit_test(nothing_to_join),
        cmocka_unit_test(densities_come_to_one),     cmocka_unit_test(densities_are_those_of_what_is_drawn),
        cmocka_unit_test(densities_are_the_kernels),
    };
    return cmocka_run_group_tests_name("pilot_join", tests, NULL, NULL);
}
