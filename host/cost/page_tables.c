/* page_tables.c: the figures of the page; see page.h. */
#include "page.h"

#include "format.h"

#include <inttypes.h>
#include <math.h>

/* A cell with its value for programs. */
static void cell(FILE *out, const char *key, double value, const char *text) {
    fprintf(out, "<td data-key=\"%s\"", key);
    bp_page_data(out, "value", value);
    fprintf(out, ">%s</td>", text);
}

static void print_way(const BpStudySeries *series, bool is_base, FILE *out) {
    char text[64];
    const BpStudyPoint *last = &series->points[series->count - 1];
    fprintf(out, "<tr data-series=\"%s\"><td>%s", series->setting.name, series->setting.name);
    fputs("<span>", out);
    bp_page_options(out, series->setting.command);
    fputs("</span>", out);
    if (series->setting.fresnel != BP_STUDY_FRESNEL_SCENE)
        fprintf(out, "<span>fresnel: %s</span>", bp_study_fresnel_name(series->setting.fresnel));
    fputs("</td>", out);
    cell(out, "seconds", last->seconds, bp_study_seconds(last->seconds, text, sizeof text));
    cell(out, "claimed_nrmse", last->claimed, bp_study_percent(last->claimed, text, sizeof text));
    cell(out, "nrmse", last->nrmse, bp_study_percent(last->nrmse, text, sizeof text));
    cell(out, "efficiency", series->efficiency, bp_study_ratio(series->efficiency, text, sizeof text));
    cell(out, "change", series->change.value,
         is_base ? "" : bp_study_interval(&series->change, "±", "−", text, sizeof text));
    cell(out, "bias", series->bias.value, bp_study_interval(&series->bias, "±", "−", text, sizeof text));
    const double pixel = bp_study_pixel_bias(series);
    cell(out, "pixel_bias", pixel, bp_study_percent(pixel, text, sizeof text));
    cell(out, "fit_floor", series->fit_floor, bp_study_percent(sqrt(series->fit_floor), text, sizeof text));
    if (isnan(series->fit_slope))
        snprintf(text, sizeof text, "-");
    else
        snprintf(text, sizeof text, "%.3g", series->fit_slope);
    cell(out, "fit_slope", series->fit_slope, text);
    fputs("</tr>\n", out);
}

static void print_point(const BpStudySeries *series, const BpStudyPoint *point, FILE *out) {
    char text[64];
    fprintf(out, "<tr data-point=\"%s\" data-samples=\"%" PRIu64 "\"><td>%s</td><td%s>%" PRIu64 "</td>",
            series->setting.name, point->samples, series->setting.name,
            point->front ? " class=\"best\" title=\"on the front\"" : "", point->samples);
    cell(out, "seconds", point->seconds, bp_study_seconds(point->seconds, text, sizeof text));
    cell(out, "wall_seconds", point->wall_seconds, bp_study_seconds(point->wall_seconds, text, sizeof text));
    cell(out, "device_seconds", point->device_seconds,
         bp_study_seconds(point->device_seconds, text, sizeof text));
    cell(out, "claimed_nrmse", point->claimed, bp_study_percent(point->claimed, text, sizeof text));
    cell(out, "nrmse", point->nrmse, bp_study_percent(point->nrmse, text, sizeof text));
    snprintf(text, sizeof text, "%.3g", point->rel_mse);
    cell(out, "rel_mse", point->rel_mse, text);
    fputs("</tr>\n", out);
}

void bp_page_tables(const BpStudyResult *result, FILE *out) {
    const BpStudySeries *base = &result->series[0];
    const double scatter = bp_study_time_scatter(result);
    fprintf(out,
            "<section id=\"figures\">\n<h2>The figures</h2>\n<p class=\"caption\">At %" PRIu64
            " samples a pixel.",
            base->points[base->count - 1].samples);
    if (isfinite(scatter))
        fprintf(out,
                " One time over another is good to ± %.2g %% (95 %%); less is known of adaptive samples.",
                100 * scatter);
    fprintf(out, "</p>\n<div class=\"sheet\">\n<table>\n<thead><tr><th>way</th><th>time</th>"
                 "<th>noise</th><th>error</th><th>efficiency</th><th>changes<br>brightness by</th>"
                 "<th>off the true<br>one by</th><th>bias of<br>a pixel</th><th>fitted<br>floor</th>"
                 "<th>fitted<br>V</th></tr></thead>\n<tbody>\n");
    for (size_t s = 0; s < result->count; s++) print_way(&result->series[s], s == 0, out);
    fputs("</tbody>\n</table>\n</div>\n<details>\n<summary>Every point</summary>\n<div "
          "class=\"sheet\">\n<table>\n"
          "<thead><tr><th>way</th><th>samples</th><th>time</th><th>wall</th><th>device</th><th>noise</th>"
          "<th>error</th><th>relative MSE</th></tr></thead>\n<tbody>\n",
          out);
    for (size_t s = 0; s < result->count; s++)
        for (size_t i = 0; i < result->series[s].count; i++)
            print_point(&result->series[s], &result->series[s].points[i], out);
    fputs("</tbody>\n</table>\n</div>\n</details>\n</section>\n", out);
}
