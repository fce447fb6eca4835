/* page_front.c: error against seconds, both by logarithm, with the front of best choices; see page.h. */
#include "page.h"

#include "format.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#define WIDTH 1060
#define HEIGHT 560
#define LEFT 64
#define RIGHT 820 /* labels stand to the right of it */
#define TOP 16
#define BOTTOM 508
#define LABEL_X 862
#define LABEL_GAP 19

/* A logarithmic axis: values low .. high lie at from .. to. */
typedef struct Axis {
    double low, high, from, to;
} Axis;

static double place(const Axis *axis, double value) {
    return axis->from + (axis->to - axis->from) * log(value / axis->low) / log(axis->high / axis->low);
}

static void reach(Axis *axis, double value) {
    axis->low = fmin(axis->low, value);
    axis->high = fmax(axis->high, value);
}

/* Room around the points; at least a factor of two in all. */
static void widen(Axis *axis) {
    const double factor = fmax(pow(axis->high / axis->low, 0.06), 1.2);
    axis->low /= factor;
    axis->high *= factor;
}

static bool shown(const BpStudyPoint *point) {
    return isfinite(point->nrmse) && point->nrmse > 0 && point->seconds > 0;
}

static bool find_ranges(const BpStudyResult *result, Axis *x, Axis *y) {
    *x = (Axis){INFINITY, 0, LEFT, RIGHT};
    *y = (Axis){INFINITY, 0, BOTTOM, TOP};
    for (size_t s = 0; s < result->count; s++)
        for (size_t i = 0; i < result->series[s].count; i++) {
            const BpStudyPoint *point = &result->series[s].points[i];
            if (!shown(point)) continue;
            reach(x, point->seconds);
            reach(y, point->nrmse);
        }
    if (!(x->high > 0)) return false;
    widen(x);
    widen(y);
    return true;
}

static void print_tick(const Axis *axis, bool is_x, double value, bool labelled, FILE *out) {
    char text[32];
    const double at = place(axis, value);
    const char *kind = labelled ? "major" : "grid";
    if (is_x) {
        fprintf(out, "<line class=\"%s\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\"/>", kind, at, at, TOP,
                BOTTOM);
        if (value < 0.9995)
            snprintf(text, sizeof text, "%g ms", 1000 * value);
        else if (value < 1e4)
            snprintf(text, sizeof text, "%g s", value);
        else
            snprintf(text, sizeof text, "%.1g s", value);
        if (labelled)
            fprintf(out, "<text class=\"tick\" x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%s</text>\n", at,
                    BOTTOM + 20, text);
    } else {
        fprintf(out, "<line class=\"%s\" x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\"/>", kind, LEFT, RIGHT,
                at, at);
        if (labelled)
            fprintf(out, "<text class=\"tick\" x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g %%</text>\n",
                    LEFT - 10, at + 4.5, 100 * value);
    }
}

/* Lines at 1, 2 and 5 times powers of ten; when they are many, the powers alone have labels. */
static void print_ticks(const Axis *axis, bool is_x, FILE *out) {
    static const double steps[3] = {1, 2, 5};
    const bool many = log10(axis->high / axis->low) > 3.2;
    for (int d = (int)floor(log10(axis->low)); d <= (int)ceil(log10(axis->high)); d++)
        for (int i = 0; i < 3; i++) {
            const double value = steps[i] * pow(10, d);
            if (value < axis->low || value > axis->high) continue;
            print_tick(axis, is_x, value, i == 0 || !many, out);
        }
}

static int by_seconds(const void *a, const void *b) {
    const BpStudyPoint *const *p = a, *const *q = b;
    return ((*p)->seconds > (*q)->seconds) - ((*p)->seconds < (*q)->seconds);
}

static void print_front(const BpStudyResult *result, const Axis *x, const Axis *y, FILE *out) {
    const BpStudyPoint *front[BP_STUDY_SETTINGS_MAX * BP_STUDY_LEVELS_MAX];
    size_t count = 0;
    for (size_t s = 0; s < result->count; s++)
        for (size_t i = 0; i < result->series[s].count; i++)
            if (result->series[s].points[i].front && shown(&result->series[s].points[i]))
                front[count++] = &result->series[s].points[i];
    qsort(front, count, sizeof front[0], by_seconds);
    fputs("<polyline class=\"front\" points=\"", out);
    for (size_t i = 0; i < count; i++)
        fprintf(out, "%.1f,%.1f ", place(x, front[i]->seconds), place(y, front[i]->nrmse));
    fputs("\"/>\n", out);
}

static void print_targets(const Axis *y, const BpStudyResult *result, FILE *out) {
    for (int t = 0; t < BP_STUDY_TARGETS; t++) {
        const double target = result->advice[t].target, at = place(y, target);
        if (target < y->low || target > y->high) continue;
        fprintf(out,
                "<line class=\"target\" x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\"/>"
                "<text class=\"target-name\" x=\"%d\" y=\"%.1f\">%g %% error</text>\n",
                LEFT, RIGHT, at, at, LEFT + 8, at - 6, 100 * target);
    }
}

static void print_curve(const BpStudySeries *series, const Axis *x, const Axis *y, FILE *out) {
    char seconds[32], error[32];
    fprintf(out, "<g class=\"a-%s\" data-curve=\"%s\"><polyline class=\"curve\" points=\"",
            series->setting.axis, series->setting.name);
    for (size_t i = 0; i < series->count; i++)
        if (shown(&series->points[i]))
            fprintf(out, "%.1f,%.1f ", place(x, series->points[i].seconds),
                    place(y, series->points[i].nrmse));
    fputs("\"/>\n", out);
    for (size_t i = 0; i < series->count; i++) {
        const BpStudyPoint *point = &series->points[i];
        if (!shown(point)) continue;
        fprintf(out, "<circle class=\"dot%s\" r=\"%s\" cx=\"%.2f\" cy=\"%.2f\" data-samples=\"%" PRIu64 "\"",
                point->front ? " best" : "", point->front ? "5" : "3.5", place(x, point->seconds),
                place(y, point->nrmse), point->samples);
        bp_page_data(out, "seconds", point->seconds);
        bp_page_data(out, "nrmse", point->nrmse);
        fprintf(out, "><title>%s, %" PRIu64 " samples a pixel: %s in %s</title></circle>\n",
                series->setting.name, point->samples, bp_study_percent(point->nrmse, error, sizeof error),
                bp_study_seconds(point->seconds, seconds, sizeof seconds));
    }
    fputs("</g>\n", out);
}

/* ---- labels ---- */

typedef struct Label {
    const BpStudySeries *series;
    double x, y, at; /* the curve's end; the height of the label */
} Label;

static int by_height(const void *a, const void *b) {
    const Label *p = a, *q = b;
    return (p->y > q->y) - (p->y < q->y);
}

/* Every label as high as its curve ends, but none upon another. */
static void spread(Label *labels, size_t count) {
    qsort(labels, count, sizeof *labels, by_height);
    for (size_t i = 0; i < count; i++) {
        labels[i].at = fmax(labels[i].y, TOP + 6);
        if (i > 0) labels[i].at = fmax(labels[i].at, labels[i - 1].at + LABEL_GAP);
    }
    /* Groups of neighbours move up by half of what they were pushed down in all. */
    double limit = BOTTOM;
    for (size_t i = count; i-- > 0; limit = labels[i].at - LABEL_GAP)
        labels[i].at = fmin(labels[i].at, limit);
    double below = BOTTOM;
    for (size_t i = count; i-- > 0; below = labels[i].at - LABEL_GAP) {
        const double lift = 0.5 * (labels[i].at - labels[i].y);
        const double above = TOP + 6 + LABEL_GAP * (double)i;
        if (lift > 0) labels[i].at = fmax(above, labels[i].at - lift);
        labels[i].at = fmin(labels[i].at, below);
    }
}

static void print_labels(const BpStudyResult *result, const Axis *x, const Axis *y, FILE *out) {
    Label labels[BP_STUDY_SETTINGS_MAX];
    size_t count = 0;
    for (size_t s = 0; s < result->count; s++) {
        const BpStudySeries *series = &result->series[s];
        size_t last = series->count;
        while (last > 0 && !shown(&series->points[last - 1])) last--;
        if (last == 0) continue;
        labels[count++] = (Label){series, place(x, series->points[last - 1].seconds),
                                  place(y, series->points[last - 1].nrmse), 0};
    }
    spread(labels, count);
    for (size_t i = 0; i < count; i++) {
        const Label *label = &labels[i];
        fprintf(out,
                "<g class=\"a-%s\"><path class=\"leader\" d=\"M%.1f %.1f C%.1f %.1f %d %.1f %d %.1f\"/>"
                "<text class=\"label\" x=\"%d\" y=\"%.1f\">%s</text></g>\n",
                label->series->setting.axis, label->x + 7, label->y, 0.5 * (label->x + LABEL_X), label->y,
                LABEL_X - 40, label->at, LABEL_X - 6, label->at, LABEL_X, label->at + 4.5,
                label->series->setting.name);
    }
}

void bp_page_front(const BpStudyResult *result, FILE *out) {
    Axis x, y;
    fputs("<section id=\"front\">\n<h2>Error against time</h2>\n", out);
    if (!find_ranges(result, &x, &y)) {
        fputs("<p>No way has an error that can be told from none.</p>\n</section>\n", out);
        return;
    }
    fprintf(out,
            "<p class=\"caption\">Each point is a picture of %u × %u pixels, each curve a way to render it "
            "with more and more samples. The broad line joins the best: nothing measured is both quicker and "
            "closer to the truth.</p>\n<div class=\"sheet\">\n<svg viewBox=\"0 0 %d %d\" role=\"img\" "
            "aria-label=\"Error against seconds, both by logarithm\">\n",
            result->scene->camera.width, result->scene->camera.height, WIDTH, HEIGHT);
    print_ticks(&x, true, out);
    print_ticks(&y, false, out);
    print_targets(&y, result, out);
    print_front(result, &x, &y, out);
    print_labels(result, &x, &y, out);
    for (size_t s = result->count; s-- > 0;) print_curve(&result->series[s], &x, &y, out);
    fprintf(out,
            "<text class=\"axis-name\" x=\"%d\" y=\"%d\" text-anchor=\"end\">time to trace</text>\n"
            "<text class=\"axis-name\" transform=\"translate(14 %d) rotate(-90)\" text-anchor=\"end\">error "
            "(NRMSE)</text>\n</svg>\n</div>\n</section>\n",
            RIGHT, BOTTOM + 44, TOP);
}
