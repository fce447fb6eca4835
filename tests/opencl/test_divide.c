/* test_divide.c: the kernels' own quotients and roots against IEEE's, as this processor has them.
 *
 * test_divide [STEP]: takes every STEP-th divisor; 1: all.
 *
 * The device that they start from is off by 4 units in the last place at most, more than OpenCL allows. Roots
 * depend on the mantissa and on whether the exponent is odd: all are taken, by all errors. Quotients depend
 * on both mantissas. A divisor's hardest dividends are those whose quotient lies closest to the middle
 * between two floats; they follow from its inverse modulo a power of 2. */
#include "opencl/divide_in_c.h"

#include "base/random.h"
#include "support/unit_test.h"

#include <stdio.h>
#include <stdlib.h>

enum { ERROR_MAX = 4, ERRORS = 2 * ERROR_MAX + 1 };

static uint32_t step = 9;
static uint64_t compared;

static int same(float a, float b) {
    return as_uint(a) == as_uint(b) || (isnan(a) && isnan(b));
}

static void check_quotient(float a, float b) {
    const float found = divide(a, b), right = a / b;
    ++compared;
    if (!same(found, right))
        fail_msg("%a / %a is %a, not %a, where the device is off by %d", (double)a, (double)b, (double)right,
                 (double)found, quotient_error);
}

static void check_root(float x) {
    const float found = square_root(x), right = sqrtf(x);
    ++compared;
    if (!same(found, right))
        fail_msg("the root of %a is %a, not %a, where the device is off by %d and %d", (double)x,
                 (double)right, (double)found, root_error, quotient_error);
}

static void all_roots(void **state) {
    (void)state;
    compared = 0;
    for (root_error = -ERROR_MAX; root_error <= ERROR_MAX; ++root_error)
        for (uint32_t bits = 0x3f800000u; bits < 0x40800000u; ++bits) {
            quotient_error = (int)((bits + (uint32_t)(root_error + ERROR_MAX)) % ERRORS) - ERROR_MAX;
            check_root(as_float(bits));
        }
    printf("%llu roots of [1, 4)\n", (unsigned long long)compared);
    /* Every exponent, subnormal numbers too, and what has no root. */
    BpRandom random = {3};
    for (uint32_t i = 0; i < 2000000; ++i) {
        const uint64_t word = bp_random_bits(&random);
        root_error = (int)(word % ERRORS) - ERROR_MAX;
        quotient_error = (int)(word / ERRORS % ERRORS) - ERROR_MAX;
        check_root(as_float((uint32_t)(word >> 32) & (i % 8 == 0 ? 0x807fffffu : 0xffffffffu)));
    }
    static const float special[] = {0.0f,     -0.0f,   INFINITY, -INFINITY, NAN,   FLT_MAX,
                                    -FLT_MAX, FLT_MIN, -FLT_MIN, 0x1p-149f, -1.0f, 0x1.fffffep-97f};
    for (size_t i = 0; i < sizeof special / sizeof special[0]; ++i) check_root(special[i]);
}

/* The inverse of an odd number modulo 2^32, by Newton's method. */
static uint32_t inverse_modulo(uint32_t odd) {
    uint32_t x = odd;
    for (int i = 0; i < 5; ++i) x *= 2u - odd * x;
    return x;
}

/* The dividends `a` of 24 bits for which a 2^shift = middle * divisor + rest, `middle` odd and of 25 bits:
 * the quotient then lies rest / divisor halves of a unit beyond the middle between two floats. */
static void hard_quotients(uint32_t divisor, int shift, int64_t times) {
    const int zeros = __builtin_ctz(divisor), bits = shift - zeros;
    const uint32_t odd = divisor >> zeros;
    const int64_t rest = times * (1 << zeros);
    const uint64_t period = (uint64_t)1 << bits;
    uint64_t middle = (uint64_t)(uint32_t)(-times) * inverse_modulo(odd) & (period - 1);
    middle += ((1u << 24) - middle + period - 1) / period * period * (middle < (1u << 24));
    for (int i = 0; i < 4 && middle < (1u << 25); ++i, middle += period) {
        const int64_t scaled = (int64_t)(middle * divisor) + rest;
        const uint64_t dividend = (uint64_t)scaled >> shift;
        if ((middle & 1u) == 0 || dividend < (1u << 23) || dividend >= (1u << 24)) continue;
        assert_int_equal(dividend << shift, scaled);
        quotient_error = (int)((dividend ^ divisor) % ERRORS) - ERROR_MAX;
        check_quotient((float)dividend, (float)divisor);
    }
}

static void hardest_quotients(void **state) {
    (void)state;
    compared = 0;
    for (uint32_t divisor = 1u << 23; divisor < 1u << 24; divisor += step)
        for (int64_t times = -3; times <= 3; times += 2)
            for (int shift = 24; shift <= 25; ++shift) hard_quotients(divisor, shift, times);
    printf("%llu quotients beside a middle\n", (unsigned long long)compared);
    assert_true(compared > (4u << 23) / step);
    /* Inverses, which everything else rests on, by all errors; and the divisors whose inverse is the hardest.
     */
    for (quotient_error = -ERROR_MAX; quotient_error <= ERROR_MAX; ++quotient_error)
        for (uint32_t divisor = 1u << 23; divisor < 1u << 24; divisor += step)
            check_quotient(1.0f, (float)divisor);
    static const uint32_t edges[] = {0xffffffu, 0xfffffeu, 0x800000u, 0x800001u};
    for (size_t e = 0; e < 4; ++e)
        for (uint32_t dividend = 1u << 23; dividend < 1u << 24; dividend += step) {
            quotient_error = (int)(dividend / step % ERRORS) - ERROR_MAX;
            check_quotient((float)dividend, (float)edges[e]);
        }
}

/* All exponents, with what is subnormal, overflows or is no number. */
static void quotients_of_all_sizes(void **state) {
    (void)state;
    static const uint32_t mantissas[] = {0, 1, 0x2aaaaau, 0x400000u, 0x400001u, 0x7ffffeu, 0x7fffffu};
    enum { MANTISSAS = sizeof mantissas / sizeof mantissas[0] };
    quotient_error = 2;
    for (uint32_t a = 0; a < 512; ++a)
        for (uint32_t b = 0; b < 512; ++b)
            for (uint32_t m = 0; m < MANTISSAS; ++m)
                check_quotient(as_float(a << 23 | mantissas[m]),
                               as_float(b << 23 | mantissas[(m + a) % MANTISSAS]));
    BpRandom random = {1};
    for (uint32_t i = 0; i < 20000000 / step; ++i) {
        const uint64_t word = bp_random_bits(&random);
        const uint32_t low = (uint32_t)word, high = (uint32_t)(word >> 32);
        quotient_error = (int)(word % ERRORS) - ERROR_MAX;
        check_quotient(as_float(low), as_float(high));
        /* A quotient just above or below the least normal number. */
        const uint32_t divisor = (high & 0x807fffffu) | (100u + (high >> 24 & 31u)) << 23;
        const uint32_t dividend = (low & 0x807fffffu) | ((divisor >> 23 & 255u) - (low >> 26 & 31u) % 32u)
                                                            << 23;
        check_quotient(as_float(dividend) * 0x1p-100f, as_float(divisor));
    }
}

int main(int argc, char **argv) {
    if (argc > 1) step = (uint32_t)atoi(argv[1]);
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_roots), cmocka_unit_test(hardest_quotients),
                                       cmocka_unit_test(quotients_of_all_sizes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
