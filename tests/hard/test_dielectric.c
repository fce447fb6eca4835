/* test_dielectric.c: tests 20 to 25: Fresnel, the critical angle, furnaces; and indices far from 1. */
#define BP_HOST
#include "suite.h"

#include "oracle.h"
#include "scene_types.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SCATTER_IN = 8, SCATTER_WORDS = 6, SCATTER_OUT = 8 };

/* 20: from inside, at the critical angle and 1 and 8 floats either side of it: a unit direction, on the side
 * that it says, and total reflection beyond. */
static void critical_angle(void **state) {
    const Lab *lab = *state;
    const double indices[] = {1.1, 1.33, 1.5, 2.42};
    const int steps[] = {-8, -1, 0, 1, 8};
    enum { COUNT = 4 * 5 * 16 };
    double in[COUNT * SCATTER_IN] = {0}, out[COUNT * SCATTER_OUT];
    uint32_t words[COUNT * SCATTER_WORDS];
    for (uint32_t i = 0; i < COUNT; ++i) {
        const double index = lab_float(indices[i % 4]);
        float cosine = (float)sqrt(1 - 1 / (index * index));
        const int step = steps[i / 4 % 5];
        for (int k = 0; k < abs(step); ++k) cosine = nextafterf(cosine, step > 0 ? 2.0f : 0.0f);
        double *numbers = in + i * SCATTER_IN;
        numbers[0] = lab_float(sqrt(1 - (double)cosine * (double)cosine));
        numbers[1] = -(double)cosine;
        numbers[4] = 1; /* the normal, towards the path */
        numbers[6] = index;
        const uint32_t choice[] = {0, KIND_DIELECTRIC, 0, i % 3, TOTAL_REFLECT, i};
        memcpy(words + i * SCATTER_WORDS, choice, sizeof choice);
    }
    const LabArgument arguments[] = {{LAB_REALS, in, COUNT * SCATTER_IN},
                                     {LAB_WORDS, words, COUNT * SCATTER_WORDS},
                                     {LAB_NUMBER, NULL, 20},
                                     {LAB_OUT_REFINED, out, COUNT * SCATTER_OUT}};
    lab_run(lab, "probe_scatter", COUNT, arguments, 4, NULL);
    size_t refracted = 0;
    for (uint32_t i = 0; i < COUNT; ++i) {
        const double *row = out + i * SCATTER_OUT;
        assert_true(fabs(sqrt(lab_dot(row, row)) - 1) <= 5e-7);
        assert_true(row[3] == 1);
        assert_true(row[4] != 0 ? row[1] <= 1e-3 : row[1] >= 0);
        refracted += row[4] != 0;
        /* Eight floats beyond the critical angle nothing gets out. */
        if (i / 4 % 5 == 0) assert_true(row[4] == 0);
    }
    assert_true(refracted > 0);
}

/* Where the ratio of indices is 1 over 8 to 1e4, from both sides, by rays that fill the cone that is not
 * reflected and a little more: what is refracted goes where 113 bits say, from the same floats, and total
 * reflection begins there. */
static void indices_far_from_1(void **state) {
    const Lab *lab = *state;
    const double ratios[] = {1e-4, 1e-2, 1.0 / 9, 9, 100, 1e3, 1e4};
    enum { COUNT = 7 * 512 };
    static double in[COUNT * SCATTER_IN], out[COUNT * SCATTER_OUT];
    static uint32_t words[COUNT * SCATTER_WORDS];
    double worst = 0;
    size_t refracted = 0, reflected = 0;
    for (uint32_t i = 0; i < COUNT; ++i) {
        const double ratio = ratios[i % 7], share = (i / 7 + 0.5) / 512 * 1.2;
        const double sine = ratio > 1 ? share / ratio : fmin(share, 0.999), turn = 0.7 * i;
        const double tilt = 0.3 + 0.001 * (i % 500), c = cos(tilt), s = sin(tilt),
                     down = sqrt(1 - sine * sine);
        double *numbers = in + i * SCATTER_IN;
        /* the normal lies aslant, so that every component of both is rounded */
        const double across = sine * cos(turn), deep = sine * sin(turn);
        numbers[0] = lab_float(across * c + down * s);
        numbers[1] = lab_float(across * s - down * c);
        numbers[2] = lab_float(deep);
        numbers[3] = lab_float(-s);
        numbers[4] = lab_float(c);
        numbers[6] = lab_float(i % 2 == 0 ? 1 / ratio : ratio);
        const uint32_t choice[] = {i % 2 == 0, KIND_DIELECTRIC, 0, FRESNEL_NONE, TOTAL_REFLECT, i};
        memcpy(words + i * SCATTER_WORDS, choice, sizeof choice);
    }
    const LabArgument arguments[] = {{LAB_REALS, in, COUNT * SCATTER_IN},
                                     {LAB_WORDS, words, COUNT * SCATTER_WORDS},
                                     {LAB_NUMBER, NULL, 20},
                                     {LAB_OUT_REFINED, out, COUNT * SCATTER_OUT}};
    lab_run(lab, "probe_scatter", COUNT, arguments, 4, NULL);
    for (uint32_t i = 0; i < COUNT; ++i) {
        const double *d = in + i * SCATTER_IN, *n = d + 3, *row = out + i * SCATTER_OUT;
        const double index = lab_float(d[6]), k = i % 2 == 0 ? 1 / index : index;
        Wide cosine = 0, along[3], square = 0, length2 = 0;
        for (int a = 0; a < 3; ++a) cosine -= (Wide)d[a] * (Wide)n[a];
        for (int a = 0; a < 3; ++a) length2 += (Wide)n[a] * (Wide)n[a];
        for (int a = 0; a < 3; ++a) along[a] = (Wide)k * ((Wide)d[a] + cosine / length2 * (Wide)n[a]);
        for (int a = 0; a < 3; ++a) square += along[a] * along[a];
        const double room = 1 - (double)square, slack = 1e-6 * fmax(k, 1);
        assert_true(row[3] == 1);
        if (fabs(room) > slack) assert_true((row[4] != 0) == (room > 0));
        refracted += row[4] != 0;
        reflected += row[4] == 0;
        if (row[4] == 0 || room < 0.01) continue;
        for (int a = 0; a < 3; ++a) {
            const double expected = (double)along[a] - sqrt(room) * n[a], off = fabs(row[a] - expected);
            worst = fmax(worst, off / fmax(k, 1));
            assert_true(off <= 4e-7 * fmax(k, 1));
        }
    }
    print_message("    directions off by %.2g of the ratio of indices\n", worst);
    assert_true(refracted > COUNT / 2 && reflected > COUNT / 16);
}

/* Fresnel's equations in 113 bits; `cosine` on the side that the light comes from, index of the far over it.
 */
static double wide_fresnel(double cosine, double index) {
    const Wide c = (Wide)cosine, n = (Wide)index, inside = 1 - (1 - c) * (1 + c) / (n * n);
    if (inside < 0) return 1;
    const Wide t = wide_sqrt(inside), across = (c - n * t) / (c + n * t), along = (n * c - t) / (n * c + t);
    return (double)((across * across + along * along) / 2);
}

/* Exact reflectances of `count` pairs (cosine, index), all floats; in all-double they are these floats too.
 */
static void run_fresnel(const Lab *lab, double *in, size_t count, double *out) {
    const LabArgument arguments[] = {{LAB_REALS, in, 2 * count}, {LAB_OUT_REFINED, out, 2 * count}};
    lab_run(lab, "probe_fresnel", count, arguments, 2, NULL);
}

/* 21: from both sides. Going out, the cosine of refraction t comes from 1 - (1 - c^2) / n^2, which cancels
 * towards the critical angle: the error may grow as 1 / t there. */
static void fresnel_table(void **state) {
    const double indices[] = {1.1, 1.33, 1.5, 2.42, 1 / 1.1, 1 / 1.33, 1 / 1.5, 1 / 2.42};
    enum { STEPS = 1001, COUNT = 8 * STEPS };
    static double in[2 * COUNT], out[2 * COUNT];
    double worst = 0;
    for (size_t i = 0; i < COUNT; ++i) {
        in[2 * i] = lab_float((double)(i % STEPS) / (STEPS - 1));
        in[2 * i + 1] = lab_float(indices[i / STEPS]);
    }
    run_fresnel(*state, in, COUNT, out);
    for (size_t i = 0; i < COUNT; ++i) {
        const double c = in[2 * i], n = in[2 * i + 1], t2 = 1 - (1 - c * c) / (n * n);
        const double off = fabs(out[2 * i] - wide_fresnel(c, n));
        worst = fmax(worst, n < 1 ? off * sqrt(fabs(t2)) : off);
        assert_true(off <= 1e-2);
    }
    print_message("    exact reflectance off by %.2g (going out: times t)\n", worst);
    assert_true(worst <= 1e-6);
}

/* 22: seen from all sides, glass of index 1.5 reflects 0.09178 outside, 0.59635 inside, and the two belong
 * together: inside = 1 - (1 - outside) / n^2. Schlick's mean is another. */
static void fresnel_mean(void **state) {
    enum { STEPS = 65536 };
    double *in = suite_calloc(2 * STEPS, sizeof *in), *out = suite_calloc(2 * STEPS, sizeof *out);
    double mean[2] = {0}, schlick = 0;
    for (int side = 0; side < 2; ++side) {
        for (size_t i = 0; i < STEPS; ++i) {
            in[2 * i] = ((double)i + 0.5) / STEPS;
            in[2 * i + 1] = side == 0 ? 1.5 : lab_float(1 / 1.5);
        }
        run_fresnel(*state, in, STEPS, out);
        for (size_t i = 0; i < STEPS; ++i) {
            mean[side] += 2 * in[2 * i] * out[2 * i] / STEPS;
            if (side == 0) schlick += 2 * in[2 * i] * out[2 * i + 1] / STEPS;
        }
    }
    print_message("    mean reflectance %.5f outside, %.5f inside; Schlick %.5f\n", mean[0], mean[1],
                  schlick);
    assert_true(fabs(mean[0] - 0.09178) <= 1e-5 && fabs(mean[1] - 0.59635) <= 2e-5);
    assert_true(fabs(mean[1] - (1 - (1 - mean[0]) / 2.25)) <= 2e-5);
    assert_true(fabs(schlick - mean[0]) > 5e-3);
    free(in);
    free(out);
}

static void render_material(const Lab *lab, const char *material, double view, unsigned width,
                            uint64_t samples, BpPicture *picture) {
    /* A sphere of radius 1 from 100 away in a white sky. */
    BpScene *scene = suite_scene("{\"format\":1,\"camera\":{\"image_width\":%u,\"vfov\":%.17g,\"lookfrom\":["
                                 "0,0,100],\"lookat\":[%.17g,0,0],"
                                 "\"max_depth\":2000},\"background\":[1,1,1],\"materials\":{\"m\":{%s}},"
                                 "\"spheres\":[{\"center\":[0,0,0],\"radius\":1,\"material\":\"m\"}]}",
                                 width, width > 1 ? 1.2 : 1e-4, view, material);
    uint64_t invalid = 1;
    lab_render(lab, scene, samples, 23, picture, &invalid);
    assert_int_equal(invalid, 0);
    bp_scene_destroy(&scene);
}

/* 23: a lambertian sphere in a white sky is as bright as its albedo, or the sky is seen; nothing else. */
static void furnace_lambert(void **state) {
    BpPicture picture = {0};
    render_material(*state, "\"type\":\"lambertian\",\"albedo\":[0.75,0.75,0.75]", 0, 32, 16, &picture);
    size_t inner = 0;
    for (size_t i = 0; i < 32 * 32; ++i) {
        /* within 0.9 of the sphere's half-width in the picture (0.95 of the picture's) */
        const double x = ((double)(i % 32) - 15.5) / 16 * 1.047, y = ((double)(i / 32) - 15.5) / 16 * 1.047;
        const float value = picture.rgb[3 * i];
        assert_true(value >= 0.75f && value <= 1.0f);
        if (x * x + y * y > 0.8) continue;
        ++inner;
        assert_true(value == 0.75f);
    }
    assert_true(inner > 500);
    bp_picture_clear(&picture);
}

/* 24: glass in a white sky is white, to the bit, and no path is lost on the way. */
static void furnace_glass(void **state) {
    static const char *const materials[] = {
        "\"type\":\"dielectric\",\"refraction_index\":1.5,\"fresnel\":\"exact\"",
        "\"type\":\"dielectric\",\"refraction_index\":1.5",
        "\"type\":\"dielectric\",\"refraction_index\":0.6666,\"fresnel\":\"exact\""};
    for (int k = 0; k < 3; ++k) {
        BpPicture picture = {0};
        render_material(*state, materials[k], 0, 32, 64, &picture);
        for (size_t i = 0; i < 32 * 32 * 3; ++i) assert_true(picture.rgb[i] == 1.0f);
        bp_picture_clear(&picture);
    }
}

/* 25: where the cosine of incidence is c, a mirror of fuzz f loses (1-x)/2 with sphere fuzz and (2-3x+x^3)/4
 * with ball fuzz below the surface, x = c/f < 1. Five sigma. Fuzz over 1 is 1. */
static void furnace_fuzz(void **state) {
    static const char *const shapes[] = {"sphere", "ball"};
    const double offsets[] = {0.6, 0.9, 0.99};
    enum { SAMPLES = 1 << 16 };
    for (int shape = 0; shape < 2; ++shape)
        for (int k = 0; k < 3; ++k) {
            char material[160];
            BpPicture picture = {0};
            snprintf(material, sizeof material,
                     "\"type\":\"metal\",\"albedo\":[1,1,1],\"fuzz\":1,\"fuzz_shape\":\"%s\"", shapes[shape]);
            render_material(*state, material, offsets[k], 1, SAMPLES, &picture);
            /* the ray comes from 100 away, a little tilted */
            const double b = offsets[k] / sqrt(1 + offsets[k] * offsets[k] / 1e4);
            const double x = sqrt(1 - b * b);
            const double loss = shape == 0 ? (1 - x) / 2 : (2 - 3 * x + x * x * x) / 4;
            const double sigma = sqrt(loss * (1 - loss) / SAMPLES);
            const double lost = 1 - (double)picture.rgb[0];
            print_message("    %s fuzz, cosine %.3f: lost %.4f, expected %.4f\n", shapes[shape], x, lost,
                          loss);
            assert_true(fabs(lost - loss) <= 5 * sigma);
            bp_picture_clear(&picture);
        }
    BpPicture one = {0}, five = {0};
    render_material(*state, "\"type\":\"metal\",\"albedo\":[1,1,1],\"fuzz\":1", 0.9, 1, 256, &one);
    render_material(*state, "\"type\":\"metal\",\"albedo\":[1,1,1],\"fuzz\":5", 0.9, 1, 256, &five);
    for (int c = 0; c < 3; ++c) assert_true(one.rgb[c] == five.rgb[c]);
    bp_picture_clear(&one);
    bp_picture_clear(&five);
}

int run_dielectric(Lab *lab) {
    const struct CMUnitTest tests[] = {
        HARD_TEST(critical_angle),     HARD_TEST(fresnel_table),   HARD_TEST(fresnel_mean),
        HARD_TEST(indices_far_from_1), HARD_TEST(furnace_lambert), HARD_TEST(furnace_glass),
        HARD_TEST(furnace_fuzz),
    };
    return cmocka_run_group_tests_name("dielectric", tests, NULL, NULL);
}
