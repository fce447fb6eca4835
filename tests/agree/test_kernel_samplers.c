/* test_kernel_samplers.c: every direction and point the kernel draws, against the law it should follow; and
 * pairs of dimensions, and pixels, which must be independent, also in a low-discrepancy sequence. */
#include "support/probe.h"
#include "support/uniformity.h"

#include <stdio.h>

enum { COUNT = 4000000 };
static const double level = 1e-5;
static float drawn[COUNT * 3];
static double points[COUNT * 3];

/* The normal of test_reference_samplers.c, along no axis. */
static const char probe_text[] =
    "static SampleKey probe_key(uint seed, uint i) { return sample_key(seed, 5u, i & 0xfffu, i >> 12, 4u); "
    "}\n"
    "__kernel void lobe(uint seed, uint lobe, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    Surface surface;\n"
    "    surface.normal = vec3(splat(0.36f), splat(0.48f), splat(0.8f));\n"
    "    surface.lobe = splat_uint(lobe);\n"
    "    const BsdfSample drawn =\n"
    "        lambertian_sample(&surface, probe_key(seed, i), splat_uint(DIMENSION_BOUNCE));\n"
    "    const Vec3 d = drawn.direction;\n"
    "    vstore3((float3)(d.x, d.y, d.z), i, out);\n"
    "}\n"
    "__kernel void ball(uint seed, uint inside, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const SampleKey key = probe_key(seed, i);\n"
    "    Vec3 d = random_direction(key, splat_uint(DIMENSION_BOUNCE));\n"
    "    if (inside) d = scale3(random_ball_radius(key, splat_uint(DIMENSION_BOUNCE)), d);\n"
    "    vstore3((float3)(d.x, d.y, d.z), i, out);\n"
    "}\n"
    "__kernel void disk(uint seed, uint unused, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    vreal u, v, x, y;\n"
    "    sample_2d(probe_key(seed, i), splat_uint(DIMENSION_LENS), &u, &v);\n"
    "    sample_disk(u, v, &x, &y);\n"
    "    vstore3((float3)(x, y, 0), i, out);\n"
    "}\n"
    /* of many pixels, one sample each: the same numbers in two pixels, or two pairs in one */
    "__kernel void neighbours(uint seed, uint which, __global float *out) {\n"
    "    const uint i = get_global_id(0), step = which < 2u ? 1u : which < 4u ? 640u : 0u, sample = (which & "
    "1u) * 5u;\n"
    "    float u, v, s, t;\n"
    "    sample_2d(sample_key(seed, 5u, i, sample, 4u), splat_uint(DIMENSION_PIXEL), &u, &v);\n"
    "    sample_2d(sample_key(seed, 5u, i + step, sample, 4u), splat_uint(step > 0 ? DIMENSION_PIXEL : "
    "DIMENSION_LENS), &s, &t);\n"
    "    vstore3((float3)(u, s, 0), i, out);\n"
    "}\n"
    "__kernel void couple(uint seed, uint which, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const uint dimensions[4] = {DIMENSION_PIXEL, DIMENSION_LENS, DIMENSION_BOUNCE, DIMENSION_BOUNCE + "
    "BOUNCE_LAMP};\n"
    "    float u, v;\n"
    "    sample_2d(sample_key(seed, 5u, i, (which >> 2) * 7u, 4u), splat_uint(dimensions[which & 3u]), &u, "
    "&v);\n"
    "    vstore3((float3)(u, v, 0), i, out);\n"
    "}\n"
    "__kernel void pair(uint seed, uint which, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const SampleKey key = probe_key(seed, i);\n"
    "    const uint bounce = DIMENSION_BOUNCE, next = DIMENSION_BOUNCE + DIMENSIONS_PER_BOUNCE;\n"
    "    const uint dimensions[7][2] = {{DIMENSION_PIXEL, DIMENSION_PIXEL + 1}, {DIMENSION_PIXEL, "
    "DIMENSION_LENS},\n"
    "        {DIMENSION_LENS, bounce + BOUNCE_DIRECTION}, {bounce + BOUNCE_DIRECTION, bounce + "
    "BOUNCE_DIRECTION + 1},\n"
    "        {bounce + BOUNCE_DIRECTION, next + BOUNCE_DIRECTION}, {bounce + BOUNCE_DIRECTION, bounce + "
    "BOUNCE_BALL_RADIUS},\n"
    "        {bounce + BOUNCE_CHOICE, next + BOUNCE_CHOICE}};\n"
    "    vstore3((float3)(uniform(key, dimensions[which][0]), uniform(key, dimensions[which][1]), 0), i, "
    "out);\n"
    "}\n";

static void assert_uniform(const char *what, int dimensions) {
    const double p = uniformity(points, COUNT, dimensions);
    printf("%-42s p = %.4f\n", what, p);
    if (p < level) fail_msg("%s: p = %g", what, p);
}

static void draw(const Probe *probe, const char *kernel, cl_uint variant) {
    static cl_uint seed = 100;
    probe_run(probe, kernel, seed++, variant, COUNT, drawn, sizeof drawn);
}

static double along(const float *v, double x, double y, double z) {
    return (double)v[0] * x + (double)v[1] * y + (double)v[2] * z;
}

static void lobes(void **state) {
    static const char *names[3] = {"lambertian", "cosine cubed", "hemisphere"};
    static const double powers[3] = {2, 4, 1}; /* of the cosine, to be uniform */
    for (cl_uint lobe = 0; lobe < 3; ++lobe) {
        draw(*state, "lobe", lobe);
        for (size_t i = 0; i < COUNT; ++i) {
            const float *d = &drawn[3 * i];
            const double cosine = along(d, 0.36, 0.48, 0.8);
            assert_true(fabs(along(d, (double)d[0], (double)d[1], (double)d[2]) - 1) < 1e-6);
            points[2 * i] = fmin(1, fmax(cosine, 0)); /* single precision may leave [0, 1] by an ulp */
            points[2 * i] = pow(points[2 * i], powers[lobe]);
            points[2 * i + 1] = turn(along(d, 0.48, 0.64, -0.6), along(d, 0.8, -0.6, 0));
        }
        assert_uniform(names[lobe], 2);
    }
}

static void sphere_and_ball(void **state) {
    for (cl_uint inside = 0; inside < 2; ++inside) {
        const int dimensions = inside ? 3 : 2;
        draw(*state, "ball", inside);
        for (size_t i = 0; i < COUNT; ++i) {
            const float *d = &drawn[3 * i];
            const double r = sqrt(along(d, (double)d[0], (double)d[1], (double)d[2]));
            double *point = &points[(size_t)dimensions * i];
            point[0] = r > 0 ? 0.5 * fmin(2, 1 + (double)d[2] / r) : 0.5;
            point[1] = turn((double)d[1], (double)d[0]);
            if (inside) point[2] = fmin(1, r * r * r);
        }
        assert_uniform(inside ? "ball" : "sphere", dimensions);
    }
}

static void disk(void **state) {
    draw(*state, "disk", 0);
    for (size_t i = 0; i < COUNT; ++i) {
        const double x = (double)drawn[3 * i], y = (double)drawn[3 * i + 1];
        points[2 * i] = fmin(1, x * x + y * y);
        points[2 * i + 1] = turn(y, x);
    }
    assert_uniform("disk", 2);
}

static void pairs_of_dimensions(void **state) {
    static const char *names[7] = {"pixel x, y",
                                   "pixel, lens",
                                   "lens, direction",
                                   "direction u, v",
                                   "direction of two bounces",
                                   "direction, ball radius",
                                   "choice of two bounces"};
    for (cl_uint which = 0; which < 7; ++which) {
        draw(*state, "pair", which);
        for (size_t i = 0; i < COUNT; ++i)
            for (size_t d = 0; d < 2; ++d) points[2 * i + d] = (double)drawn[3 * i + d];
        assert_uniform(names[which], 2);
    }
}

/* Neighbouring pixels, and pairs of numbers, have nothing to do with each other, whatever the sampler: of any
 * one sample, over all pixels. */
static void assert_independent(const Probe *probe, const char *kernel, cl_uint cases) {
    for (cl_uint which = 0; which < cases; ++which) {
        char what[64];
        draw(probe, kernel, which);
        for (size_t i = 0; i < COUNT; ++i)
            for (size_t d = 0; d < 2; ++d) points[2 * i + d] = (double)drawn[3 * i + d];
        snprintf(what, sizeof what, "%s, case %u", kernel, which);
        assert_uniform(what, 2);
    }
}

static void independent(void **state) {
    assert_independent(*state, "neighbours", 6);
}

static void assert_sobol_independent(const char *kernel, cl_uint variants) {
    Probe probe;
    probe_open_sampler(&probe, BP_SAMPLER_SOBOL, probe_text);
    assert_independent(&probe, kernel, variants);
    probe_close(&probe);
}
static void sobol_neighbours(void **state) {
    (void)state;
    assert_sobol_independent("neighbours", 6);
}
static void sobol_couples(void **state) {
    (void)state;
    assert_sobol_independent("couple", 8);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(lobes),        cmocka_unit_test(sphere_and_ball),
                                       cmocka_unit_test(disk),         cmocka_unit_test(pairs_of_dimensions),
                                       cmocka_unit_test(independent),  cmocka_unit_test(sobol_neighbours),
                                       cmocka_unit_test(sobol_couples)};
    return probe_run_group(tests, probe_text);
}
