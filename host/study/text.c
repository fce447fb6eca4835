/* text.c: the study as a table for a terminal, as CSV, and the advice; see study.h. */
#include "study.h"

#include "base/escape.h"
#include "base/format.h"
#include "base/wrap.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static const char *interval(const BpStudyEstimate *estimate, char *text, size_t size) {
    return bp_format_interval(estimate->value, estimate->low, estimate->high, text, size);
}

static void print_head(const BpStudyResult *result, FILE *out) {
    const BpScene *scene = result->scene;
    char error[32];
    bp_print_escaped(scene->path, false, out);
    fprintf(out, " at %ux%u on ", scene->camera.width, scene->camera.height);
    bp_print_escaped(result->report.device.name, false, out);
    fputc('\n', out);
    fprintf(out,
            "reference: " BP_HANG "exact Fresnel, depth %u, %s, two pictures with %" PRIu64
            " samples per pixel each (noise of their mean: %s)\n\n",
            BP_STUDY_DEPTH, result->reference_is_kernel ? "double precision" : "the reference tracer",
            result->reference_samples, bp_format_percent_cell(result->reference_error, error, sizeof error));
}

/* In two tables, so that each fits a terminal of 80 columns. */
static void print_configurations(const BpStudyResult *result, FILE *out) {
    char time[32], noise[32], error[32], factor[32], change[48], bias[48];
    const BpStudySeries *base = &result->series[0];
    fprintf(out, "Configurations, at %" PRIu64 " samples per pixel:\n",
            base->points[base->count - 1].samples);
    fprintf(out, "  %-21s %9s %9s %9s %11s\n", "", "time", "noise", "error", "efficiency");
    for (size_t s = 0; s < result->count; s++) {
        const BpStudySeries *series = &result->series[s];
        const BpStudyPoint *last = &series->points[series->count - 1];
        fprintf(out, "  %-21s %9s %9s %9s %11s\n", series->configuration.name,
                bp_format_seconds(last->seconds, time, sizeof time),
                bp_format_percent_cell(last->claimed, noise, sizeof noise),
                bp_format_percent_cell(last->nrmse, error, sizeof error),
                bp_format_ratio(series->efficiency, factor, sizeof factor));
    }
    fprintf(out, "\nBrightness:\n  %-21s %26s %26s\n", "", "change by the choice", "bias");
    for (size_t s = 0; s < result->count; s++) {
        const BpStudySeries *series = &result->series[s];
        fprintf(out, "  %-21s %26s %26s\n", series->configuration.name,
                s == 0 ? "" : interval(&series->change, change, sizeof change),
                interval(&series->bias, bias, sizeof bias));
    }
}

static void print_counts(const BpStudyResult *result, FILE *out) {
    char time[32], noise[32], error[32];
    const BpStudySeries *base = &result->series[0];
    fprintf(out, "\nMore samples, %s:\n  %12s %12s %9s %9s %13s\n", base->configuration.name, "samples",
            "time", "noise", "error", "relative MSE");
    for (size_t i = 0; i < base->count; i++) {
        const BpStudyPoint *point = &base->points[i];
        fprintf(out, "  %12" PRIu64 " %12s %9s %9s %13.3g\n", point->samples,
                bp_format_seconds(point->seconds, time, sizeof time),
                bp_format_percent_cell(point->claimed, noise, sizeof noise),
                bp_format_percent_cell(point->nrmse, error, sizeof error), point->rel_mse);
    }
}

bool bp_study_print(const BpStudyResult *result, FILE *out) {
    char line[512];
    print_head(result, out);
    print_configurations(result, out);
    print_counts(result, out);
    fprintf(out, "\nnoise: " BP_HANG "removed by more samples\n"
                 "error: " BP_HANG "noise and bias together, relative to the reference; a dash where the "
                 "reference is too noisy to tell\n"
                 "efficiency: " BP_HANG "1 / (noise^2 x time), relative to the first line\n"
                 "change, bias: " BP_HANG "of the mean brightness, against the first line and against the "
                 "reference\n");
    const double scatter = bp_study_time_scatter(result);
    if (isfinite(scatter))
        fprintf(out, "time: ratios are accurate to +- %.2g %% (95 %% interval), less so for adaptive.\n",
                100 * scatter);
    if (*bp_study_shortness_text(result, line, sizeof line) != '\0') fprintf(out, "\n%s\n", line);
    fprintf(out, "\nRecommended for an error of (times: on this device, when otherwise idle)\n");
    for (int t = 0; t < BP_STUDY_TARGETS; t++) {
        bp_study_advice_text(result, &result->advice[t], line, sizeof line);
        /* The command goes to a line of its own, so that both fit a terminal of 80 columns. */
        const char *command = strstr(line, ": ballpark ");
        if (command == NULL)
            fprintf(out, "  %s\n", line);
        else
            fprintf(out, "  %.*s:\n      " BP_PASTE "%s\n", (int)(command - line), line, command + 2);
    }
    return fflush(out) == 0 && !ferror(out);
}

const char *bp_study_shortness_text(const BpStudyResult *result, char *text, size_t size) {
    const BpStudySeries *base = &result->series[0];
    char least[64] = "", bias[32], unnoticed[96] = "";
    if (base->count <= BP_STUDY_LEVELS_MIN)
        snprintf(least, sizeof least, "it got no further than %" PRIu64 " samples per pixel",
                 base->points[base->count - 1].samples);
    else if (isnan(bp_study_time_scatter(result)))
        snprintf(least, sizeof least, "it has too few measurements to compare times");
    double hidden = 0; /* the largest bias above its target that a recommendation may have */
    for (int t = 0; t < BP_STUDY_TARGETS; t++) {
        const BpStudyAdvice *advice = &result->advice[t];
        const double high = result->series[advice->series].bias_square.high;
        if (advice->reachable && high > advice->target * advice->target) hidden = fmax(hidden, sqrt(high));
    }
    if (hidden > 0)
        snprintf(unnoticed, sizeof unnoticed, "%sa bias of up to %s would have gone unnoticed",
                 least[0] != '\0' ? ", and " : "", bp_format_percent(hidden, bias, sizeof bias));
    text[0] = '\0';
    if (least[0] != '\0' || hidden > 0)
        snprintf(text, size,
                 "This study was too short to rely on its recommendations: %s%s. Give it more time, as in "
                 "`ballpark cost --time %.0fs`.",
                 least, unnoticed, fmax(BP_STUDY_SECONDS_DEFAULT, 4 * result->budget));
    return text;
}

const char *bp_study_advice_text(const BpStudyResult *result, const BpStudyAdvice *advice, char *text,
                                 size_t size) {
    if (!advice->reachable) {
        snprintf(text, size, "%g %%: no configuration reaches it", 100 * advice->target);
        return text;
    }
    const BpStudyConfiguration *configuration = &result->series[advice->series].configuration;
    /* A line to be pasted: a path that needs quotes, or standard input, is left to the reader. */
    const char *path = result->scene->path;
    char clean[4096];
    const bool plain = strpbrk(path, " \"'\\$`;&|<>()*?[]#~!{}") == NULL &&
                       strcmp(bp_escape(path, clean, sizeof clean), path) == 0;
    char seconds[32];
    snprintf(text, size,
             "%g %%: %s, %.0f %s per pixel, about %s at %ux%u%s: ballpark render %.300s --spp %.0f%s%s%s",
             100 * advice->target, configuration->name, advice->samples,
             advice->samples > 1 ? "samples" : "sample",
             bp_format_seconds(advice->seconds, seconds, sizeof seconds), result->full_width,
             result->full_height, advice->extrapolated ? " (samples and time extrapolated)" : "",
             plain ? path : "SCENE", advice->samples, configuration->command[0] != '\0' ? " " : "",
             configuration->command,
             configuration->fresnel == BP_STUDY_FRESNEL_EXACT     ? " --fresnel exact"
             : configuration->fresnel == BP_STUDY_FRESNEL_SCHLICK ? " --fresnel schlick"
                                                                  : "");
    return text;
}

/* An empty cell where unknown. */
static void cell(FILE *out, double value) {
    if (isnan(value))
        fputc(',', out);
    else
        fprintf(out, ",%.9g", value);
}

bool bp_study_print_csv(const BpStudyResult *result, FILE *out) {
    fputs("configuration,axis,options,fresnel,samples,seconds,wall_seconds,device_seconds,cpu_seconds,"
          "claimed_nrmse,"
          "nrmse,mse,mse_error,rel_mse,front\n",
          out);
    for (size_t s = 0; s < result->count; s++) {
        const BpStudySeries *series = &result->series[s];
        for (size_t i = 0; i < series->count; i++) {
            const BpStudyPoint *point = &series->points[i];
            fprintf(out, "\"%s\",%s,%s,%s,%" PRIu64, series->configuration.name, series->configuration.axis,
                    series->configuration.command, bp_study_fresnel_name(series->configuration.fresnel),
                    point->samples);
            const double values[] = {point->seconds,     point->wall_seconds, point->device_seconds,
                                     point->cpu_seconds, point->claimed,      point->nrmse,
                                     point->mse,         point->mse_error,    point->rel_mse};
            for (size_t v = 0; v < sizeof values / sizeof values[0]; v++) cell(out, values[v]);
            fprintf(out, ",%d\n", point->front);
        }
    }
    return fflush(out) == 0 && !ferror(out);
}
