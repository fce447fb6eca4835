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
#define BITS ulong
#define as_bits as_ulong
#define BITS_SIGN 0x8000000000000000ul
#define BITS_INFINITE 0x7ff0000000000000ul
#else
#define BITS uint
#define as_bits as_uint
#define BITS_SIGN 0x80000000u
#define BITS_INFINITE 0x7f800000u
#endif

/* 2^exponent, -126 to 126, by its bits: ldexp is a slow call on some devices. */
static real power_of_two(int exponent) {
#if REAL_IS_DOUBLE
    return as_double((ulong)(exponent + 1023) << 52);
#else
    return as_float((uint)(exponent + 127) << 23);
#endif
}

static int is_valid(real x, real scale) {
    const BITS bits = as_bits(x);
    if ((bits & BITS_INFINITE) == BITS_INFINITE) return 0;
    if ((bits & BITS_SIGN) != 0 && bits != BITS_SIGN) return 0;
    return x * scale < R(0x1p39);
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
    ulong segments = 0, cut = 0, invalid = 0;
    for (uint k = 0; k < replicates; ++k) {
        long red = 0, green = 0, blue = 0;
        uint count = 0;
        for (uint s = (k + replicates - first_sample % replicates) % replicates; s < samples_per_pixel;
             s += replicates) {
            __global const real *sample = mine + (size_t)s * 4;
            const real r = sample[0], g = sample[1], b = sample[2], path = sample[3];
            segments += (ulong)path;
            cut += path != floor(path);
            if (is_valid(r, scale) && is_valid(g, scale) && is_valid(b, scale)) {
                red += convert_long_rte(r * scale);
                green += convert_long_rte(g * scale);
                blue += convert_long_rte(b * scale);
                ++count;
            } else {
                ++invalid;
            }
        }
        __global long *sum = sums + (pixel * replicates + k) * 3;
        sum[0] += red;
        sum[1] += green;
        sum[2] += blue;
        counts[pixel * replicates + k] += count;
    }
    tallies[pixel * 3] += segments;
    tallies[pixel * 3 + 1] += cut;
    tallies[pixel * 3 + 2] += invalid;
}
