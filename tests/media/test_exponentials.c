/* test_exponentials.c: the kernel's exponential function, flights and phase function against the library's,
 * in wider numbers. */
#include "support/probe.h"

#include <math.h>
#include <stdlib.h>

#define COUNT 65536u

static const char text[] =
    "__kernel void probe_exp(uint count, uint unused, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const float x = i % 4 == 0 ? 1e-3f * (float)i : i % 4 == 1 ? exp2(-(float)(i % 97)) : (float)i / "
    "820.0f;\n"
    "    out[2 * i] = x; out[2 * i + 1] = exp_minus(x);\n"
    "}\n"
    "__kernel void probe_length(uint count, uint unused, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const uint k = i % 8 == 0 ? i / 8 : i % 8 == 1 ? 0xffffffu - i / 8 : i % 8 == 2 ? 0u : i % 8 == 3 ? "
    "0xffffffu : i * 256u + 77u;\n"
    "    const float u = (float)(k & 0xffffffu) * 0x1p-24f;\n"
    "    const float refill = (float)((i * 2654435761u) >> 8) * 0x1p-24f;\n"
    "    out[3 * i] = u; out[3 * i + 1] = refill; out[3 * i + 2] = exponential_length(u, refill);\n"
    "}\n"
    "__kernel void probe_phase(uint count, uint unused, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const float g = i % 3 == 0 ? 0.999f * ((float)(i % 201) / 100.0f - 1.0f) : i % 3 == 1 ? "
    "exp2(-(float)(i % 40)) * 0.9f : 0.0f;\n"
    "    const float u = (float)((i * 2654435761u) >> 8) * 0x1p-24f;\n"
    "    float plus, minus;\n"
    "    phase_cosine(g, u, &plus, &minus);\n"
    "    out[4 * i] = g; out[4 * i + 1] = u; out[4 * i + 2] = plus; out[4 * i + 3] = minus;\n"
    "}\n";

static float *run(const Probe *probe, const char *name, uint32_t numbers) {
    const size_t bytes = sizeof(float) * numbers * COUNT;
    float *out = malloc(bytes);
    assert_non_null(out);
    probe_run(probe, name, COUNT, 0, COUNT, out, bytes);
    return out;
}

static void exponentials(const Probe *probe) {
    float *out = run(probe, "probe_exp", 2);
    double worst = 0;
    for (size_t i = 0; i < COUNT; ++i) {
        const double x = (double)out[2 * i], found = (double)out[2 * i + 1];
        if (x > 80)
            assert_true(found <= 0 && found >= 0);
        else
            worst = fmax(worst, fabs(found / exp(-x) - 1));
    }
    assert_true(out[1] >= 1 && out[1] <= 1); /* of 0 */
    printf("exp_minus: off by %.3g of itself at most\n", worst);
    assert_true(worst <= 2.5e-7);
    free(out);
}

/* Relative to the length itself, from the shortest to the longest. */
static void lengths(const Probe *probe) {
    float *out = run(probe, "probe_length", 3);
    double worst = 0, least = INFINITY, most = 0;
    for (size_t i = 0; i < COUNT; ++i) {
        const long double refill = (long double)out[3 * i + 1] * 0x1p-24L, u = (long double)out[3 * i];
        const double found = (double)out[3 * i + 2], expected = (double)-log1pl(-(u + refill));
        if (expected > 0) worst = fmax(worst, fabs(found / expected - 1));
        if (expected > 0) least = fmin(least, found);
        most = fmax(most, found);
    }
    printf("exponential_length: off by %.3g of itself at most, from %.3g to %.3g\n", worst, least, most);
    assert_true(worst <= 4e-7);
    assert_true(least > 0 && least < 1e-10 && most > 20); /* finer than 24 bits at both ends */
    free(out);
}

/* By the distribution function of Henyey and Greenstein, (1 - g^2) / (2 g) (1 / sqrt(1 + g^2 - 2 g c) - 1 /
 * (1 + g)), with 1 + g^2 - 2 g c = (1 - g)^2 + 2 g (1 - c). A rounded 1 + c or 1 - c makes an error of the
 * share. */
static void phases(const Probe *probe) {
    float *out = run(probe, "probe_phase", 4);
    double worst = 0;
    for (size_t i = 0; i < COUNT; ++i) {
        const long double g = (long double)out[4 * i], u = (long double)out[4 * i + 1];
        const long double plus = (long double)out[4 * i + 2], minus = (long double)out[4 * i + 3];
        assert_true(plus >= 0 && minus >= 0 && fabsl(plus + minus - 2) < 1e-6L);
        const long double square =
            plus < minus ? (1 + g) * (1 + g) - 2 * g * plus : (1 - g) * (1 - g) + 2 * g * minus;
        const long double share =
            fabsl(g) < 1e-6L ? plus / 2 : (1 - g * g) / (2 * g) * (1 / sqrtl(square) - 1 / (1 + g));
        const long double density = (1 - g * g) / (2 * powl(square, 1.5L));
        worst = fmax(worst, (double)(fabsl(share - u) / (1e-6L + 1e-6L * density * fminl(plus, minus))));
    }
    printf("phase_cosine: off by %.3g of what is allowed\n", worst);
    assert_true(worst <= 1);
    free(out);
}

static void as_the_library_has_them(void **state) {
    (void)state;
    Probe probe;
    probe_open(&probe, text);
    exponentials(&probe);
    lengths(&probe);
    phases(&probe);
    probe_close(&probe);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(as_the_library_has_them)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
