/* exponential.cl: the exponential function and its inverse, as light that flies through a medium needs them.
 *
 * In:    lengths in mean free paths, uniform numbers.   Out: what is left of light; lengths that have that distribution.
 * Knows: lanes.cl.   Does not know: media.
 *
 * Plain arithmetic, since a library's functions differ from device to device. */
#if EFFECT_MEDIA
#if REAL_IS_DOUBLE
#define EXPONENT_MAX R(700.0)
#define EXPONENT_BITS 10u
#define ATANH_TERMS 17
#else
#define EXPONENT_MAX R(80.0)
#define EXPONENT_BITS 7u
#define ATANH_TERMS 8
#endif
#define LN2_HIGH R(0.693145751953125) /* its products with whole numbers below 2^10 are exact */
#define LN2_LOW R(1.42860682030941723e-6)

/* exp(-x) for x >= 0, right to some units in the last place, and exactly 1 for 0. What is below 1e-34 counts as 0. */
static vreal exp_minus(vreal x) {
    const vbool gone = vbool_not(x <= splat(EXPONENT_MAX));
    const vreal y = choose(gone, splat(0), x);
    const vuint halvings = to_uint(fma(y, splat(R(1.4426950408889634)), splat(R(0.5))));
    const vreal n = uint_to_real(halvings);
    const vreal f = fma(n, splat(LN2_LOW), fma(n, splat(LN2_HIGH), -y)); /* |f| < 0.35 */
    /* Taylor's series. */
#if REAL_IS_DOUBLE
    vreal p = splat(1.6059043836821613e-10);
    p = fma(p, f, splat(2.08767569878681e-09));
    p = fma(p, f, splat(2.505210838544172e-08));
    p = fma(p, f, splat(2.755731922398589e-07));
    p = fma(p, f, splat(2.7557319223985893e-06));
    p = fma(p, f, splat(2.48015873015873e-05));
    p = fma(p, f, splat(1.984126984126984e-04));
#else
    vreal p = splat(1.9841270e-04f);
#endif
    p = fma(p, f, splat(R(1.388888888888889e-03)));
    p = fma(p, f, splat(R(8.333333333333333e-03)));
    p = fma(p, f, splat(R(4.1666666666666664e-02)));
    p = fma(p, f, splat(R(1.6666666666666666e-01)));
    p = fma(p, f, splat(R(0.5)));
    p = fma(p, f, splat(R(1.0)));
    p = fma(p, f, splat(R(1.0)));
    real factor = R(0.5);
    for (uint bit = 0; bit < EXPONENT_BITS; ++bit) {
        p = choose(vbool_of_uint((halvings >> bit & 1u) != splat_uint(0)), p * factor, p);
        factor = factor * factor;
    }
    return choose(gone, splat(0), p);
}

/* -log(1 - z) for z in [0, 1/2], as 2 atanh(z / (2 - z)). */
static vreal minus_log_1_minus(vreal z) {
    const vreal s = divide(z, splat(2) - z);
    const vreal square = s * s;
#if REAL_IS_DOUBLE
    vreal p = splat(1.0 / 37.0);
    p = fma(p, square, splat(1.0 / 35.0));
    p = fma(p, square, splat(1.0 / 33.0));
    p = fma(p, square, splat(1.0 / 31.0));
    p = fma(p, square, splat(1.0 / 29.0));
    p = fma(p, square, splat(1.0 / 27.0));
    p = fma(p, square, splat(1.0 / 25.0));
    p = fma(p, square, splat(1.0 / 23.0));
    p = fma(p, square, splat(1.0 / 21.0));
    p = fma(p, square, splat(1.0 / 19.0));
    p = fma(p, square, splat(1.0 / 17.0));
#else
    vreal p = splat(0.058823529f);
#endif
    p = fma(p, square, splat(R(0.06666666666666667)));
    p = fma(p, square, splat(R(0.07692307692307693)));
    p = fma(p, square, splat(R(0.09090909090909091)));
    p = fma(p, square, splat(R(0.1111111111111111)));
    p = fma(p, square, splat(R(0.14285714285714285)));
    p = fma(p, square, splat(R(0.2)));
    p = fma(p, square, splat(R(0.3333333333333333)));
    p = fma(p, square, splat(R(1.0)));
    return (s + s) * p;
}

/* A length with the density exp(-length), from the multiples of 2^-24 `u` and `refill` in [0, 1), which together are a
 * number of 48 bits: it is fine near 0 for media so thin that hardly anything scatters, and near 1 for dense ones. */
static vreal exponential_length(vreal u, vreal refill) {
    const vbool lower = u < splat(R(0.5));
    const vreal z = fma(refill, splat(R(0x1p-24)), u);
    /* What is left to 1: 2^-48 at least. */
    vreal left = fma(refill, splat(R(-0x1p-24)), splat(1) - u);
    vreal halvings = splat(0);
    real factor = R(0x1p32), count = 32;
    for (uint step = 0; step < 6u; ++step) {
        const vbool small = left * factor < splat(1);
        left = choose(small, left * factor, left);
        halvings = choose(small, halvings + count, halvings);
        count = count * R(0.5);
        factor = step == 0u ? R(0x1p16) : step == 1u ? R(0x1p8) : step == 2u ? R(0x1p4) : step == 3u ? R(0x1p2) : R(0x1p1);
    }
    const vreal upper = fma(halvings, splat(LN2_HIGH), fma(halvings, splat(LN2_LOW), minus_log_1_minus(splat(1) - left)));
    return choose(lower, minus_log_1_minus(choose(lower, z, splat(0))), upper);
}
#endif
