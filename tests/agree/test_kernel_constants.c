/* test_kernel_constants.c: what the kernel draws, against closed forms that are off by a constant that is off
 * by one in a hundred: the width of fuzz, how often glass reflects, how long flights are. */
#include "packed/pack.h"
#include "support/probe.h"
#include "support/uniformity.h"

#include <stdio.h>

enum { COUNT = 4000000 };
static float drawn[COUNT * 3];
static double points[COUNT];

static const char probe_text[] =
    "static SampleKey probe_key(uint seed, uint i) { return sample_key(seed, 5u, i & 0xfffu, i >> 12, 4u); "
    "}\n"
    /* fuzz of 0.3 around the mirror direction of a ray that falls at an angle */
    "__kernel void fuzz(uint seed, uint variant, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    Surface surface;\n"
    "    surface.normal = vec3(splat(0), splat(0), splat(1));\n"
    "    surface.incoming = vec3(splat(0.6f), splat(0), splat(-0.8f));\n"
    "    surface.fuzz = splat(0.3f);\n"
    "    surface.variant = splat_uint(variant);\n"
    "    const Vec3 d = metal_sample(&surface, probe_key(seed, i), splat_uint(DIMENSION_BOUNCE)).direction;\n"
    "    vstore3((float3)(d.x, d.y, d.z), i, out);\n"
    "}\n"
    /* glass of index 1.5; case: from inside 1, exact 2, and four cosines of incidence */
    "__kernel void glass(uint seed, uint which, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const float cosines[4] = {0.96f, 0.8f, 0.352f, 0.28f};\n"
    "    const float c = cosines[which >> 2];\n"
    "    Surface surface;\n"
    "    surface.normal = vec3(splat(0), splat(0), splat(1));\n"
    "    surface.incoming = vec3(splat(sqrt(1.0f - c * c)), splat(0), splat(-c));\n"
    "    surface.enters = (which & 1u) != 0 ? vbool_none : vbool_all;\n"
    "    surface.refraction_index = splat(1.5f);\n"
    "    surface.variant = splat_uint((which & 2u) != 0 ? FRESNEL_EXACT : FRESNEL_SCHLICK);\n"
    "    surface.total_reflection = splat_uint(TOTAL_REFLECT);\n"
    "    const BsdfSample drawn = dielectric_sample(&surface, probe_key(seed, i), "
    "splat_uint(DIMENSION_BOUNCE));\n"
    "    vstore3((float3)(any_lane(drawn.transmitted) ? 1 : 0, drawn.direction.x, drawn.direction.z), i, "
    "out);\n"
    "}\n"
    "__kernel void fresnel(uint seed, uint unused, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const float n = 1.5f, c = (i + 0.5f) / 4096, t = sqrt(1 - (1 - c) * (1 + c) / (n * n));\n"
    "    vstore3((float3)(c, fresnel_exact(splat(c), splat(n), splat(t)), fresnel_schlick(splat(c), "
    "splat(n))), i, out);\n"
    "}\n"
    "__kernel void flight(uint seed, uint unused, __global float *out) {\n"
    "    const uint i = get_global_id(0), first = DIMENSION_BOUNCE;\n"
    "    const SampleKey key = probe_key(seed, i);\n"
    "    vstore3((float3)(exponential_length(uniform(key, first + BOUNCE_FLIGHT), uniform(key, first + "
    "BOUNCE_FLIGHT_REFILL)), 0, 0), i, out);\n"
    "}\n";

static void draw(const Probe *probe, const char *kernel, cl_uint variant) {
    static cl_uint seed = 100;
    probe_run(probe, kernel, seed++, variant, COUNT, drawn, sizeof drawn);
}

static double along(const float *v, double x, double y, double z) {
    return (double)v[0] * x + (double)v[1] * y + (double)v[2] * z;
}

/* The rim of the cone is where a circle of radius f around the tip of the mirror direction is seen, at the
 * angle asin f; on the sphere of fuzz, most directions lie near it. The mean of the cosine: of c + h and c -
 * h weighted by their squares, by quadrature. */
static void fuzz(void **state) {
    const double f = (double)0.3f;
    for (cl_uint ball = 0; ball < 2; ++ball) {
        double widest = 0, mean = 0, wanted = 0, weight = 0;
        draw(*state, "fuzz", ball ? FUZZ_BALL : FUZZ_SPHERE);
        for (size_t i = 0; i < COUNT; ++i) {
            const double cosine = along(&drawn[3 * i], 0.6, 0, 0.8);
            const double across = hypot((double)drawn[3 * i + 1], along(&drawn[3 * i], -0.8, 0, 0.6));
            widest = fmax(widest, across);
            mean += cosine / COUNT;
        }
        for (int i = 0; i < 2000; ++i) /* the point of the sphere or ball at height z and radius r, as seen */
            for (int k = 0; k < (ball ? 400 : 1); ++k) {
                const double r = ball ? f * (k + 0.5) / 400 : f, z = (i + 0.5) / 1000 - 1;
                const double ahead = 1 + r * z, aside2 = r * r * (1 - z * z), share = ball ? r * r : 1;
                wanted += share * ahead / sqrt(ahead * ahead + aside2);
                weight += share;
            }
        wanted /= weight;
        printf("fuzz %u: widest %.5f of %.5f, mean cosine %.6f of %.6f\n", ball, widest, f, mean, wanted);
        assert_true(widest < f * 1.00001 && widest > f * (ball ? 0.99 : 0.9999));
        assert_true(fabs((1 - mean) / (1 - wanted) - 1) < 0.002);
    }
}

/* A. Fresnel, 1823: the mean of the two polarisations. */
static double reflectance(double c, double n) {
    const double t = sqrt(1 - (1 - c * c) / (n * n));
    return 0.5 * (pow((c - n * t) / (c + n * t), 2) + pow((n * c - t) / (n * c + t), 2));
}

static void fresnel(void **state) {
    probe_run(*state, "fresnel", 0, 0, 4096, drawn, 4096 * 3 * sizeof *drawn);
    for (size_t i = 0; i < 4096; ++i) {
        const double c = (double)drawn[3 * i], r0 = 0.04;
        assert_true(fabs((double)drawn[3 * i + 1] / reflectance(c, 1.5) - 1) < 1e-4 ||
                    fabs((double)drawn[3 * i + 1] - reflectance(c, 1.5)) < 1e-6);
        assert_true(fabs((double)drawn[3 * i + 2] - (r0 + (1 - r0) * pow(1 - c, 5))) < 1e-6);
    }
}

/* How often glass reflects, and where it sends the rest (W. Snell). */
static void glass(void **state, bool exact) {
    static const double cosines[4] = {0.96, 0.8, 0.352, 0.28};
    for (cl_uint which = 0; which < 16; ++which) {
        if (((which & 2) != 0) != exact) continue;
        const double c = cosines[which >> 2], n = which & 1 ? 1 / 1.5 : 1.5, sine = sqrt(1 - c * c);
        const bool total = sine > n;
        const double wanted = total ? 1 : exact ? reflectance(c, n) : 0.04 + 0.96 * pow(1 - c, 5);
        double mirrored = 0;
        draw(*state, "glass", which);
        for (size_t i = 0; i < COUNT; ++i) {
            const float *d = &drawn[3 * i];
            const bool through = d[0] > 0.5f;
            assert_true(fabs((double)d[1] - (through ? sine / n : sine)) < 1e-6);
            assert_true(through ? d[2] < 0 : fabs((double)d[2] - c) < 1e-6);
            mirrored += through ? 0 : 1.0 / COUNT;
        }
        const double error = sqrt(wanted * (1 - wanted) / COUNT);
        printf("glass %2u: reflects %.5f of %.5f\n", which, mirrored, wanted);
        if (fabs(mirrored - wanted) > 4.5 * error + 1e-6) fail_msg("reflects %g, not %g", mirrored, wanted);
    }
}
static void glass_exact(void **state) {
    glass(state, true);
}
static void glass_by_schlick(void **state) {
    glass(state, false);
}

/* The distribution is exponential, of mean 1. */
static void flight(void **state) {
    double mean = 0;
    draw(*state, "flight", 0);
    for (size_t i = 0; i < COUNT; ++i) {
        mean += (double)drawn[3 * i] / COUNT;
        points[i] = -expm1(-(double)drawn[3 * i]);
    }
    assert_true(uniformity(points, COUNT, 1) > 1e-5);
    assert_true(fabs(mean - 1) < 0.0025);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(fuzz), cmocka_unit_test(fresnel),
                                       cmocka_unit_test(glass_exact), cmocka_unit_test(glass_by_schlick),
                                       cmocka_unit_test(flight)};
    return probe_run_group(tests, probe_text);
}
