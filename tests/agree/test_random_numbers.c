/* test_random_numbers.c: the kernel's random bits against an independent implementation, and its uniform
 * numbers at the ends of their range. */
#include "support/probe.h"

#include <string.h>

static const char probe_text[] =
    "__kernel void bits(uint seed_low, uint seed_high, __global uint *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const SampleKey key = mix_key(seed_low, seed_high, i % 61u * 7919u, i / 61u * 104729u);\n"
    "    out[i] = random_bits(key, i % 97u);\n"
    "}\n"
    "__kernel void ends(uint first, uint unused, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    out[i] = bits_to_unit(first + i);\n"
    "}\n";

/* pcg4d as its authors print it (Jarzynski and Olano, 2020, listing 4), then the finaliser that rng.cl
 * describes. */
static uint32_t expected_bits(uint32_t seed_low, uint32_t seed_high, uint32_t pixel, uint32_t sample,
                              uint32_t dimension) {
    uint32_t v[4] = {pixel, sample, seed_low, seed_high};
    for (int i = 0; i < 4; ++i) v[i] = v[i] * 1664525u + 1013904223u;
    for (int round = 0; round < 2; ++round) {
        v[0] += v[1] * v[3];
        v[1] += v[2] * v[0];
        v[2] += v[0] * v[1];
        v[3] += v[1] * v[2];
        if (round == 0)
            for (int i = 0; i < 4; ++i) v[i] ^= v[i] >> 16;
    }
    uint32_t x = v[0] + dimension * 0x9e3779b9u;
    x = (x ^ x >> 16) * 0x21f0aaadu + v[3];
    x = (x ^ x >> 15) * 0xd35a2d97u;
    return x ^ x >> 15;
}

static void bits_are_the_documented_ones(void **state) {
    const Probe *probe = *state;
    static uint32_t found[61 * 97 * 4];
    const uint32_t seeds[3][2] = {{0, 0}, {1, 0}, {0xdeadbeefu, 0x12345678u}};
    for (int s = 0; s < 3; ++s) {
        const size_t count = sizeof found / sizeof found[0];
        probe_run(probe, "bits", seeds[s][0], seeds[s][1], count, found, sizeof found);
        for (uint32_t i = 0; i < count; ++i)
            assert_int_equal(found[i],
                             expected_bits(seeds[s][0], seeds[s][1], i % 61 * 7919, i / 61 * 104729, i % 97));
    }
}

/* 2^32 bit patterns are too many; the first and last half million hold both ends. */
static void uniform_numbers_stay_below_one(void **state) {
    const Probe *probe = *state;
    static float found[1 << 19];
    const size_t count = sizeof found / sizeof found[0];
    probe_run(probe, "ends", 0, 0, count, found, sizeof found);
    assert_true(found[0] == 0);
    for (size_t i = 0; i < count; ++i) assert_true(found[i] >= 0 && found[i] < 1);
    probe_run(probe, "ends", (cl_uint)0u - (cl_uint)count, 0, count, found, sizeof found);
    for (size_t i = 0; i < count; ++i) assert_true(found[i] >= 0.9f && found[i] < 1);
    assert_true(found[count - 1] == 1 - 0x1p-24f);
}

static int open_probe(void **state) {
    static Probe probe;
    probe_open(&probe, probe_text);
    *state = &probe;
    return 0;
}
static int close_probe(void **state) {
    probe_close(*state);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(bits_are_the_documented_ones),
                                       cmocka_unit_test(uniform_numbers_stay_below_one)};
    return cmocka_run_group_tests(tests, open_probe, close_probe);
}
