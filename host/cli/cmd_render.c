/* cmd_render.c: `ballpark render`.
 *
 * In:    a scene's file, options.   Out: its picture, statistics, a summary.
 * Knows: the order of the steps.    Does not know: how any of them is done. */
#include "commands.h"

#include "base/clock.h"
#include "base/format.h"
#include "base/plural.h"
#include "base/shown.h"
#include "files_apart.h"
#include "film/adaptive.h"
#include "json_file.h"
#include "render/stop_rule.h"
#include "render_loop.h"
#include "result_file.h"
#include "setup.h"
#include "stats.h"
#include "terminal.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void init_rule(const BpCommandLine *line, const BpScene *scene, const BpRenderOptions *options,
                      BpStopRule *rule) {
    const bool has_error = bp_option_given(line, BP_OPTION_ERROR),
               has_time = bp_option_given(line, BP_OPTION_TIME);
    bp_stop_rule_defaults(scene, options, rule);
    /* The scene's own count is no rule once another one is given; --spp is. */
    if ((has_error || has_time) && !bp_option_given(line, BP_OPTION_SPP)) {
        rule->samples_max = BP_SPP_MAX;
        if (rule->samples_max > BP_SAMPLE_NUMBERS - options->first_sample)
            rule->samples_max = BP_SAMPLE_NUMBERS - options->first_sample;
    }
    if (has_error) rule->error = line->error_percent / 100.0;
    if (has_time) rule->seconds = line->time_seconds;
}

static BpStatus check_adaptive(const BpCommandLine *line, const BpStopRule *rule, BpError *err) {
    if (!line->adaptive || rule->samples_max >= BP_ADAPTIVE_MEAN_MIN) return BP_OK;
    return bp_fail(
        err, BP_ERR_USAGE,
        "--adaptive with %" PRIu64 " sample%s a pixel: the first %u go to every pixel, so that only more "
        "can go where the error is; ask for --spp %u at least, or for --error or --time",
        rule->samples_max, rule->samples_max == 1 ? "" : "s", BP_ADAPTIVE_FIRST, BP_ADAPTIVE_MEAN_MIN);
}

static void print_summary(const BpRunResult *result, const BpStopRule *rule, const BpLoopEnd *end) {
    const BpRenderReport *report = &result->report;
    char samples[32], text[32], all[32], rate[32], count[64];
    BpSceneInfo info;
    bp_scene_info(result->scene, &info);
    snprintf(count, sizeof count, "%" PRIu64 " sample%s a pixel", result->samples_per_pixel,
             bp_plural(result->samples_per_pixel));
    if (result->samples_per_pixel == 0) snprintf(count, sizeof count, "less than one sample a pixel");
    const char *more_samples = "";
    if (result->options->adaptive) {
        uint64_t least, most;
        double mean;
        bp_film_sample_counts(result->film, &least, &most, &mean);
        snprintf(count, sizeof count, "%.1f samples a pixel (%" PRIu64 " to %" PRIu64 ")", mean, least, most);
    } else if (result->film->partial && result->samples_per_pixel > 0) {
        more_samples = " and part of another round";
    }
    bp_show(result->output, false, stderr);
    fprintf(stderr, ": %" PRIu32 "x%" PRIu32 ", %s%s, error %s\n", info.width, info.height, count,
            more_samples, bp_format_percent(result->nrmse, text, sizeof text));
    /* The first launch, in which a driver may compile, says nothing about the rate. */
    const double tracing = fmax(end->seconds - report->first_launch_seconds, 1.0e-9);
    fprintf(stderr, "%s sample%s traced in %s (%s/s), %s in all",
            bp_format_count((double)report->samples, samples, sizeof samples), bp_plural(report->samples),
            bp_format_seconds(tracing, text, sizeof text),
            bp_format_count((double)report->samples / tracing, rate, sizeof rate),
            bp_format_seconds(bp_clock_seconds() - result->times.start, all, sizeof all));
    const double more = 3.0 * tracing; /* half the error takes four times the samples */
    if (result->nrmse > 0.0)
        fprintf(stderr, "; half the error: %s more", bp_format_seconds(more, text, sizeof text));
    else if (isnan(result->nrmse))
        fprintf(stderr, "; an error needs %s",
                result->samples_per_pixel < 2 ? "two samples a pixel at least"
                : report->invalid_samples > 0 ? "finite samples in every pixel"
                                              : "a picture that is not black");
    fprintf(stderr, "\n");
    if (rule->error > 0.0 && end->reason == BP_STOP_SAMPLES)
        fprintf(stderr,
                "the error asked for was not reached: the limit of %" PRIu64 " sample%s a pixel came first\n",
                rule->samples_max, bp_plural(rule->samples_max));
    if (end->reason == BP_STOP_INVALID)
        fprintf(
            stderr,
            "a pixel has hardly any sample that is finite, so the picture has no error and --error cannot be "
            "reached\n");
    if (rule->error > 0.0 && end->reason == BP_STOP_TIME)
        fprintf(stderr, "the error asked for was not reached in time\n");
    /* Nothing seen in n independent samples: below 3/n with 95 % confidence (Hanley, Lippman-Hand 1983). */
    if (end->reason == BP_STOP_BLACK)
        fprintf(
            stderr,
            "the picture is black, so --error has nothing to go by: of %s sample%s none brought light, hence "
            "fewer than %.1g do\n",
            samples, bp_plural(report->samples), 3.0 / (double)report->samples);
    if (end->reason == BP_STOP_CONSTANT)
        fprintf(
            stderr,
            "the samples of every pixel agree, so --error has nothing to wait for: of %s sample%s none stood "
            "out, hence fewer than %.1g do\n",
            samples, bp_plural(report->samples), 3.0 / (double)report->samples);
    if (report->cut_paths > 0)
        fprintf(stderr, "%s of the paths were cut at %" PRIu32 " segment%s (--depth) and count as black\n",
                bp_format_percent((double)report->cut_paths / (double)report->samples, text, sizeof text),
                result->options->max_depth, bp_plural(result->options->max_depth));
    bp_result_warn(result->film);
    if (report->invalid_samples > 0)
        fprintf(stderr, "warning: %" PRIu64 " sample%s not finite; left out of the picture\n",
                report->invalid_samples, report->invalid_samples == 1 ? " was" : "s were");
}

/* Picture, statistics and summary of a render that has stopped. */
static BpStatus deliver(const BpCommandLine *line, const BpResultFile *file, const BpStopRule *rule,
                        const BpLoopEnd *end, BpRender *render, BpRunResult *result, BpError *err) {
    BP_TRY(bp_render_read_film(render, &result->film, err));
    bp_render_report(render, &result->report);
    result->samples_per_pixel = bp_render_samples_done(render);
    result->stopped_by = end->reason;
    result->nrmse = bp_film_nrmse(result->film);
    /* What little is left says nothing of the scene, so no picture of it is written. */
    const uint64_t samples = result->report.samples, invalid = result->report.invalid_samples;
    if (invalid > samples / 2)
        return bp_fail(
            err, BP_ERR_LIMIT,
            "%" PRIu64 " of %" PRIu64 " sample%s not finite, so there is no picture, and %s was not "
            "written: the scene's numbers may be too large or too small for %s precision; %schoose another "
            "unit of length, or ask ballpark check which of its pixels are wrong",
            invalid, samples, samples == 1 ? " is" : "s are", result->output,
            result->options->precision == BP_PRECISION_DOUBLE ? "double" : "single",
            result->options->precision == BP_PRECISION_DOUBLE ? "" : "use --precision double, ");
    const double write_start = bp_clock_seconds();
    BP_TRY(bp_result_write(line, file, result->film, render, (BpTransfer)result->film->transfer, err));
    result->times.write = bp_clock_seconds() - write_start;
    if (line->stats != NULL) BP_TRY(bp_json_write(bp_stats_json(result), line->stats, err));
    if (!line->quiet) print_summary(result, rule, end);
    if (end->reason == BP_STOP_TIME && result->samples_per_pixel == 0)
        return bp_fail(
            err, BP_ERR_LIMIT,
            "--time %g was over before every pixel had a sample, so parts of %s are black: allow more "
            "time, or ask for a smaller --width or --depth",
            rule->seconds, result->output);
    if (end->reason != BP_STOP_NOT_YET) return BP_OK;
    return bp_fail(err, BP_ERR_INTERRUPTED,
                   "interrupted after %" PRIu64 " of %" PRIu64 " sample%s a pixel%s; %s shows what there is",
                   result->samples_per_pixel, rule->samples_max, bp_plural(rule->samples_max),
                   result->samples_per_pixel == 0 ? " (some pixels have one, the others are black)" : "",
                   result->output);
}

BpStatus bp_command_render(const BpCommandLine *line, BpError *err) {
    BpStatus status = BP_OK;
    BpScene *scene = NULL;
    BpRender *render = NULL;
    BpDeviceInfo *devices = NULL;
    BpWaiting *waiting = NULL;
    BpResultFile file;
    BpRenderOptions options;
    BpSceneInfo info;
    BpStopRule rule;
    BpLoopEnd end;
    BpRunResult result = {
        .scene_path = line->operands[0], .times.start = bp_clock_seconds(), .options = &options};

    BP_TRY(bp_result_choose(line, line->operands[0], &file, err));
    result.output = bp_result_name(&file);

    waiting = bp_waiting_begin(line->quiet, "reading %s", line->operands[0]);
    BP_TRY_GOTO(status, bp_setup_scene(line, line->operands[0], &scene, err), done);
    bp_waiting_end(waiting);
    waiting = NULL;
    BP_TRY_GOTO(status, bp_files_check_scene(line, file.path, scene, err), done);
    result.scene = scene;
    result.times.load = bp_clock_seconds() - result.times.start;
    bp_scene_info(scene, &info);
    BP_TRY_GOTO(status, bp_setup_options(line, scene, &options, err), done);
    bp_setup_warn(line, scene, options.precision);
    /* Less noise in the same time on every scene that was measured: docs/ACCURACY.md. */
    if (!bp_option_given(line, BP_OPTION_SAMPLER)) options.sampler = BP_SAMPLER_SOBOL;
    options.adaptive = line->adaptive;
    options.features = file.format == BP_FORMAT_EXR;
    init_rule(line, scene, &options, &rule);
    BP_TRY_GOTO(status, check_adaptive(line, &rule, err), done);
    options.samples_per_pixel = bp_stop_first(&rule);

    BP_TRY_GOTO(status, bp_setup_devices(line, &devices, &result.device_count, err), done);
    waiting = bp_waiting_begin(line->quiet, "preparing %zu sphere%s and the kernel for %s", info.spheres,
                               bp_plural(info.spheres), devices[0].name);
    BP_TRY_GOTO(status, bp_setup_self_test(line, devices, result.device_count, err), done);
    BP_TRY_GOTO(status, bp_render_create(scene, &options, devices, result.device_count, &render, err), done);
    bp_waiting_end(waiting);
    waiting = NULL;

    BP_TRY_GOTO(status, bp_render_loop(render, &rule, line->quiet, &end, err), done);
    status = deliver(line, &file, &rule, &end, render, &result, err);
done:
    bp_waiting_end(waiting);
    bp_render_destroy(&render);
    free(devices);
    bp_scene_destroy(&scene);
    return status;
}
