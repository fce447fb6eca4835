/* test_random_numbers.c: the kernel's random bits, and the pairs of its low-discrepancy sequence, against an
 * independent implementation; and its uniform numbers at the ends of their range. */
#include "support/probe.h"

#include <string.h>

static const char probe_text[] =
    "__kernel void bits(uint seed_low, uint seed_high, __global uint *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const SampleKey key = mix_key(seed_low, seed_high, i % 61u * 7919u, i / 61u * 104729u);\n"
    "    out[i] = random_bits(key, i % 97u);\n"
    "}\n"
    "__kernel void pairs(uint seed_low, uint seed_high, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    float u, v;\n"
    "    sample_2d(sample_key(seed_low, seed_high, i % 61u * 7919u, i / 61u * 13u, 4u), splat_uint(i % 62u), "
    "&u, &v);\n"
    "    out[2u * i] = u;\n"
    "    out[2u * i + 1u] = v;\n"
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

static uint32_t mirrored(uint32_t x) {
    uint32_t y = 0;
    for (int bit = 0; bit < 32; ++bit) y |= (x >> bit & 1u) << (31 - bit);
    return y;
}

/* Laine and Karras, 2011, with the constants of N. Vegdahl that Burley recommends, as sampler.cl documents
 * them. */
static uint32_t laine_karras(uint32_t x, uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    return x ^ x * 0x53a22864u;
}

/* The first two dimensions of Sobol's sequence by direction numbers (S. Joe, F. Kuo, 2008): 1/2, 1/4, ...
 * and, for the polynomial x + 1, v = v before, and half of it. */
static void sobol_pair(uint32_t index, uint32_t pair[2]) {
    uint32_t first = 0x80000000u, second = 0x80000000u;
    pair[0] = pair[1] = 0;
    for (; index != 0; index >>= 1) {
        if (index & 1u) {
            pair[0] ^= first;
            pair[1] ^= second;
        }
        first >>= 1;
        second ^= second >> 1;
    }
}

/* Burley, 2020, listing 3: the index shuffled, then the second number scrambled; the first needs no more. */
static void pairs_are_the_documented_ones(void **state) {
    (void)state;
    enum { COUNT = 61 * 62 * 4 };
    static float found[COUNT][2];
    Probe probe;
    probe_open_sampler(&probe, BP_SAMPLER_SOBOL, probe_text);
    const uint32_t low = 0xdeadbeefu, high = 0x12345678u;
    probe_run(&probe, "pairs", low, high, COUNT, found, sizeof found);
    probe_close(&probe);
    for (uint32_t i = 0; i < COUNT; ++i) {
        const uint32_t pixel = i % 61 * 7919, sample = i / 61 * 13, replicate = ~(sample % 4),
                       dimension = i % 62;
        uint32_t pair[2];
        sobol_pair(mirrored(laine_karras(mirrored(sample / 4),
                                         expected_bits(low, high, pixel, replicate, dimension))),
                   pair);
        pair[1] = mirrored(
            laine_karras(mirrored(pair[1]), expected_bits(low, high, pixel, replicate, dimension + 1)));
        for (int d = 0; d < 2; ++d) assert_true(found[i][d] == (float)(pair[d] >> 8) * 0x1p-24f);
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

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(bits_are_the_documented_ones),
                                       cmocka_unit_test(pairs_are_the_documented_ones),
                                       cmocka_unit_test(uniform_numbers_stay_below_one)};
    return probe_run_group(tests, probe_text);
}
