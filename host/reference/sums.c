/* sums.c: see sums.h. */
#include "sums.h"

#include "base/status.h"

#include <math.h>
#include <stdlib.h>

BpStatus bp_sums_init(BpSums *sums, uint32_t width, uint32_t height, BpError *err) {
    sums->width = width;
    sums->height = height;
    sums->means_only = false;
    sums->pixels = calloc((size_t)width * height, sizeof *sums->pixels);
    if (sums->pixels == NULL)
        return bp_fail_with(BP_REMEDY_SMALLER_WIDTH, err, BP_ERR_MEMORY,
                            "no memory for the sums of %u x %u pixels", width, height);
    return BP_OK;
}

void bp_sums_clear(BpSums *sums) {
    free(sums->pixels);
    *sums = (BpSums){0};
}

void bp_pixel_sums_add(BpPixelSums *pixel, const double radiance[3], uint64_t segments) {
    for (int c = 0; c < 3; ++c) {
        if (!isfinite(radiance[c]) || radiance[c] < 0) {
            ++pixel->invalid;
            return;
        }
    }
    ++pixel->count;
    pixel->segments += segments;
    /* Rec. 709 weights */
    const double luminance = 0.2126 * radiance[0] + 0.7152 * radiance[1] + 0.0722 * radiance[2];
    for (int c = 0; c < BP_SUMS_CHANNELS; ++c) {
        const double x = c < 3 ? radiance[c] : luminance, x2 = x * x;
        pixel->lit[c] += x > BP_SUMS_LIT;
        pixel->sum[c] += x;
        pixel->sum2[c] += x2;
        pixel->sum4[c] += x2 * x2;
    }
}
