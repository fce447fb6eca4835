/* page_strips.c: the same crop at each accuracy, and its error map; see page.h. */
#include "page.h"

#include "../image/error_map.h"
#include "format.h"

#include <inttypes.h>
#include <math.h>

/* RFC 4648, section 4. */
static void print_base64(const char *bytes, size_t size, FILE *out) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t bits = 0;
        for (size_t b = 0; b < 3; b++) bits = bits << 8 | (i + b < size ? (uint8_t)bytes[i + b] : 0u);
        for (size_t d = 0; d < 4; d++) fputc(i + d > size ? '=' : digits[bits >> (18 - 6 * d) & 63], out);
    }
}

static void print_image(const BpStudyPng *png, const BpStudyResult *result, const char *alt, FILE *out) {
    fprintf(out, "<img width=\"%u\" height=\"%u\" alt=\"%s\" src=\"data:image/png;base64,",
            result->crop_width, result->crop_height, alt);
    print_base64(png->bytes, png->size, out);
    fputs("\">", out);
}

static void print_figure(const BpStudyResult *result, const BpStudyCrop *crop, const char *head,
                         const char *error, const char *seconds, FILE *out) {
    fputs("<figure>", out);
    print_image(&crop->picture, result, "a crop of the picture", out);
    print_image(&crop->map, result, "its error map", out);
    fprintf(out, "<figcaption><b>%s</b>error %s%s%s</figcaption></figure>\n", head, error,
            seconds[0] != '\0' ? ", " : "", seconds);
}

static void print_point(const BpStudyResult *result, const BpStudyPoint *point, const char *head, FILE *out) {
    char error[32], seconds[32];
    print_figure(result, &point->crop, head, bp_study_percent(point->nrmse, error, sizeof error),
                 bp_study_seconds(point->seconds, seconds, sizeof seconds), out);
}

static void print_truth(const BpStudyResult *result, FILE *out) {
    char error[32];
    print_figure(result, &result->truth, "the truth, and what is left of its noise",
                 bp_study_percent(result->reference_error, error, sizeof error), "", out);
}

static void print_scale(FILE *out) {
    enum { STOPS = 24 };
    fputs("<p class=\"scale\"><span>error of a pixel: 0.1 %</span><span class=\"ramp\" "
          "style=\"background: linear-gradient(to right",
          out);
    for (int i = 0; i <= STOPS; i++) {
        uint8_t rgb[3];
        const double position = (double)i / STOPS;
        bp_error_color(BP_ERROR_MAP_LEAST * pow(BP_ERROR_MAP_MOST / BP_ERROR_MAP_LEAST, position), rgb);
        fprintf(out, ", #%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    }
    fputs(")\"></span><span>100 %, by logarithm</span></p>\n", out);
}

void bp_page_strips(const BpStudyResult *result, FILE *out) {
    const BpStudySeries *base = &result->series[0];
    char head[64];
    fprintf(
        out,
        "<section id=\"pictures\">\n<h2>What it looks like</h2>\n<p class=\"caption\">The window of %u × %u "
        "pixels in which the choices differ most, and below it how far each pixel is from the truth.</p>\n",
        result->crop_width, result->crop_height);
    print_scale(out);
    fprintf(out, "<h3>More samples, %s</h3>\n<div class=\"strip three\">\n", base->setting.name);
    for (size_t i = 0; i < base->count; i++) {
        snprintf(head, sizeof head, "%" PRIu64 " samples a pixel", base->points[i].samples);
        print_point(result, &base->points[i], head, out);
    }
    print_truth(result, out);
    fprintf(out, "</div>\n<h3>Other ways, %" PRIu64 " samples a pixel</h3>\n<div class=\"strip four\">\n",
            base->points[base->count - 1].samples);
    for (size_t s = 1; s < result->count; s++) {
        const BpStudySeries *series = &result->series[s];
        print_point(result, &series->points[series->count - 1], series->setting.name, out);
    }
    fputs("</div>\n</section>\n", out);
}
