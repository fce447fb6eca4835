/* sums.h: power sums of radiance samples, pixel by pixel; what two renderers are compared by.
 *
 * In:    samples, one at a time.   Out: counts and, for each pixel and channel, sums of x, x^2 and x^4.
 * Knows: arithmetic.               Does not know: scenes, who rendered, what is tested with them
 * (check/verdict.h).
 *
 * Plain double sums: after n additions of values >= 0 the relative error is below n * 1.1e-16, so 1e8 samples
 * of a pixel keep eight digits, and a comparison whose noise is 1 / sqrt(n) never sees it. */
#ifndef BP_REFERENCE_SUMS_H
#define BP_REFERENCE_SUMS_H

#include "ballpark.h"

enum { BP_SUMS_RED, BP_SUMS_GREEN, BP_SUMS_BLUE, BP_SUMS_LUMINANCE, BP_SUMS_CHANNELS };

/* A sample counts as lit above this; below lie the rounding errors of black. */
#define BP_SUMS_LIT 1e-7

typedef struct BpPixelSums {
    uint64_t count;    /* valid samples */
    uint64_t invalid;  /* samples left out: a channel was NaN, infinite or negative */
    uint64_t segments; /* ray segments of the valid samples */
    uint64_t lit[BP_SUMS_CHANNELS];
    double sum[BP_SUMS_CHANNELS], sum2[BP_SUMS_CHANNELS], sum4[BP_SUMS_CHANNELS];
} BpPixelSums;

typedef struct BpSums {
    uint32_t width, height;
    BpPixelSums *pixels; /* width * height, row 0 at the top */
    bool means_only;  /* samples are drawn so that their mean is the radiance, and their spread is not that of
                         paths that find lamps by chance; false: it is */
    double brightest; /* the most radiance that a sample may have which finds lamps by chance; 0: not known */
} BpSums;

/* Creates sums that are all zero. BP_ERR_MEMORY. Release with bp_sums_clear(). */
BpStatus bp_sums_init(BpSums *sums, uint32_t width, uint32_t height, BpError *err);
void bp_sums_clear(BpSums *sums);

/* Adds one sample, or counts it as invalid. */
void bp_pixel_sums_add(BpPixelSums *pixel, const double radiance[3], uint64_t segments);

#endif
