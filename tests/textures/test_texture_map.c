/* test_texture_map.c: the kernel's longitude, latitude and lattice against the library and against wider
 * numbers. */
#include "support/probe.h"

#include <math.h>
#include <stdlib.h>

#define COUNT 65536u
#define PI 3.14159265358979323846

/* Angles all around, at lengths from 1e-30 to 1e30 of which squares would not be floats, and every sign of 0.
 */
static const char text[] =
    "__kernel void probe_turn(uint count, uint unused, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const float angle = (float)i * (6.2831853f / (float)count);\n"
    "    const float size = i % 3 == 0 ? 1e30f : i % 3 == 1 ? 1.0f : 1e-30f;\n"
    "    float x = size * cos(angle), y = size * sin(angle);\n"
    "    if (i % 64 == 0) x = i % 128 == 0 ? 0.0f : -0.0f;\n"
    "    if (i % 64 == 1) y = i % 128 == 1 ? 0.0f : -0.0f;\n"
    "    if (i == 128) y = 0.0f;\n"
    "    out[3 * i] = x; out[3 * i + 1] = y;\n"
    "    out[3 * i + 2] = turn_of(x, y);\n"
    "}\n"
    "__kernel void probe_map(uint count, uint unused, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const float tiny = exp2(-(float)(i % 149));\n"
    "    const int which = (int)(i / 149) % 4;\n"
    "    float x = which == 0 ? tiny : which == 1 ? -1.0f : which == 2 ? -0.6f : -tiny;\n"
    "    float z = which == 0 ? -tiny : which == 1 ? tiny : which == 2 ? -tiny : 0.5f * tiny;\n"
    "    float y = which == 0 ? 1.0f : which == 1 ? 0.0f : which == 2 ? 0.8f : -1.0f;\n"
    "    float u, v;\n"
    "    sphere_map(vec3(x, y, z), vec3(-1, 0, 0), vec3(0, 0, 1), vec3(0, 1, 0), &u, &v);\n"
    "    out[5 * i] = x; out[5 * i + 1] = y; out[5 * i + 2] = z; out[5 * i + 3] = u; out[5 * i + 4] = v;\n"
    "}\n"
    "__kernel void probe_lattice(uint count, uint unused, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const float high = ((float)i - 32768.5f) * exp2((float)(i % 40) - 20.0f), low = high * 1e-9f;\n"
    "    const float scale = 1.0f / 0.3f, scale_low = 1.490116e-8f * (float)(i % 7), rest = (float)(i % 11) "
    "/ 11.0f;\n"
    "    uint cell; float in_cell;\n"
    "    lattice_axis(0, high, low, scale, scale_low, rest, 4194303u, &cell, &in_cell);\n"
    "    out[8 * i] = high; out[8 * i + 1] = low; out[8 * i + 2] = scale; out[8 * i + 3] = scale_low;\n"
    "    out[8 * i + 4] = rest; out[8 * i + 5] = (float)(cell % LATTICE_PERIOD); out[8 * i + 6] = in_cell;\n"
    "}\n";

static float *run(const Probe *probe, const char *name, uint32_t numbers) {
    const size_t bytes = sizeof(float) * numbers * COUNT;
    float *out = malloc(bytes);
    assert_non_null(out);
    probe_run(probe, name, COUNT, 0, COUNT, out, bytes);
    return out;
}

/* The distance of two places around, both from 0 to 1. */
static double around(double a, double b) {
    const double apart = fabs(a - b);
    return fmin(apart, 1 - apart);
}

static void turns(const Probe *probe) {
    float *out = run(probe, "probe_turn", 3);
    double worst = 0;
    for (size_t i = 0; i < COUNT; ++i) {
        const double x = (double)out[3 * i], y = (double)out[3 * i + 1], turn = (double)out[3 * i + 2];
        assert_true(turn >= 0 && turn <= 1);
        const double expected = fabs(x) > 0 || fabs(y) > 0 ? atan2(y, x) / (2 * PI) : 0;
        worst = fmax(worst, around(turn, expected < 0 ? expected + 1 : expected));
    }
    assert_true(out[3 * 128] <= 0 && out[3 * 128 + 1] <= 0 && out[3 * 128 + 2] <= 0); /* the origin */
    printf("turn_of: off by %.3g turns at most\n", worst);
    assert_true(worst <= 6e-8);
    free(out);
}

/* At poles and seam, as close as floats go. */
static void maps(const Probe *probe) {
    float *out = run(probe, "probe_map", 5);
    double worst_u = 0, worst_v = 0;
    for (size_t i = 0; i < COUNT; ++i) {
        const double x = (double)out[5 * i], y = (double)out[5 * i + 1], z = (double)out[5 * i + 2];
        const double u = (double)out[5 * i + 3], v = (double)out[5 * i + 4];
        assert_true(u >= 0 && u <= 1 && v >= 0 && v <= 1);
        worst_u = fmax(worst_u, around(u, (atan2(-z, x) + PI) / (2 * PI)));
        /* Squares of less than 2^-75 vanish: to the pole itself. */
        worst_v = fmax(worst_v, fabs(v - atan2(hypot(x, z), -y) / PI));
    }
    printf("sphere_map: off by %.3g around, %.3g from pole to pole at most\n", worst_u, worst_v);
    assert_true(worst_u <= 6e-8 && worst_v <= 1.2e-7);
    free(out);
}

/* Against exact sums: products of floats are exact in 64 bits of mantissa and more. */
static void lattices(const Probe *probe) {
    float *out = run(probe, "probe_lattice", 8);
    double worst = 0;
    for (size_t i = 0; i < COUNT; ++i) {
        const long double high = (long double)out[8 * i], low = (long double)out[8 * i + 1];
        const long double scale = (long double)out[8 * i + 2] + (long double)out[8 * i + 3];
        const long double place = high * scale + low * scale + (long double)out[8 * i + 4] + 4194303;
        const long double found = (long double)out[8 * i + 5] + (long double)out[8 * i + 6];
        assert_true(out[8 * i + 6] >= 0 && out[8 * i + 6] <= 1);
        const long double apart = fabsl(fmodl(place - found, 4194304));
        /* What is lost is of second order: 2^-48 of the place. */
        const long double allowed = 4e-7L + fabsl(place) * 0x1p-46L;
        worst = fmax(worst, (double)(fminl(apart, 4194304 - apart) / allowed));
    }
    printf("lattice_axis: off by %.3g of what is allowed\n", worst);
    assert_true(worst <= 1);
    free(out);
}

static void place_on_map_and_in_lattice(void **state) {
    (void)state;
    Probe probe;
    probe_open(&probe, text);
    turns(&probe);
    maps(&probe);
    lattices(&probe);
    probe_close(&probe);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(place_on_map_and_in_lattice)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
