/* error_map.c: see error_map.h. */
#include "error_map.h"

#include "base/color.h"
#include "base/output_file.h"
#include "base/quantile.h"
#include "image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SHADES 512
#define SMALL_WIDTH 360u  /* narrower pictures are enlarged up to about this */
#define LEGEND_WIDTH 312u /* pixels that the legend needs at scale 1 */

static const uint8_t paper[3] = {22, 22, 26}, ink[3] = {225, 225, 225}, faint[3] = {160, 160, 166},
                     unknown[3] = {128, 128, 128};

double bp_pixel_relative_error(const BpPicture *picture, size_t pixel) {
    const double luminance = bp_luminance(picture->rgb + 3 * pixel);
    double error = 0;
    for (size_t c = 0; c < 3; c++) error += bp_luminance_weights[c] * (double)picture->error[3 * pixel + c];
    if (!(luminance > 0)) return error > 0 ? (double)INFINITY : (double)NAN;
    return error / luminance;
}

/* ---- colours ---- */

/* CIELAB to linear sRGB, white D65 (CIE 15:2004; IEC 61966-2-1:1999). */
static void lab_to_linear(double lightness, double a, double b, double rgb[3]) {
    static const double white[3] = {0.95047, 1, 1.08883};
    static const double matrix[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                        {-0.9692660, 1.8760108, 0.0415560},
                                        {0.0556434, -0.2040259, 1.0572252}};
    const double y = (lightness + 16) / 116;
    const double roots[3] = {y + a / 500, y, y - b / 200};
    double xyz[3];
    for (int i = 0; i < 3; i++) {
        const double root = roots[i];
        xyz[i] = white[i] * (root > 6.0 / 29 ? root * root * root : (root - 4.0 / 29) * 108 / 841);
    }
    for (int i = 0; i < 3; i++)
        rgb[i] = matrix[i][0] * xyz[0] + matrix[i][1] * xyz[1] + matrix[i][2] * xyz[2];
}

/* The scale's colour at `position`, 0 to 1: lightness rises evenly, and the hue goes from violet through red
 * to yellow. The chroma is within sRGB everywhere on that path, so no colour is clipped and the scale has no
 * edges. */
static void scale_color(double position, uint8_t rgb[3]) {
    static const double pi = 3.14159265358979324;
    const double lightness = 10 + 85 * position;
    const double hue = (300 + 160 * position) * pi / 180;
    const double chroma = 34 + 35 * sin(pi * position);
    double linear[3];
    lab_to_linear(lightness, chroma * cos(hue), chroma * sin(hue), linear);
    for (int c = 0; c < 3; c++) rgb[c] = bp_transfer_byte(linear[c], BP_TRANSFER_SRGB);
}

/* The position of a relative error on the scale, 0 to 1; NaN stays NaN. */
static double scale_position(double relative_error) {
    if (isnan(relative_error)) return relative_error;
    if (!(relative_error > BP_ERROR_MAP_LEAST)) return 0;
    if (relative_error >= BP_ERROR_MAP_MOST) return 1;
    return log(relative_error / BP_ERROR_MAP_LEAST) / log(BP_ERROR_MAP_MOST / BP_ERROR_MAP_LEAST);
}

void bp_error_color(double relative_error, uint8_t rgb[3]) {
    const double position = scale_position(relative_error);
    if (isnan(position))
        memcpy(rgb, unknown, 3);
    else
        scale_color(floor(position * (SHADES - 1) + 0.5) / (SHADES - 1), rgb);
}

/* ---- the map ---- */

typedef struct MapPlan {
    uint32_t zoom;   /* canvas pixels a pixel */
    uint32_t left;   /* of the picture */
    uint32_t scale;  /* of letters and lines */
    uint32_t legend; /* its top */
    uint32_t margin;
} MapPlan;

static uint32_t larger(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}

static MapPlan plan_canvas(const BpPicture *picture, BpCanvas *canvas) {
    MapPlan plan;
    plan.zoom = larger(1, SMALL_WIDTH / picture->width);
    /* Limits the height of very narrow pictures. */
    while (plan.zoom > 1 && plan.zoom * picture->height > 4 * SMALL_WIDTH) plan.zoom--;
    const uint32_t width = plan.zoom * picture->width;
    canvas->width = larger(width, LEGEND_WIDTH);
    plan.scale = larger(1, canvas->width / 400);
    plan.left = (canvas->width - width) / 2;
    plan.margin = 8 * plan.scale;
    plan.legend = plan.zoom * picture->height + plan.margin;
    canvas->height = plan.legend + 46 * plan.scale;
    return plan;
}

static void draw_pixels(const BpPicture *picture, const MapPlan *plan, BpCanvas *canvas) {
    uint8_t shades[SHADES][3];
    for (size_t i = 0; i < SHADES; i++) scale_color((double)i / (SHADES - 1), shades[i]);
    for (uint32_t y = 0; y < picture->height; y++)
        for (uint32_t x = 0; x < picture->width; x++) {
            const double position =
                scale_position(bp_pixel_relative_error(picture, (size_t)y * picture->width + x));
            const uint8_t *color =
                isnan(position) ? unknown : shades[(size_t)(position * (SHADES - 1) + 0.5)];
            bp_canvas_fill(canvas, plan->left + x * plan->zoom, y * plan->zoom, plan->zoom, plan->zoom,
                           color);
        }
}

/* Some pixel shows something. */
static bool has_depth(const BpPicture *picture) {
    const size_t pixels = (size_t)picture->width * picture->height;
    for (size_t i = 0; picture->depth != NULL && i < pixels; i++)
        if (isfinite(picture->depth[i])) return true;
    return false;
}

/* The median of the known relative errors; NaN if none is known. It is over pixels that show some sphere,
 * since the sky has no noise and would hide that of the spheres. In a picture without depth, the sky is
 * unknown; there pixels without noise are left out, if others have some. `of_what`: the pixels that count, in
 * words. */
static BpStatus median_error(const BpPicture *picture, double *median, const char **of_what, BpError *err) {
    const bool of_spheres = has_depth(picture);
    const size_t pixels = (size_t)picture->width * picture->height;
    double *errors = malloc(pixels * sizeof *errors);
    if (errors == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the error map");
    size_t known = 0, count = 0;
    for (size_t i = 0; i < pixels; i++) {
        const double error = bp_pixel_relative_error(picture, i);
        if (isnan(error) || (of_spheres && !isfinite(picture->depth[i]))) continue;
        known++;
        if (of_spheres || error > 0) errors[count++] = error;
    }
    bp_sort_doubles(errors, count);
    *median = known == 0 ? (double)NAN : count == 0 ? 0 : errors[count / 2];
    *of_what = of_spheres ? " on spheres" : count > 0 && count < known ? " where noisy" : "";
    free(errors);
    return BP_OK;
}

/* "0.12%", "3.4%", "56%" */
static void format_percent(double fraction, char text[32]) {
    const double percent = 100 * fraction;
    if (isnan(percent))
        snprintf(text, 32, "unknown");
    else if (percent > 999)
        snprintf(text, 32, ">999%%");
    else
        snprintf(text, 32, "%.*f%%", percent < 0.995 ? 2 : percent < 9.95 ? 1 : 0, percent);
}

/* The colour bar with its ticks and, below, its quantity and the median. */
static void draw_legend(const MapPlan *plan, const char *of_what, double median, BpCanvas *canvas) {
    const uint32_t s = plan->scale, left = plan->margin, bar = canvas->width - 2 * plan->margin;
    for (uint32_t x = 0; x < bar; x++) {
        uint8_t color[3];
        scale_color(x / (double)(bar - 1), color);
        bp_canvas_fill(canvas, left + x, plan->legend, 1, 10 * s, color);
    }
    static const double ticks[] = {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1};
    static const char *const labels[] = {"<0.1%", "", "", "1%", "", "", "10%", "", "", ">100%"};
    for (size_t i = 0; i < sizeof ticks / sizeof ticks[0]; i++) {
        const uint32_t x = left + (uint32_t)(scale_position(ticks[i]) * (bar - s) + 0.5);
        const bool labelled = labels[i][0] != '\0';
        bp_canvas_fill(canvas, x, plan->legend + 10 * s, s, (labelled ? 5 : 3) * s, labelled ? ink : faint);
        const uint32_t width = bp_text_width(labels[i], s);
        uint32_t start = x > left + width / 2 ? x - width / 2 : left;
        if (start + width > left + bar) start = left + bar - width;
        bp_canvas_text(canvas, start, plan->legend + 17 * s, s, labels[i], ink);
    }
    char percent[32], text[64];
    format_percent(median, percent);
    snprintf(text, sizeof text, "median%s %s", of_what, percent);
    const uint32_t y = plan->legend + 31 * s;
    bp_canvas_text(canvas, left, y, s, "relative noise", faint);
    const uint32_t key = left + bar - bp_text_width("unknown", s);
    bp_canvas_text(canvas, key, y, s, "unknown", faint);
    bp_canvas_fill(canvas, key - 11 * s, y, 8 * s, 8 * s, unknown);
    const uint32_t first_end = left + bp_text_width("relative noise", s), second_start = key - 11 * s;
    const uint32_t middle = (first_end + second_start - bp_text_width(text, s)) / 2;
    bp_canvas_text(canvas, middle, y, s, text, ink);
}

BpStatus bp_error_map_draw(const BpPicture *picture, BpCanvas *canvas, BpError *err) {
    memset(canvas, 0, sizeof *canvas);
    if (picture->width == 0 || picture->height == 0 || picture->rgb == NULL || picture->error == NULL)
        return bp_fail(err, BP_ERR_USAGE, "the picture has no standard errors to make an error map from");
    double median = 0;
    const char *of_what = "";
    BP_TRY(median_error(picture, &median, &of_what, err));
    const MapPlan plan = plan_canvas(picture, canvas);
    canvas->rgb = malloc((size_t)canvas->width * canvas->height * 3);
    if (canvas->rgb == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the error map");
    bp_canvas_fill(canvas, 0, 0, canvas->width, canvas->height, paper);
    draw_pixels(picture, &plan, canvas);
    draw_legend(&plan, of_what, median, canvas);
    return BP_OK;
}

BpStatus bp_error_map_print(const BpPicture *picture, FILE *out, BpError *err) {
    BpCanvas canvas;
    BP_TRY(bp_error_map_draw(picture, &canvas, err));
    const BpStatus status = bp_png_write_bytes(canvas.rgb, canvas.width, canvas.height, out, err);
    free(canvas.rgb);
    return status;
}

static BpStatus print_map(const void *picture, FILE *out, BpError *err) {
    return bp_error_map_print(picture, out, err);
}

BpStatus bp_error_map_write(const BpPicture *picture, const char *path, BpError *err) {
    return bp_output_write(path, false, print_map, picture, err);
}
