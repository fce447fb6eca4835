/* fused.cl: a * b + c, rounded once, on processors that have no instruction for it.
 *
 * Out:   fma, which from here on is this file's where the processor is of that kind and its compiler is clang; loose_fma,
 *        for tests whose margins cover two roundings.
 * Knows: real.cl.   Does not know: what is computed.
 *
 * Processors with SSE alone have no fused multiply-add, so compilers call the C library for each lane, which takes a hundred cycles. Both
 * precisions are therefore put together from sums and products here (S. Boldo and G. Melquiond, "Emulation of a FMA and correctly
 * rounded sums: proved algorithms using rounding to odd", 2008). A sum is rounded to odd if, when it is inexact, the
 * one of its two neighbours with an odd last bit is taken; rounding that again, to fewer bits, gives what rounding the exact sum
 * gives. Two lanes are computed at a time, as many doubles as a register has: intermediate results of more would not stay in
 * registers. */
#if defined(__clang__) && defined(__SSE2__) && !defined(__FMA__) && !defined(__FMA4__) && defined(cl_khr_fp64)
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#define OVERLOADED __attribute__((overloadable))

/* What is missing from the sum x + y, exactly (D. Knuth, "The Art of Computer Programming", vol. 2, 4.2.2). */
FORCE_INLINE static double2 rest_of_sum(double2 x, double2 y, double2 sum) {
    const double2 of_y = sum - x;
    return (x - (sum - of_y)) + (y - of_y);
}

/* x + y, rounded to odd. Of what is infinite or not a number, the rest is not a number: neither above nor below 0. */
FORCE_INLINE static double2 sum_to_odd(double2 x, double2 y) {
    const double2 sum = x + y, rest = rest_of_sum(x, y, sum);
    const long2 bits = as_long2(sum), inexact = (rest < 0.0) | (rest > 0.0);
    /* 1 where the exact sum is farther from 0, -1 where it is nearer */
    const long2 outward = ((as_long2(rest) ^ bits) >> 63) | 1;
    return as_double2(bits + (inexact & outward & -(~bits & 1)));
}

/* In double, a product of floats is exact. */
FORCE_INLINE static float2 OVERLOADED fused(float2 a, float2 b, float2 c) {
    const double2 product = __builtin_convertvector(a, double2) * __builtin_convertvector(b, double2);
    return __builtin_convertvector(sum_to_odd(product, __builtin_convertvector(c, double2)), float2);
}

/* The upper half of the bits of x; x less that is exact (T. Dekker, "A floating-point technique for extending the available
 * precision", 1971). */
FORCE_INLINE static double2 upper_half(double2 x) {
    const double2 scaled = 0x8000001p0 * x;
    return scaled - (scaled - x);
}

FORCE_INLINE static double2 OVERLOADED fused(double2 a, double2 b, double2 c) {
    /* Neither does a product overflow, nor is anything of it too small for a double. */
    const long2 usual = ((fabs(a) > 0x1p-480) | (a == 0.0)) & ((fabs(b) > 0x1p-480) | (b == 0.0)) & (fabs(a) < 0x1p480) &
                        (fabs(b) < 0x1p480) & (fabs(c) < 0x1p960);
    if ((usual.x & usual.y) == 0) return (double2)(fma(a.x, b.x, c.x), fma(a.y, b.y, c.y));
    const double2 product = a * b, a_upper = upper_half(a), b_upper = upper_half(b);
    const double2 a_lower = a - a_upper, b_lower = b - b_upper;
    const double2 rest = ((a_upper * b_upper - product) + a_upper * b_lower + a_lower * b_upper) + a_lower * b_lower;
    const double2 small = c + rest, large = product + small;
    const double2 sum = large + sum_to_odd(rest_of_sum(product, small, large), rest_of_sum(c, rest, small));
    /* The sign of 0 is that of adding the product. */
    const long2 none = sum == 0.0;
    return as_double2((as_long2(product + c) & none) | (as_long2(sum) & ~none));
}

#define FUSED_BY_HALVES(type)                                                                                               \
    FORCE_INLINE static type OVERLOADED fused(type a, type b, type c) {                                                     \
        return (type)(fused(a.lo, b.lo, c.lo), fused(a.hi, b.hi, c.hi));                                                    \
    }
FUSED_BY_HALVES(float4)
FUSED_BY_HALVES(float8)
FUSED_BY_HALVES(float16)
FUSED_BY_HALVES(double4)
FUSED_BY_HALVES(double8)
FUSED_BY_HALVES(double16)
#undef FUSED_BY_HALVES
FORCE_INLINE static float OVERLOADED fused(float a, float b, float c) { return fused((float2)a, (float2)b, (float2)c).x; }
FORCE_INLINE static double OVERLOADED fused(double a, double b, double c) {
    return fused((double2)a, (double2)b, (double2)c).x;
}
#undef fma /* a macro of PoCL's header */
#define fma fused
/* a * b + c, rounded twice, which costs a twentieth here. No picture may depend on the result. */
#define loose_fma(a, b, c) ((a) * (b) + (c))
#else
#define loose_fma fma
#endif
