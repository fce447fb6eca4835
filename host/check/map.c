/* map.c: the picture of a check; see check.h. */
#include "check.h"

#include "base/color.h"
#include "base/status.h"

#include <math.h>
#include <stdlib.h>

enum { PANELS = 3, GAP = 8, PANEL_WIDTH = 256 };

/* Linear radiance that `transfer` encodes as `value` in [0, 1]. */
static float decode(double value, BpTransfer transfer) {
    switch (transfer) {
    case BP_TRANSFER_LINEAR:
        return (float)value;
    case BP_TRANSFER_GAMMA2:
        return (float)(value * value);
    case BP_TRANSFER_SRGB:
        return (float)bp_linear_from_srgb(value);
    }
    return (float)value;
}

static void panel_color(const BpCheckResult *result, int panel, size_t pixel, BpTransfer transfer,
                        float rgb[3]) {
    const BpPixelSums *kernel = &result->kernel.pixels[pixel], *reference = &result->reference.pixels[pixel];
    if (panel < 2) {
        const BpPixelSums *shown = panel == 0 ? kernel : reference;
        for (int c = 0; c < 3; ++c)
            rgb[c] = shown->count > 0 ? (float)(shown->sum[c] / (double)shown->count) : 0;
        return;
    }
    const double z = bp_verdict_pixel_z(kernel, reference), strength = fmin(fabs(z) / 4, 1);
    rgb[0] = decode(z > 0 ? 1 : 1 - strength, transfer);
    rgb[1] = decode(1 - strength, transfer);
    rgb[2] = decode(z > 0 ? 1 - strength : 1, transfer);
}

BpStatus bp_check_map(const BpCheckResult *result, BpTransfer transfer, BpPicture *picture, BpError *err) {
    const uint32_t width = result->kernel.width, height = result->kernel.height;
    const uint32_t zoom = width < PANEL_WIDTH ? PANEL_WIDTH / width : 1;
    *picture = (BpPicture){.width = PANELS * width * zoom + (PANELS - 1) * GAP, .height = height * zoom};
    const size_t pixels = (size_t)picture->width * picture->height;
    picture->rgb = malloc(pixels * 3 * sizeof *picture->rgb);
    picture->error = malloc(pixels * 3 * sizeof *picture->error);
    picture->samples = calloc(pixels, sizeof *picture->samples);
    if (picture->rgb == NULL || picture->error == NULL || picture->samples == NULL) {
        bp_picture_clear(picture);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a map of %u x %u pixels", picture->width,
                       picture->height);
    }
    for (size_t i = 0; i < pixels * 3; ++i) {
        picture->rgb[i] = decode(0.5, transfer); /* the gaps */
        picture->error[i] = NAN;
    }
    for (int panel = 0; panel < PANELS; ++panel) {
        const uint32_t left = (uint32_t)panel * (width * zoom + GAP);
        for (uint32_t y = 0; y < height * zoom; ++y)
            for (uint32_t x = 0; x < width * zoom; ++x)
                panel_color(result, panel, (size_t)(y / zoom) * width + x / zoom, transfer,
                            &picture->rgb[((size_t)y * picture->width + left + x) * 3]);
    }
    return BP_OK;
}
