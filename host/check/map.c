/* map.c: the picture of a check; see check.h. */
#include "check.h"

#include "base/status.h"
#include "image/image.h"
#include "image/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { PANELS = 3, GAP = 8, PANEL_WIDTH = 256, LEGEND_HEIGHT = 42 };

static const uint8_t paper[3] = {22, 22, 26}, ink[3] = {225, 225, 225};

/* The colour of a difference of `z` standard errors, each channel 0 to 1. */
static void z_color(double z, double rgb[3]) {
    const double strength = fmin(fabs(z) / BP_CHECK_MAP_MOST, 1);
    rgb[0] = z > 0 ? 1 : 1 - strength;
    rgb[1] = 1 - strength;
    rgb[2] = z > 0 ? 1 - strength : 1;
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
    double encoded[3];
    z_color(bp_verdict_pixel_z(kernel, reference), encoded);
    for (int c = 0; c < 3; ++c) rgb[c] = (float)bp_transfer_inverse(encoded[c], transfer);
}

static void center_text(BpCanvas *canvas, uint32_t left, uint32_t width, uint32_t y, const char *text) {
    const uint32_t length = bp_text_width(text, 1);
    bp_canvas_text(canvas, left + (width > length ? (width - length) / 2 : 0), y, 1, text, ink);
}

/* Labels each panel, and draws the colour scale below the third. */
static void draw_legend(BpCanvas *canvas, uint32_t panel) {
    const uint32_t last = 2 * (panel + GAP), bar = panel > 2 * GAP ? panel - 2 * GAP : 1;
    bp_canvas_fill(canvas, 0, 0, canvas->width, canvas->height, paper);
    center_text(canvas, 0, panel, 6, "kernel");
    center_text(canvas, panel + GAP, panel, 6, "reference");
    center_text(canvas, last, panel, 6, "difference");
    for (uint32_t x = 0; x < bar; ++x) {
        double encoded[3];
        uint8_t bytes[3];
        z_color(BP_CHECK_MAP_MOST * (2 * (x + 0.5) / bar - 1), encoded);
        for (int c = 0; c < 3; ++c) bytes[c] = (uint8_t)(255 * encoded[c] + 0.5);
        bp_canvas_fill(canvas, last + GAP + x, 18, 1, 8, bytes);
    }
    char most[16], least[16];
    snprintf(least, sizeof least, "<-%d", BP_CHECK_MAP_MOST);
    snprintf(most, sizeof most, ">+%d", BP_CHECK_MAP_MOST);
    bp_canvas_text(canvas, last + GAP, 30, 1, least, ink);
    bp_canvas_text(canvas, last + panel - GAP - bp_text_width(most, 1), 30, 1, most, ink);
    center_text(canvas, last, panel, 30, panel > 200 ? "standard errors" : "errors");
}

BpStatus bp_check_map(const BpCheckResult *result, BpTransfer transfer, BpPicture *picture, BpError *err) {
    const uint32_t width = result->kernel.width, height = result->kernel.height;
    const uint32_t zoom = width < PANEL_WIDTH ? PANEL_WIDTH / width : 1;
    *picture = (BpPicture){.width = PANELS * width * zoom + (PANELS - 1) * GAP,
                           .height = height * zoom + LEGEND_HEIGHT};
    BpCanvas legend = {.width = picture->width, .height = LEGEND_HEIGHT};
    const size_t pixels = (size_t)picture->width * picture->height;
    picture->rgb = malloc(pixels * 3 * sizeof *picture->rgb);
    picture->error = malloc(pixels * 3 * sizeof *picture->error);
    picture->samples = calloc(pixels, sizeof *picture->samples);
    legend.rgb = malloc((size_t)legend.width * legend.height * 3);
    if (picture->rgb == NULL || picture->error == NULL || picture->samples == NULL || legend.rgb == NULL) {
        free(legend.rgb);
        bp_picture_clear(picture);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a map of %u x %u pixels", picture->width,
                       picture->height);
    }
    for (size_t i = 0; i < pixels * 3; ++i) {
        picture->rgb[i] = (float)bp_transfer_inverse(0.5, transfer); /* the gaps */
        picture->error[i] = NAN;
    }
    for (int panel = 0; panel < PANELS; ++panel) {
        const uint32_t left = (uint32_t)panel * (width * zoom + GAP);
        for (uint32_t y = 0; y < height * zoom; ++y)
            for (uint32_t x = 0; x < width * zoom; ++x)
                panel_color(result, panel, (size_t)(y / zoom) * width + x / zoom, transfer,
                            &picture->rgb[((size_t)y * picture->width + left + x) * 3]);
    }
    draw_legend(&legend, width * zoom);
    bp_canvas_copy(&legend, NULL, picture, height * zoom, transfer);
    free(legend.rgb);
    return BP_OK;
}
