/* divide.cl: quotients and square roots, rounded as the exact ones are (IEEE 754), whatever the device does.
 *
 * In:    numbers, one a lane; OWN_ROUNDING, which the program's first lines define (host/opencl/program.c).
 * Out:   divide(a, b) and square_root(x), and the same for refined numbers; loose_divide(a, b), rounded as the device likes,
 *        for tests whose margins cover that.
 * Knows: lanes.cl.   Does not know: what is divided. Read once for each number of lanes.
 *
 * OpenCL rounds quotients and roots in double correctly, and those of floats if the device offers that. A device that
 * does not may be off by 2.5 and 3 units in the last place (4 in the embedded profile), although many are correct.
 * With OWN_ROUNDING, each result of the device is checked, and a wrong one is computed anew, both by fma (P. Markstein,
 * "Computation of elementary functions on the IBM RISC System/6000 processor", 1990). OpenCL rounds fma correctly
 * everywhere, if slowly without hardware for it. All floats are covered, subnormal ones too, unless the device takes those
 * for 0. */
#if !OWN_ROUNDING || REAL_IS_DOUBLE
#define divide(a, b) ((a) / (b))
#define square_root(x) sqrt(x)
#define loose_divide(a, b) ((a) / (b))
#else
#define loose_divide(a, b) DEVICE_QUOTIENT(a, b)
#define divide LANED(divide)
#define square_root LANED(square_root)
#define correct_quotient LANED(correct_quotient)
#define correct_root LANED(correct_root)
#define root_above LANED(root_above)
#define root_below LANED(root_below)
#ifndef DEVICE_QUOTIENT /* a test has worse ones */
#define DEVICE_QUOTIENT(a, b) ((a) / (b))
#define DEVICE_ROOT(x) sqrt(x)
#endif

#if LANE_COUNT == 1
/* The bits of a magnitude that is not 0 as a whole number of 24 bits, and the biased exponent that belongs to it. */
static uint split_magnitude(uint magnitude, int *exponent) {
    const int below = (int)clz(magnitude) - 8;
    *exponent = (int)(magnitude >> 23);
    if (*exponent != 0) return (magnitude & 0x007fffffu) | 0x00800000u;
    *exponent = 1 - below;
    return magnitude << below;
}

/* By whole numbers: for what is subnormal or overflows, and for what the device knows best, 0, infinities and NaN. */
static float divide_wholes(float a, float b) {
    const uint above = as_uint(a) & 0x7fffffffu, below = as_uint(b) & 0x7fffffffu;
    if (above == 0u || below == 0u || above >= 0x7f800000u || below >= 0x7f800000u) return a / b;
    int a_exponent, b_exponent;
    const ulong dividend = (ulong)split_magnitude(above, &a_exponent) << 26;
    const ulong divisor = split_magnitude(below, &b_exponent);
    /* Two bits and more beyond those that stay, and the last one tells whether anything is left. */
    const uint quotient = (uint)(dividend / divisor) << 1 | (uint)(dividend % divisor != 0);
    const int top = 31 - (int)clz(quotient); /* 26 or 27 */
    int exponent = a_exponent - b_exponent + top + 100, dropped = top - 23;
    if (exponent < 1) {
        dropped = min(dropped + 1 - exponent, 30);
        exponent = 1;
    }
    const uint rest = quotient & ((1u << dropped) - 1u), middle = 1u << (dropped - 1);
    uint mantissa = quotient >> dropped;
    mantissa += rest > middle || (rest == middle && (mantissa & 1u) != 0u);
    const uint bits = exponent > 254 ? 0x7f800000u : ((uint)(exponent - 1) << 23) + mantissa;
    return as_float(bits | ((as_uint(a) ^ as_uint(b)) & 0x80000000u));
}
#endif

/* The quotient of the mantissas, in (1/2, 2), to which the exponents are added. From an inverse that is rounded
 * correctly, adding the remainder times the inverse to a quotient that is off by a unit at most ends at the neighbour to
 * which the exact quotient is rounded. Newton's method rounds all inverses correctly but that of the largest mantissa. */
static vreal correct_quotient(vreal a, vreal b) {
    const vuint a_bits = bits_of_real(a), b_bits = bits_of_real(b);
    const vreal x = real_of_bits((a_bits & 0x007fffffu) | 0x3f800000u);
    const vreal y = real_of_bits((b_bits & 0x007fffffu) | 0x3f800000u);
    vreal inverse = DEVICE_QUOTIENT(splat(1), y);
    inverse = fma(fma(-y, inverse, splat(1)), inverse, inverse);
    inverse = fma(fma(-y, inverse, splat(1)), inverse, inverse);
    inverse = choose(y == splat(0x1.fffffep0f), splat(0x1.000002p-1f), inverse);
    vreal q = x * inverse;
    q = fma(fma(-y, q, x), inverse, q);
    q = fma(fma(-y, q, x), inverse, q);
    const vuint a_exponent = (a_bits >> 23) & 255u, b_exponent = (b_bits >> 23) & 255u;
    const vuint scaled = bits_of_real(q) + ((a_exponent - b_exponent) << 23);
    const vuint exponent = (bits_of_real(q) >> 23) + a_exponent - b_exponent;
    const vbool usual = vbool_of_uint(a_exponent - 1u < splat_uint(254)) &
                        vbool_of_uint(b_exponent - 1u < splat_uint(254)) &
                        vbool_of_uint(exponent - 1u < splat_uint(254));
    q = real_of_bits(scaled | ((a_bits ^ b_bits) & 0x80000000u));
    if (!any_lane(vbool_not(usual))) return q;
    LaneReals dividends, divisors;
    dividends.all = a;
    divisors.all = b;
    for (uint lane = 0; lane < LANE_COUNT; ++lane)
        dividends.of[lane] = divide_wholes(dividends.of[lane], divisors.of[lane]);
    return choose(usual, q, dividends.all);
}

/* A quotient is right if the remainder is less than the divisor times half a unit in the last place. Both are rounded alike,
 * so rounding cannot make it less. Below a power of two half a unit is half as much, but no quotient of floats comes that
 * close to one from below. (Of a quotient that is 0, or nearly, the unit comes out negative here.) With infinities and NaN
 * no comparison holds. */
static vreal divide(vreal a, vreal b) {
    const vreal q = DEVICE_QUOTIENT(a, b);
    const vreal half_unit = real_of_bits((bits_of_real(q) & 0x7f800000u) - (24u << 23));
    const vbool right = fabs(fma(-q, b, a)) < fabs(b) * half_unit;
    if (!any_lane(vbool_not(right))) return q;
    /* 0, infinity or NaN: of lanes that are not in use, often, and the device knows the quotient. */
    const vbool numbers = (fabs(a) <= splat(REAL_MAX)) & (fabs(b) <= splat(REAL_MAX));
    const vbool special = vbool_not(numbers & (a != splat(0)) & (b != splat(0)));
    const vreal found = choose(special, a / b, q);
    const vbool wrong = vbool_not(right | special);
    return any_lane(wrong) ? choose(wrong, correct_quotient(a, b), found) : found;
}

/* A float is the rounded root if the number lies between its products with its neighbours (Tuckerman's test; R. Agarwal et
 * al., "New scalar and vector elementary functions for the IBM System/370", 1986). */
static vreal root_above(vreal root) { return real_of_bits(bits_of_real(root) + 1u); }
static vreal root_below(vreal root) { return real_of_bits(bits_of_real(root) - 1u); }

/* One step of Newton's method is off by a unit at most. Small numbers are moved away from where remainders are subnormal. */
static vreal correct_root(vreal x) {
    const vbool tiny = x < splat(0x1p-96f);
    const vreal scaled = choose(tiny, x * splat(0x1p64f), x);
    vreal root = DEVICE_ROOT(scaled);
    root = fma(fma(-root, root, scaled), DEVICE_QUOTIENT(splat(0.5f), root), root);
    const vreal below = root_below(root), above = root_above(root);
    root = choose(fma(-above, root, scaled) > splat(0), above, choose(fma(-below, root, scaled) > splat(0), root, below));
    return choose(tiny, root * splat(0x1p-32f), root);
}

/* Numbers whose products underflow fail the test, as do 0, infinity, NaN and negative numbers, whose roots the device
 * knows. */
static vreal square_root(vreal x) {
    const vreal root = DEVICE_ROOT(x);
    const vbool small_enough = fma(-root_below(root), root, x) > splat(0);
    const vbool large_enough = fma(-root_above(root), root, x) < splat(0);
    const vbool right = small_enough & large_enough;
    if (!any_lane(vbool_not(right))) return root;
    const vbool special = vbool_not((x > splat(0)) & (x <= splat(REAL_MAX)));
    const vreal found = choose(special, sqrt(x), root);
    const vbool wrong = vbool_not(right | special);
    return any_lane(wrong) ? choose(wrong, correct_root(x), found) : found;
}
#endif

#if REFINE_IS_DOUBLE
#define divide_refined(a, b) ((a) / (b))
#define square_root_refined(x) sqrt(x)
#else
#define divide_refined(a, b) divide(a, b)
#define square_root_refined(x) square_root(x)
#endif
