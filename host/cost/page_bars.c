/* page_bars.c: efficiency and bias of every way, as bars in one row; see page.h. */
#include "page.h"

#include "format.h"

#include <math.h>

#define WIDTH 1060
#define ROW 32
#define TOP 62
#define NAME_X 8
#define FACTOR_LEFT 186
#define FACTOR_RIGHT 426
#define FACTOR_TEXT 440
#define BIAS_LEFT 524
#define BIAS_RIGHT 808
#define BIAS_TEXT 822
#define PIXEL_TEXT 1052
#define BIAS_UNIT 1e-5 /* biases below it are drawn in proportion, above by logarithm */

/* ---- efficiency: a logarithmic scale around 1 ---- */

typedef struct FactorScale {
    double low, high;
} FactorScale;

static FactorScale factor_scale(const BpStudyResult *result) {
    FactorScale scale = {0.5, 2};
    for (size_t s = 0; s < result->count; s++) {
        const double factor = result->series[s].efficiency;
        if (!isfinite(factor)) continue;
        scale.low = fmin(scale.low, factor / 1.1);
        scale.high = fmax(scale.high, factor * 1.1);
    }
    return scale;
}

static double factor_x(const FactorScale *scale, double factor) {
    return FACTOR_LEFT +
           (FACTOR_RIGHT - FACTOR_LEFT) * log(factor / scale->low) / log(scale->high / scale->low);
}

static void print_factor_ticks(const FactorScale *scale, int bottom, FILE *out) {
    static const double ticks[] = {0.01, 0.1, 0.25, 0.5, 1, 2, 4, 10, 100};
    for (size_t t = 0; t < sizeof ticks / sizeof ticks[0]; t++) {
        if (ticks[t] < scale->low || ticks[t] > scale->high) continue;
        const double x = factor_x(scale, ticks[t]);
        fprintf(out,
                "<line class=\"%s\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\"/>"
                "<text class=\"tick\" x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%g×</text>\n",
                ticks[t] == 1 ? "zero" : "major", x, x, TOP, bottom, x, TOP - 8, ticks[t]);
    }
}

/* ---- bias: proportional in the middle, logarithmic outside ---- */

typedef struct BiasScale {
    double low, high; /* of asinh(bias / BIAS_UNIT) */
} BiasScale;

static BiasScale bias_scale(const BpStudyResult *result) {
    double low = -2e-4, high = 2e-4;
    for (size_t s = 0; s < result->count; s++) {
        const BpStudyEstimate *bias = &result->series[s].bias;
        if (isnan(bias->value)) continue;
        low = fmin(low, 1.5 * bias->low);
        high = fmax(high, 1.5 * bias->high);
    }
    return (BiasScale){asinh(low / BIAS_UNIT), asinh(high / BIAS_UNIT)};
}

static double bias_x(const BiasScale *scale, double bias) {
    return BIAS_LEFT +
           (BIAS_RIGHT - BIAS_LEFT) * (asinh(bias / BIAS_UNIT) - scale->low) / (scale->high - scale->low);
}

static void print_bias_tick(const BiasScale *scale, double bias, int bottom, double *free_from, FILE *out) {
    const double x = bias_x(scale, bias), half = bias == 0 ? 6 : 27; /* of the label's width */
    fprintf(out, "<line class=\"%s\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\"/>",
            bias == 0 ? "zero" : "major", x, x, TOP, bottom);
    if (fabs(x - bias_x(scale, 0)) < 34 && bias != 0) return; /* leaves room for the nought */
    if (x - half < *free_from) return;
    *free_from = x + half + 4;
    fprintf(out, "<text class=\"tick\" x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%s%g%s</text>\n", x,
            TOP - 8,
            bias < 0   ? "−"
            : bias > 0 ? "+"
                       : "",
            100 * fabs(bias), bias == 0 ? "" : " %");
}

/* Powers of ten on both sides, from left to right; labels where there is room. */
static void print_bias_ticks(const BiasScale *scale, int bottom, FILE *out) {
    static const double ticks[] = {-1, -0.1, -1e-2, -1e-3, -1e-4, 0, 1e-4, 1e-3, 1e-2, 0.1, 1};
    double free_from = 0;
    for (size_t t = 0; t < sizeof ticks / sizeof ticks[0]; t++) {
        const double at = asinh(ticks[t] / BIAS_UNIT);
        if (at >= scale->low && at <= scale->high) print_bias_tick(scale, ticks[t], bottom, &free_from, out);
    }
}

/* ---- rows ---- */

static void print_bar(const char *kind, double from, double to, double top, FILE *out) {
    fprintf(out, "<rect class=\"bar%s\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"14\" rx=\"2\"/>", kind,
            fmin(from, to), top + 9, fmax(1.5, fabs(to - from)));
}

static void print_bias(const BpStudyEstimate *bias, const BiasScale *scale, double top, FILE *out) {
    const double low = bias_x(scale, bias->low), high = bias_x(scale, bias->high), y = top + 16;
    print_bar(bias->low <= 0 && bias->high >= 0 ? " unsure" : "", bias_x(scale, 0),
              bias_x(scale, bias->value), top, out);
    fprintf(out, "<path class=\"whisker\" d=\"M%.1f %.1fH%.1fM%.1f %.1fv10M%.1f %.1fv10\"/>", low, y, high,
            low, y - 5, high, y - 5);
}

static void print_row(const BpStudyResult *result, size_t s, const FactorScale *factors,
                      const BiasScale *biases, FILE *out) {
    const BpStudySeries *series = &result->series[s];
    const double top = TOP + ROW * (double)s;
    char text[64];
    fprintf(out, "<g class=\"a-%s\" data-row=\"%s\"", series->setting.axis, series->setting.name);
    bp_page_data(out, "efficiency", series->efficiency);
    bp_page_data(out, "bias", series->bias.value);
    bp_page_data(out, "low", series->bias.low);
    bp_page_data(out, "high", series->bias.high);
    fprintf(out, ">\n<text class=\"label\" x=\"%d\" y=\"%.1f\">%s</text>\n", NAME_X, top + 21,
            series->setting.name);
    if (isfinite(series->efficiency))
        print_bar("", factor_x(factors, 1), factor_x(factors, series->efficiency), top, out);
    fprintf(out, "<text x=\"%d\" y=\"%.1f\">%s</text>\n", FACTOR_TEXT, top + 21,
            bp_study_ratio(series->efficiency, text, sizeof text));
    if (!isnan(series->bias.value)) print_bias(&series->bias, biases, top, out);
    const double pixel = bp_study_pixel_bias(series);
    fprintf(out, "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%s</text>\n", PIXEL_TEXT, top + 21,
            bp_study_percent(pixel, text, sizeof text));
    fprintf(out, "<text x=\"%d\" y=\"%.1f\">%s</text>\n</g>\n", BIAS_TEXT, top + 21,
            bp_study_interval(&series->bias, "±", "−", text, sizeof text));
}

void bp_page_bars(const BpStudyResult *result, FILE *out) {
    const FactorScale factors = factor_scale(result);
    const BiasScale biases = bias_scale(result);
    const int bottom = TOP + ROW * (int)result->count;
    fprintf(out,
            "<section id=\"ways\">\n<h2>What each choice buys, and what it costs</h2>\n<p class=\"caption\">"
            "Efficiency: how much less time for the same noise as “%s”. Bias: how far the mean brightness is "
            "off the truth, however many samples; pale where it may be none. Of a pixel: the root of its "
            "mean square, "
            "from pixel to pixel.</p>\n<div class=\"sheet\">\n"
            "<svg viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"Efficiency and bias of each way\">\n",
            result->series[0].setting.name, WIDTH, bottom + 12);
    for (size_t s = 1; s < result->count; s += 2)
        fprintf(out, "<rect class=\"band\" x=\"0\" y=\"%d\" width=\"%d\" height=\"%d\"/>\n",
                TOP + ROW * (int)s, WIDTH, ROW);
    fprintf(out,
            "<text class=\"axis-name\" x=\"%d\" y=\"20\" text-anchor=\"middle\">efficiency</text>"
            "<text class=\"axis-name\" x=\"%d\" y=\"20\" text-anchor=\"middle\">bias of the brightness, and "
            "its 95 %% interval</text>"
            "<text class=\"axis-name\" x=\"%d\" y=\"20\" text-anchor=\"end\">of a pixel</text>\n",
            (FACTOR_LEFT + FACTOR_RIGHT) / 2, (BIAS_LEFT + BIAS_RIGHT) / 2, PIXEL_TEXT);
    print_factor_ticks(&factors, bottom, out);
    print_bias_ticks(&biases, bottom, out);
    for (size_t s = 0; s < result->count; s++) print_row(result, s, &factors, &biases, out);
    fputs("</svg>\n</div>\n</section>\n", out);
}
