/* test_sampling.c: tests 26 to 32: random numbers, maps, scattering, the camera. */
#define BP_HOST
#include "suite.h"

#include "base/status.h"
#include "packed/pack.h"
#include "scene_types.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void run_random(const Lab *lab, uint32_t *bits, size_t count, double *out) {
    const LabArgument arguments[] = {
        {LAB_WORDS, bits, count}, {LAB_NUMBER, NULL, 26}, {LAB_OUT_REFINED, out, 2 * count}};
    lab_run(lab, "probe_random", count, arguments, 3, NULL);
}

/* 26: no bits make the number 1; float(u) * 2^-32 does, for 128 of them. */
static void rng_one(void **state) {
    enum { COUNT = 256 };
    uint32_t bits[COUNT];
    double out[2 * COUNT];
    int naive = 0;
    for (uint32_t i = 0; i < COUNT; ++i) {
        bits[i] = 0xffffff00u + i;
        volatile float all = (float)bits[i];
        naive += all * 0x1p-32f == 1.0f;
    }
    run_random(*state, bits, COUNT, out);
    for (int i = 0; i < COUNT; ++i) assert_true(out[2 * i] >= 0 && out[2 * i] < 1);
    assert_int_equal(naive, 128);
}

static double lag_correlation(const double *numbers, size_t count, size_t stride) {
    double mean = 0, square = 0, product = 0;
    for (size_t i = 0; i < count; ++i) mean += numbers[i * stride] / (double)count;
    for (size_t i = 0; i + 1 < count; ++i) {
        const double a = numbers[i * stride] - mean, b = numbers[(i + 1) * stride] - mean;
        square += a * a;
        product += a * b;
    }
    return product / square;
}

/* 27: neighbouring pixels' first numbers do not go together; xorshift32 seeded by the pixel, as in the book's
 * ports, does. */
static void rng_pixels(void **state) {
    enum { COUNT = 1 << 20 };
    uint32_t *bits = suite_calloc(COUNT, sizeof *bits);
    double *out = suite_calloc(2 * COUNT, sizeof *out), *naive = suite_calloc(COUNT, sizeof *naive);
    run_random(*state, bits, COUNT, out);
    for (uint32_t i = 0; i < COUNT; ++i) {
        uint32_t x = i + 1;
        x ^= x << 13;
        x ^= x >> 17;
        x ^= x << 5;
        naive[i] = (double)x * 0x1p-32;
    }
    const double ours = lag_correlation(out + 1, COUNT, 2), theirs = lag_correlation(naive, COUNT, 1);
    print_message("    correlation of neighbours %.5f; xorshift32 seeded by the pixel %.3f\n", ours, theirs);
    assert_true(fabs(ours) < 5e-3 && fabs(theirs) > 0.5);
    free(bits);
    free(out);
    free(naive);
}

/* 28: the normal is set to minus the random offset that the sample will have, exactly and up to a tenth off:
 * the direction is finite, of unit length and not below the surface, for every lobe. */
static void scatter_zero(void **state) {
    const Lab *lab = *state;
    enum { COUNT = 3 * 3000 };
    double *in = suite_calloc(COUNT * 8, sizeof *in), *out = suite_calloc(COUNT * 8, sizeof *out);
    uint32_t *words = suite_calloc(COUNT * 6, sizeof *words);
    const LabArgument arguments[] = {{LAB_REALS, in, COUNT * 8},
                                     {LAB_WORDS, words, COUNT * 6},
                                     {LAB_NUMBER, NULL, 28},
                                     {LAB_OUT_REFINED, out, COUNT * 8}};
    for (uint32_t i = 0; i < COUNT; ++i) {
        const uint32_t choice[] = {1, KIND_LAMBERTIAN, i % 3, 0, 0, i};
        memcpy(words + i * 6, choice, sizeof choice);
        in[i * 8 + 1] = -1;
        in[i * 8 + 4] = 1;
    }
    lab_run(lab, "probe_scatter", COUNT, arguments, 4, NULL);
    uint64_t seed = 28;
    for (uint32_t i = 0; i < COUNT; ++i) {
        double *normal = in + i * 8 + 3, nudge[3];
        lab_direction(&seed, nudge);
        const double size = i / 3 % 4 == 0 ? 0 : pow(10, -8 + 7 * lab_unit(&seed));
        for (int a = 0; a < 3; ++a) normal[a] = -out[i * 8 + 5 + (uint32_t)a] + size * nudge[a];
        if (size > 0) lab_float_unit(normal);
    }
    lab_run(lab, "probe_scatter", COUNT, arguments, 4, NULL);
    double lowest = 1, longest = 0;
    size_t vanished = 0;
    for (uint32_t i = 0; i < COUNT; ++i) {
        const double *direction = out + i * 8;
        for (int a = 0; a < 3; ++a) assert_true(isfinite(direction[a]));
        assert_true(direction[3] == 1);
        lowest = fmin(lowest, lab_dot(direction, in + i * 8 + 3));
        vanished += lab_dot(direction, in + i * 8 + 3) > 0.9999;
        longest = fmax(longest, fabs(sqrt(lab_dot(direction, direction)) - 1));
    }
    print_message("    least cosine %.2g, off unit length by %.2g, %zu straight up\n", lowest, longest,
                  vanished);
    assert_true(lowest >= 0 && longest <= 5e-7 && vanished > COUNT / 8 && vanished < COUNT);
    free(in);
    free(out);
    free(words);
}

/* 29: the maps at the ends and middle of their domain, and against libm in between. */
static void sampler_maps(void **state) {
    const double ends[] = {0, 0.5, 1 - 0x1p-24, 0.25, 0.75, 0x1p-24};
    enum { COUNT = 6 * 6 + 20000 };
    double *in = suite_calloc(2 * COUNT, sizeof *in), *out = suite_calloc(8 * COUNT, sizeof *out), worst = 0,
           length = 0;
    uint64_t seed = 29;
    for (size_t i = 0; i < COUNT; ++i) {
        in[2 * i] = i < 36 ? ends[i % 6] : floor(lab_unit(&seed) * 0x1p24) * 0x1p-24;
        in[2 * i + 1] = i < 36 ? ends[i / 6] : floor(lab_unit(&seed) * 0x1p24) * 0x1p-24;
    }
    const LabArgument arguments[] = {{LAB_REALS, in, 2 * COUNT}, {LAB_OUT_REFINED, out, 8 * COUNT}};
    lab_run(*state, "probe_maps", COUNT, arguments, 2, NULL);
    for (size_t i = 0; i < COUNT; ++i) {
        const double *row = out + 8 * i, u = in[2 * i], turn = 6.283185307179586 * in[2 * i + 1];
        worst = fmax(worst, fmax(fabs(row[0] - sin(turn)), fabs(row[1] - cos(turn))));
        assert_true(row[2] * row[2] + row[3] * row[3] <= u + 5e-7);
        length = fmax(length, fabs(sqrt(lab_dot(row + 4, row + 4)) - 1));
        assert_true(fabs(row[6] - (1 - 2 * u)) <= 1e-7);
        assert_true(row[7] == fmax(u, in[2 * i + 1]));
    }
    print_message("    sine and cosine off by %.2g, points of the sphere by %.2g\n", worst, length);
    assert_true(worst <= 2e-7 && length <= 3e-7);
    free(in);
    free(out);
}

/* Directions through the corners and the middle of the picture. */
static void camera_directions(const Lab *lab, const BpScene *scene, double out[5 * 6]) {
    BpPacked packed;
    const BpTreeOptions options = {
        .width = 8, .single_precision = !lab->real_double, .list = true, .threads = 1};
    assert_int_equal(bp_scene_pack(scene, &options, true, true, &packed, NULL), BP_OK);
    const double w = scene->camera.width - 1, h = scene->camera.height - 1;
    double at[10] = {0, 0, w, 0, 0, h, w, h, floor(w / 2), floor(h / 2)};
    const LabArgument arguments[] = {
        {LAB_BYTES, packed.camera, sizeof(PackedCamera) / 8 * bp_packed_real_size(&packed)},
        {LAB_REALS, at, 10},
        {LAB_OUT_REFINED, out, 30}};
    lab_run(lab, "probe_camera", 5, arguments, 3, NULL);
    bp_packed_clear(&packed);
}

/* 30: what has no picture is refused; what is almost so has unit directions. */
static void camera_degenerate(void **state) {
    static const char *const refused[] = {"\"vfov\":180",
                                          "\"vfov\":0",
                                          "\"lookfrom\":[1,2,3],\"lookat\":[1,2,3]",
                                          "\"vup\":[0,0,2]",
                                          "\"lookfrom\":[0,5,0],\"lookat\":[0,-5,0]",
                                          "\"vup\":[0,0,0]"};
    static const char *const taken[] = {"\"vfov\":179.99",     "\"vfov\":1e-6",
                                        "\"vup\":[0,1e-6,2]",  "\"lookfrom\":[0,5,1e-6],\"lookat\":[0,-5,0]",
                                        "\"focus_dist\":1e-6", "\"focus_dist\":1e9"};
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; ++i) {
        char text[256];
        BpScene *scene = NULL;
        BpError err = {0};
        snprintf(text, sizeof text, "{\"format\":1,\"camera\":{%s}}", refused[i]);
        assert_int_equal(bp_scene_parse(text, strlen(text), "test", &scene, &err), BP_ERR_SCENE);
        bp_error_clear(&err);
    }
    for (size_t i = 0; i < sizeof taken / sizeof taken[0]; ++i) {
        double out[30];
        BpScene *scene =
            suite_scene("{\"format\":1,\"camera\":{\"image_width\":64,\"aspect_ratio\":2,%s}}", taken[i]);
        camera_directions(*state, scene, out);
        for (int k = 0; k < 5; ++k)
            assert_true(fabs(sqrt(lab_dot(out + 6 * k + 3, out + 6 * k + 3)) - 1) <= 3e-7);
        bp_scene_destroy(&scene);
    }
}

/* 31: a camera and a world moved by a million, in doubles, make the same picture within a thousandth of a
 * pixel. */
static void camera_translate(void **state) {
    double out[2][30];
    BpPicture pictures[2] = {0};
    for (int k = 0; k < 2; ++k) {
        const double m = k * 1e6;
        BpScene *scene =
            suite_scene("{\"format\":1,\"camera\":{\"image_width\":1200,\"aspect_ratio\":1.5,\"vfov\":20,"
                        "\"lookfrom\":[%.17g,%.17g,%.17g],"
                        "\"lookat\":[%.17g,%.17g,%.17g]},\"materials\":{\"m\":{\"type\":\"normals\"}},"
                        "\"spheres\":[{\"center\":[%.17g,%.17g,%.17g],\"radius\":1,\"material\":\"m\"}]}",
                        13 + m, 2 + m, 3 - m, m, m, -m, 0.25 + m, 0.5 + m, -m);
        camera_directions(*state, scene, out[k]);
        assert_int_equal(bp_scene_set_width(scene, 48, NULL), BP_OK);
        lab_render(*state, scene, 4, 31, &pictures[k], NULL);
        bp_scene_destroy(&scene);
    }
    const double pixel = 2 * tan(10 / 57.29577951308232) / 800;
    for (int i = 0; i < 30; ++i) assert_true(fabs(out[0][i] - out[1][i]) <= 1e-3 * pixel);
    size_t different = 0;
    for (size_t i = 0; i < 48 * 32 * 3; ++i)
        different += fabsf(pictures[0].rgb[i] - pictures[1].rgb[i]) > 1e-3f;
    print_message("    %zu values of %d differ\n", different, 48 * 32 * 3);
    assert_true(different <= 3); /* a sample at the rim may fall on the other side */
    bp_picture_clear(&pictures[0]);
    bp_picture_clear(&pictures[1]);
}

/* 32: pictures of one pixel, one row, one column. */
static void image_1xn(void **state) {
    const unsigned sizes[][2] = {{1, 1}, {1, 4096}, {4096, 1}};
    for (int k = 0; k < 3; ++k) {
        BpPicture picture = {0};
        uint64_t invalid = 1;
        BpScene *scene =
            suite_scene("{\"format\":1,\"camera\":{\"image_width\":%u,\"image_height\":%u},\"materials\":{"
                        "\"m\":{\"type\":\"lambertian\",\"albedo\":[0.5,0.5,0.5]}},"
                        "\"spheres\":[{\"center\":[0,0,-1],\"radius\":0.5,\"material\":\"m\"}]}",
                        sizes[k][0], sizes[k][1]);
        lab_render(*state, scene, 2, 32, &picture, &invalid);
        assert_true(picture.width == sizes[k][0] && picture.height == sizes[k][1] && invalid == 0);
        for (size_t i = 0; i < (size_t)sizes[k][0] * sizes[k][1] * 3; ++i)
            assert_true(picture.rgb[i] > 0 && picture.rgb[i] <= 1);
        bp_picture_clear(&picture);
        bp_scene_destroy(&scene);
    }
}

int run_sampling(Lab *lab) {
    const struct CMUnitTest tests[] = {
        HARD_TEST(rng_one),      HARD_TEST(rng_pixels),        HARD_TEST(scatter_zero),
        HARD_TEST(sampler_maps), HARD_TEST(camera_degenerate), HARD_TEST(camera_translate),
        HARD_TEST(image_1xn),
    };
    return cmocka_run_group_tests_name("sampling", tests, NULL, NULL);
}
