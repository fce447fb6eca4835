/* color_bar.c: see color_bar.h. */
#include "color_bar.h"

#include "base/color.h"
#include "image.h"
#include "text.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TICKS_MAX = 9, LABEL_SIZE = 16 };

typedef struct Tick {
    double share; /* 0 at the least value */
    char label[LABEL_SIZE];
} Tick;

/* Round numbers (1, 2 or 5 by a power of ten) within the range, 3 to 8 of them. */
static int choose_ticks(const double range[2], Tick ticks[TICKS_MAX]) {
    const double width = range[1] - range[0];
    int count = 0;
    if (!(width > 0) || !isfinite(width)) {
        snprintf(ticks[0].label, LABEL_SIZE, "%.4g", range[0]);
        ticks[0].share = 0.5;
        return 1;
    }
    double step = pow(10, floor(log10(width)));
    if (width / step < 2)
        step /= 5;
    else if (width / step < 4)
        step /= 2;
    for (double k = ceil(range[0] / step - 1e-9); k * step <= range[1] + 1e-9 * width && count < TICKS_MAX;
         k++) {
        const double value = k == 0 ? 0 : k * step;
        ticks[count].share = fmin(1, fmax(0, (value - range[0]) / width));
        snprintf(ticks[count].label, LABEL_SIZE, "%.4g", value);
        count++;
    }
    return count;
}

/* Dark on a light picture, light on a dark one. */
static bool is_light(const BpPicture *picture, BpTransfer transfer, uint32_t left) {
    double sum = 0;
    uint64_t count = 0;
    for (uint32_t y = 0; y < picture->height; y++) {
        for (uint32_t x = left; x < picture->width; x++, count++) {
            const float *const pixel = picture->rgb + 3 * ((size_t)y * picture->width + x);
            sum += bp_transfer_byte(bp_luminance(pixel), transfer);
        }
    }
    return count > 0 && sum / (double)count >= 128;
}

/* Draws a rim of width `reach` around pixels of colour `ink`, over untouched pixels. */
static void draw_rim(BpCanvas *canvas, const uint8_t untouched[3], const uint8_t ink[3], const uint8_t rim[3],
                     uint32_t reach) {
    for (uint32_t y = 0; y < canvas->height; y++)
        for (uint32_t x = 0; x < canvas->width; x++) {
            if (memcmp(canvas->rgb + 3 * ((size_t)y * canvas->width + x), ink, 3) != 0) continue;
            for (uint32_t v = y > reach ? y - reach : 0; v <= y + reach && v < canvas->height; v++)
                for (uint32_t u = x > reach ? x - reach : 0; u <= x + reach && u < canvas->width; u++) {
                    uint8_t *const pixel = canvas->rgb + 3 * ((size_t)v * canvas->width + u);
                    if (memcmp(pixel, untouched, 3) == 0) memcpy(pixel, rim, 3);
                }
        }
}

static void draw(BpCanvas *canvas, BpTransfer transfer, const float colors[BP_COLOR_BAR_STOPS][3],
                 const Tick *ticks, int count, const char *title, uint32_t scale, uint32_t right,
                 const uint8_t ink[3]) {
    const uint32_t bar = 10 * scale, height = canvas->height / 2, top = canvas->height / 4;
    const uint32_t left = canvas->width - right;
    bp_canvas_fill(canvas, left - scale, top - scale, bar + 2 * scale, height + 2 * scale, ink);
    for (uint32_t y = 0; y < height; y++) {
        const double place = (1 - (y + 0.5) / height) * (BP_COLOR_BAR_STOPS - 1);
        const float *const color = colors[(size_t)(place + 0.5)];
        uint8_t bytes[3];
        for (int c = 0; c < 3; c++) bytes[c] = bp_transfer_byte((double)color[c], transfer);
        bp_canvas_fill(canvas, left, top + y, bar, 1, bytes);
    }
    for (int t = 0; t < count; t++) {
        const uint32_t y = top + (uint32_t)((1 - ticks[t].share) * (height - 1));
        bp_canvas_fill(canvas, left + bar + scale, y, 3 * scale, scale, ink);
        bp_canvas_text(canvas, left + bar + 6 * scale, y > 3 * scale ? y - 3 * scale : 0, scale,
                       ticks[t].label, ink);
    }
    const uint32_t width = bp_text_width(title, scale), margin = 4 * scale;
    const uint32_t room = canvas->width > width + margin ? canvas->width - width - margin : 0;
    bp_canvas_text(canvas, left < room ? left : room, top - 14 * scale, scale, title, ink);
}

BpStatus bp_color_bar_draw(BpPicture *picture, BpTransfer transfer, const float colors[BP_COLOR_BAR_STOPS][3],
                           const double range[2], const char *title, BpError *err) {
    static const uint8_t untouched[3] = {1, 2, 3}; /* no colour of a map */
    static const uint8_t dark[3] = {40, 40, 40}, light[3] = {224, 224, 224};
    static const uint8_t white[3] = {255, 255, 255};
    Tick ticks[TICKS_MAX] = {{0}};
    char small[64];
    const int count = choose_ticks(range, ticks);
    const uint32_t scale = picture->height >= 600 ? picture->height / 300 : 1;
    uint32_t label = 0;
    for (int t = 0; t < count; t++)
        if (bp_text_width(ticks[t].label, scale) > label) label = bp_text_width(ticks[t].label, scale);
    const uint32_t right = 24 * scale + label;
    if (picture->width < 2 * right || picture->height < 80) return BP_OK;
    snprintf(small, sizeof small, "%s", title);
    for (char *c = small; *c != '\0'; c++) *c = (char)tolower((unsigned char)*c);
    BpCanvas canvas = {.width = picture->width, .height = picture->height};
    const size_t pixels = (size_t)picture->width * picture->height;
    canvas.rgb = malloc(3 * pixels);
    if (canvas.rgb == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a colour bar");
    bp_canvas_fill(&canvas, 0, 0, canvas.width, canvas.height, untouched);
    /* A transparent picture may be placed on a page of any colour: dark letters with a light rim are readable
     * on all. */
    const bool is_dark = picture->alpha != NULL || is_light(picture, transfer, picture->width - right);
    draw(&canvas, transfer, colors, ticks, count, small, scale, right, is_dark ? dark : light);
    if (picture->alpha != NULL) draw_rim(&canvas, untouched, dark, white, 2 * scale);
    bp_canvas_copy(&canvas, untouched, picture, 0, transfer);
    free(canvas.rgb);
    return BP_OK;
}
