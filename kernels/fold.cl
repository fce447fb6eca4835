/* fold.cl: adds the samples of a chunk to the replicate sums of their pixels, in 64-bit fixed point.
 *
 * In:    samples as trace.cl leaves them.
 * Out:   sums[(pixel * K + k) * 3 + channel], counts[pixel * K + k], tallies[pixel * 3 + ...]: ray segments, paths
 *        cut by the depth cap, invalid samples.
 *
 * Sums of integers do not depend on their order: chunks, merged runs and several devices agree to the bit. A sample
 * that is NaN, infinite, negative or larger than any path can bring (2^39 in fixed point) is left out and counted;
 * it is found by its bits, since a compiler may assume that NaN does not exist. */
#if REAL_IS_DOUBLE
#define REALS_WHOLE 0x1p52 /* from here on all numbers are whole */
#define BITS4 ulong4
#define as_bits4 as_ulong4
#define BITS_SIGN 0x8000000000000000ul
#define BITS_LIMIT 0x4260000000000000ul /* of 2^39 */
#else
#define REALS_WHOLE 0x1p23f
#define BITS4 uint4
#define as_bits4 as_uint4
#define BITS_SIGN 0x80000000u
#define BITS_LIMIT 0x53000000u
#endif

/* 2^exponent, -126 to 126, by its bits: ldexp is a slow call on some devices. */
static real power_of_two(int exponent) {
#if REAL_IS_DOUBLE
    return as_double((ulong)(exponent + 1023) << 52);
#else
    return as_float((uint)(exponent + 127) << 23);
#endif
}

/* rint() of what is not negative, NaN or infinite; some drivers spell it out in a dozen steps. */
static real4 nearest_whole(real4 x) {
#ifdef __FAST_RELAXED_MATH__
    return rint(x); /* the sum below may be taken for x */
#else
    return x < (real4)REALS_WHOLE ? (x + (real4)REALS_WHOLE) - (real4)REALS_WHOLE : x;
#endif
}

/* A sample in fixed point; the fourth number, which has a scale of its own, along with it. */
static long4 fixed_point(real4 scaled) { return convert_long4(nearest_whole(scaled)); }

/* As bits, what is NaN, infinite, negative or too large is a larger integer than any valid number; but -0 is 0. */
static BITS4 order_of(real4 scaled) {
    const BITS4 bits = as_bits4(scaled);
    return bits == (BITS4)BITS_SIGN ? (BITS4)0 : bits;
}

static int is_valid(BITS4 order) { return order.x < BITS_LIMIT && order.y < BITS_LIMIT && order.z < BITS_LIMIT; }

/* One work-item a pixel of the chunk. */
__kernel void fold(__global const real *samples, uint pixel_count, uint samples_per_pixel, uint first_pixel,
                   uint first_sample, uint replicates, int scale_log2, __global long *sums, __global uint *counts,
                   __global ulong *tallies PIXEL_LIST_PARAMETER) {
    const uint item = get_global_id(0);
    if (item >= pixel_count) return;
    const real scale = power_of_two(scale_log2);
#if PIXEL_LIST
    const size_t pixel = pixel_list[first_pixel + item];
#else
    const size_t pixel = first_pixel + item;
#endif
    __global const real *mine = samples + (size_t)item * samples_per_pixel * 4;
    const real4 scales = (real4)(scale, scale, scale, 2); /* the fourth number: twice the segments, plus 1 for a cut */
    ulong twice_segments = 0, cut = 0, invalid = 0;
    for (uint k = 0; k < replicates; ++k) {
        const uint begin = (k + replicates - first_sample % replicates) % replicates;
        long4 sum = 0, odd = 0;
        BITS4 largest = 0;
        uint count = 0;
        for (uint s = begin; s < samples_per_pixel; s += replicates) {
            const real4 scaled = vload4(s, mine) * scales;
            const long4 fixed = fixed_point(scaled);
            largest = max(largest, order_of(scaled));
            sum += fixed;
            odd += fixed & 1;
            ++count;
        }
        twice_segments += (ulong)sum.w;
        cut += (ulong)odd.w;
        if (!is_valid(largest)) { /* hardly ever: once more, without those */
            sum = 0;
            invalid += count;
            count = 0;
            for (uint s = begin; s < samples_per_pixel; s += replicates) {
                const real4 scaled = vload4(s, mine) * scales;
                if (!is_valid(order_of(scaled))) continue;
                sum += fixed_point(scaled);
                ++count;
            }
            invalid -= count;
        }
        __global long *total = sums + (pixel * replicates + k) * 3;
        total[0] += sum.x;
        total[1] += sum.y;
        total[2] += sum.z;
        counts[pixel * replicates + k] += count;
    }
    tallies[pixel * 3] += (twice_segments - cut) / 2;
    tallies[pixel * 3 + 1] += cut;
    tallies[pixel * 3 + 2] += invalid;
}
