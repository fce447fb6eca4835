/* reader.c: see reader.h. */
#include "reader.h"

#include "base/color.h"
#include "base/input_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

BpStatus bp_image_fail(const BpImageInput *input, BpError *err, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const BpStatus status = bp_stream_fail(input->stream, input->path, 0, err, format, arguments);
    va_end(arguments);
    return status;
}

BpStatus bp_image_allocate(const BpImageInput *input, uint64_t width, uint64_t height, BpImage **image,
                           BpError *err) {
    if (width < 1 || height < 1 || width > BP_IMAGE_SIDE_MAX || height > BP_IMAGE_SIDE_MAX)
        return bp_image_fail(input, err,
                             "found an image of %" PRIu64 " by %" PRIu64 " texels, expected sides of 1 to %u",
                             width, height, BP_IMAGE_SIDE_MAX);
    if (width * height > input->texels_max)
        return bp_image_fail(input, err,
                             "found an image of %" PRIu64 " by %" PRIu64 " texels, expected at most %" PRIu64
                             " texels in all images of a scene, of which "
                             "%" PRIu64 " are left; use a smaller image",
                             width, height, BP_IMAGE_TEXELS_MAX, input->texels_max);
    return bp_texels_create((uint32_t)width, (uint32_t)height, image, err);
}

float *bp_light_of_numbers(int bits, double exponent) {
    const size_t count = (size_t)1 << bits;
    float *light = malloc(count * sizeof *light);
    for (size_t i = 0; light != NULL && i < count; i++) {
        const double share = (double)i / (double)(count - 1);
        light[i] = (float)(exponent == 0 ? bp_linear_from_srgb(share) : pow(share, exponent));
    }
    return light;
}
