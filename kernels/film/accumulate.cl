/* accumulate.cl: adds the samples of a chunk to the replicate sums of their pixels, in 64-bit fixed point.
 *
 * In:    samples as pixels.cl describes them, and the numbers of rays to lamps, of all work-items that traced them.
 * Out:   sums and fine_sums[(pixel * K + k) * 3 + channel], counts[pixel * K + k] with their flags,
 *        tallies[pixel * TALLIES + TALLY_...].
 * Knows: fixed point, replicates.   Does not know: what a sample shows, how the picture is estimated (film/film_estimate.c).
 *
 * Sums of integers do not depend on their order: chunks, merged runs and several devices agree to the bit. A sample
 * that is NaN, infinite, negative or larger than any path can bring (2^39 in fixed point) is left out and counted
 * by its cause; it is found by its bits, since a compiler may assume that NaN does not exist. */
#if REAL_IS_DOUBLE
#define BITS ulong
#define BITS4 ulong4
#define as_bits4 as_ulong4
#define BITS_SIGN 0x8000000000000000ul
#define BITS_INFINITY 0x7ff0000000000000ul
#define BITS_LIMIT 0x4260000000000000ul /* of 2^39 */
#define BITS_SPLIT 0x4140000000000000ul  /* of 2^21 */
#define BITS_COARSE 0x3ed0000000000000ul /* of 2^-18: 2^20 fine steps */
#define to_real4 convert_double4
#else
#define BITS uint
#define BITS4 uint4
#define as_bits4 as_uint4
#define BITS_SIGN 0x80000000u
#define BITS_INFINITY 0x7f800000u
#define BITS_LIMIT 0x53000000u
#define BITS_SPLIT 0x4a000000u
#define BITS_COARSE 0x36800000u
#define to_real4 convert_float4
#endif

/* 2^exponent, -126 to 126, by its bits: ldexp is a slow call on some devices. */
static real power_of_two(int exponent) {
#if REAL_IS_DOUBLE
    return as_double((ulong)(exponent + 1023) << 52);
#else
    return as_float((uint)(exponent + 127) << 23);
#endif
}

/* The whole steps in valid numbers. There is one instruction for this with AVX-512; elsewhere, drivers call a function, or
 * take the numbers one by one. */
static long4 whole_steps(real4 scaled) {
#ifdef __AVX512DQ__
    return convert_long4(scaled);
#else
    const int4 high = convert_int4(scaled * (real4)R(0x1p-16)), low = convert_int4(scaled - to_real4(high) * (real4)R(0x1p16));
    return (convert_long4(high) << (long4)16) + convert_long4(low);
#endif
}

/* As bits, what is NaN, infinite, negative or too large is a larger integer than any valid number; but -0 is 0. */
static BITS4 order_of(real4 scaled) {
    const BITS4 bits = as_bits4(scaled);
    return bits == (BITS4)BITS_SIGN ? (BITS4)0 : bits;
}

static int is_valid(BITS4 order) { return order.x < BITS_LIMIT && order.y < BITS_LIMIT && order.z < BITS_LIMIT; }

/* Whether a channel lies between 0 and a limit, exclusive: `least` is the minimum of the orders minus 1, so that 0 wraps around to the largest number. */
static int any_below(BITS4 least, BITS limit) { return least.x < limit || least.y < limit || least.z < limit; }

/* What the samples of one replicate of one pixel come to. */
typedef struct ReplicateSum {
    long4 sum, fine;
    uint count, coarse, missed;
    uint not_finite, negative, out_of_range; /* samples left out */
} ReplicateSum;

/* Counts a sample that is not valid by the first of these causes that one of its channels has. What is finite may be
 * infinite once it is scaled, so this looks at the sample as it was traced. */
static void count_cause(real4 sample, ReplicateSum *total) {
    const BITS4 bits = as_bits4(sample), size = bits & (BITS4)(BITS_SIGN - 1);
    if (size.x >= BITS_INFINITY || size.y >= BITS_INFINITY || size.z >= BITS_INFINITY)
        ++total->not_finite;
    else if (bits.x > BITS_SIGN || bits.y > BITS_SIGN || bits.z > BITS_SIGN)
        ++total->negative;
    else
        ++total->out_of_range;
}

/* The sum of the valid samples `begin`, `begin` + `stride`, ...: fractions of steps count in those samples of which a
 * channel is below 2^21 steps, the others are right to 2^-21 without. */
static ReplicateSum sum_split(__global const real *samples, uint begin, uint end, uint stride, real4 scales) {
    ReplicateSum total = {0, 0, 0, 0, 0, 0, 0, 0};
    for (uint s = begin; s < end; s += stride) {
        const real4 scaled = vload4(s, samples) * scales;
        const BITS4 order = order_of(scaled);
        if (!is_valid(order)) {
            count_cause(vload4(s, samples), &total);
            continue;
        }
        ++total.count;
        const long4 whole = whole_steps(scaled);
        total.sum += whole;
        total.missed += (uint)(whole.w >> (MISSED_BITS + 1)) & 1;
        if (!any_below(order - 1, BITS_SPLIT - 1)) continue;
        const real4 rest = (scaled - to_real4(whole)) * (real4)(1l << FINE_BITS);
        total.fine += whole_steps(rest);
        total.coarse |= any_below(order - 1, BITS_COARSE - 1);
    }
    return total;
}

/* Adds to the fine sums of a cell, which are undefined until its count has COUNT_HAS_FINE. */
static void add_fine(__global long *fine_sums, long4 fine, uint known) {
    const int begun = (known & COUNT_HAS_FINE) != 0;
    fine_sums[0] = (begun ? fine_sums[0] : 0) + fine.x;
    fine_sums[1] = (begun ? fine_sums[1] : 0) + fine.y;
    fine_sums[2] = (begun ? fine_sums[2] : 0) + fine.z;
}

/* The share that falls to pixel `pixel` of `pixel_count` when the work-items that traced are dealt out evenly: it need
 * not be of the pixel's own rays, since only the sum over the picture is asked for. */
static ulong share_of_lamp_rays(__global const uint *lamp_rays, uint item_count, uint pixel, uint pixel_count) {
    const uint each = (item_count + pixel_count - 1) / pixel_count;
    const ulong end = min((ulong)item_count, ((ulong)pixel + 1) * each);
    ulong sum = 0;
    for (ulong i = (ulong)pixel * each; i < end; ++i) sum += lamp_rays[i];
    return sum;
}

/* One work-item a pixel of the chunk. `item_count`: of lamp_rays; 0 in scenes without lamps. */
__kernel void accumulate(__global const real *samples, uint pixel_count, uint samples_per_pixel, uint first_pixel,
                   uint first_sample, uint replicates, int scale_log2, __global long *sums, __global long *fine_sums,
                   __global uint *counts, __global ulong *tallies, __global const uint *lamp_rays,
                   uint item_count PIXEL_LIST_PARAMETER) {
    const uint item = get_global_id(0);
    if (item >= pixel_count) return;
    const real scale = power_of_two(scale_log2);
#if PIXEL_LIST
    const size_t pixel = pixel_list[first_pixel + item];
#else
    const size_t pixel = first_pixel + item;
#endif
    __global const real *mine = samples + (size_t)item * samples_per_pixel * 4;
    /* The fourth number becomes twice the segments, plus 1 for a cut, with the mark of a path that missed everything. */
    const real4 scales = (real4)(scale, scale, scale, 2);
    ulong twice_segments = 0, cut = 0, missed = 0;
    __global ulong *tally = tallies + pixel * TALLIES;
    for (uint k = 0; k < replicates; ++k) {
        const uint begin = (k + replicates - first_sample % replicates) % replicates;
        long4 sum = 0;
        ulong2 flags = 0; /* how many were cut, how many missed everything */
        BITS4 largest = 0, least = ~(BITS4)0;
        uint count = 0;
        for (uint s = begin; s < samples_per_pixel; s += replicates) {
            const real4 scaled = vload4(s, mine) * scales;
            const long4 fixed = whole_steps(scaled);
            const BITS4 order = order_of(scaled);
            largest = max(largest, order);
            least = min(least, order - 1);
            sum += fixed;
            flags += as_ulong2(fixed.ww) >> (ulong2)(0, MISSED_BITS + 1) & 1;
            ++count;
        }
        twice_segments += (ulong)sum.w - (flags.y << (MISSED_BITS + 1));
        cut += flags.x;
        const size_t cell = pixel * replicates + k;
        uint known = counts[cell];
        if (!is_valid(largest) || any_below(least, BITS_SPLIT - 1)) { /* hardly ever: once more, with more care */
            const ReplicateSum careful = sum_split(mine, begin, samples_per_pixel, replicates, scales);
            if (careful.count < count) {
                tally[TALLY_NOT_FINITE] += careful.not_finite;
                tally[TALLY_NEGATIVE] += careful.negative;
                tally[TALLY_OUT_OF_RANGE] += careful.out_of_range;
            }
            count = careful.count;
            flags.y = careful.missed;
            sum = careful.sum;
            if ((careful.fine.x | careful.fine.y | careful.fine.z) != 0) {
                add_fine(fine_sums + cell * 3, careful.fine, known);
                known |= COUNT_HAS_FINE;
            }
            if (careful.coarse) known |= COUNT_COARSE;
        }
        __global long *total = sums + cell * 3;
        total[0] += sum.x;
        total[1] += sum.y;
        total[2] += sum.z;
        missed += flags.y;
        counts[cell] = known + count;
    }
    tally[TALLY_SEGMENTS] += (twice_segments - cut) / 2;
    tally[TALLY_CUT] += cut;
    tally[TALLY_MISSED] += missed;
    if (item_count > 0) tally[TALLY_LAMP_RAYS] += share_of_lamp_rays(lamp_rays, item_count, item, pixel_count);
}
