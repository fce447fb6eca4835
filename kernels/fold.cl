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
#define BITS4 ulong4
#define as_bits4 as_ulong4
#define BITS_SIGN 0x8000000000000000ul
#define BITS_LIMIT 0x4260000000000000ul /* of 2^39 */
#else
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
        long4 sum = 0;
        uint count = 0;
        for (uint s = (k + replicates - first_sample % replicates) % replicates; s < samples_per_pixel;
             s += replicates) {
            const real4 sample = vload4(s, mine) * scales;
            /* As bits, what is NaN, infinite, negative or too large is a larger integer; but -0 is 0. */
            const BITS4 bits = as_bits4(sample);
            const BITS4 magnitude = bits == (BITS4)BITS_SIGN ? (BITS4)0 : bits;
            const uint valid =
                magnitude.x < BITS_LIMIT && magnitude.y < BITS_LIMIT && magnitude.z < BITS_LIMIT;
            const long4 fixed = convert_long4(rint(sample));
            twice_segments += (ulong)fixed.w;
            cut += (ulong)fixed.w & 1u;
            sum += valid ? fixed : (long4)0;
            count += valid;
            invalid += 1u - valid;
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
