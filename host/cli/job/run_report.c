/* run_report.c: see run_report.h. */
#include "run_report.h"

#include "base/clock.h"
#include "base/format.h"
#include "base/json_text.h"
#include "base/names.h"
#include "base/plural.h"
#include "cli/output/json_file.h"
#include "cli/output/report_json.h"
#include "cli/output/result_file.h"
#include "cli/terminal/page.h"
#include "scene/in_view.h"
#include "unseen_text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* ---- --stats ----------------------------------------------------------------------------------------- */

/* JSON has no NaN. */
static json_t *json_number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *device_json(const BpDeviceInfo *info) {
    return json_pack("{s:o, s:o, s:o, s:s}", "platform", bp_json_text(info->platform), "name",
                     bp_json_text(info->name), "driver", bp_json_text(info->driver), "type",
                     bp_device_type_names[info->type]);
}

/* How the first device shares out samples; null where no calibration has decided that. */
static json_t *calibration_json(const BpRenderReport *report) {
    if (report->calibration.form == BP_KERNEL_AUTO) return json_null();
    json_t *root = bp_calibration_json(&report->calibration);
    return bp_json_join(root, json_pack("{s:f}", "seconds", report->calibration_seconds));
}

static json_t *effects_json(const BpEffects *effects) {
    json_t *names = json_array();
    for (int e = 0; e < BP_EFFECT_COUNT && names != NULL; ++e)
        if (bp_effects_has(effects->bits, (BpEffect)e))
            json_array_append_new(names, json_string(bp_effect_name((BpEffect)e)));
    return names;
}

static json_t *seconds_json(const BpRunResult *result) {
    const BpRenderReport *report = &result->report;
    const BpRunTimes *times = &result->times;
    double waiting, adding;
    bp_comm_times(result->comm, &waiting, &adding);
    return json_pack("{s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "total",
                     bp_clock_seconds() - times->start, "load", times->load, "tree", report->tree_seconds,
                     "kernel_build", report->kernel_build_seconds, "trace", report->trace_seconds, "write",
                     times->write, "pack", report->pack_seconds, "first_launch", report->first_launch_seconds,
                     "device", report->device_seconds, "checkpoints", result->checkpoint->seconds,
                     "ranks_waiting", waiting, "ranks_adding", adding);
}

json_t *bp_run_stats(const BpRunResult *result) {
    const BpRenderReport *report = &result->report;
    const BpRenderOptions *options = result->options;
    BpSceneInfo info;
    bp_scene_info(result->scene, &info);
    double mean[3];
    bp_film_mean(result->film, mean);
    json_t *root =
        json_pack("{s:o, s:i, s:i, s:I, s:I, s:o, s:I, s:o, s:o}", "scene", bp_json_text(result->scene_path),
                  "width", (int)info.width, "height", (int)info.height, "samples_per_pixel",
                  (json_int_t)result->samples_per_pixel, "max_depth", (json_int_t)options->max_depth, "seed",
                  bp_json_whole(options->seed), "spheres", (json_int_t)info.spheres, "device",
                  device_json(&report->device), "effects", effects_json(&report->effects));
    json_t *counts = json_pack(
        "{s:o, s:I, s:I, s:[f,f,f], s:o, s:I, s:I, s:I, s:I, s:I, s:I, s:f, s:o}", "seconds",
        seconds_json(result), "samples", (json_int_t)report->samples, "rays", (json_int_t)report->segments,
        "mean_radiance", mean[0], mean[1], mean[2], "nrmse", json_number(result->claim.nrmse),
        "invalid_samples", (json_int_t)report->invalid_samples,
#define MEMBER(member, tally, words) #member, (json_int_t)report->member,
        BP_INVALID_LIST(MEMBER)
#undef MEMBER
            "cut_paths",
        (json_int_t)report->truncated_paths, "shadow_rays", (json_int_t)report->shadow_rays, "unseen_part",
        result->claim.unseen_part, "unseen", bp_unseen_json(&result->unseen, result->claim.luminance));
    json_t *run = json_pack("{s:I, s:I, s:s, s:o, s:I, s:i, s:b, s:o, s:s, s:i, s:i, s:I, s:I, s:I, s:s}",
                            "triangles", (json_int_t)info.triangles, "capsules", (json_int_t)info.capsules,
                            "acceleration", bp_acceleration_name(report->acceleration), "output",
                            bp_json_text(result->output), "first_sample", (json_int_t)options->first_sample,
                            "replicates", (int)result->film->replicates, "partial", result->film->partial,
                            "rounding", json_number(bp_film_rounding(result->film)), "stopped_by",
                            bp_stop_reason_name(result->stopped_by), "devices", (int)result->device_count,
                            "ranks", (int)bp_comm_size(result->comm), "device_bytes",
                            (json_int_t)report->device_bytes, "scene_bytes", (json_int_t)report->scene_bytes,
                            "checkpoints", (json_int_t)result->checkpoint->written, "version", bp_version());
    uint64_t least, most;
    double mean_samples;
    bp_film_sample_counts(result->film, &least, &most, &mean_samples);
    json_t *pixels = json_pack("{s:b, s:I, s:f, s:I, s:o}", "adaptive", options->adaptive, "samples_min",
                               (json_int_t)least, "samples_mean", mean_samples, "samples_max",
                               (json_int_t)most, "calibration", calibration_json(report));
    root = bp_json_join(root, bp_report_settings(report));
    root = bp_json_join(root, counts);
    root = bp_json_join(root, run);
    return bp_json_join(root, pixels);
}

/* ---- the summary --------------------------------------------------------------------------------------- */

/* Why the render stopped, where that is not what was asked for. */
static void say_stop(const BpCommandLine *line, const BpRunResult *result, const BpStopRule *rule,
                     const BpLoopEnd *end) {
    const uint64_t traced = result->report.samples;
    char samples[32];
    bp_format_count((double)traced, samples, sizeof samples);
    if (rule->error > 0.0 && end->reason == BP_STOP_SAMPLES)
        bp_say(line,
               "noise is still above --error: the limit of %" PRIu64 " sample%s per pixel was reached first",
               rule->samples_max, bp_plural(rule->samples_max));
    if (end->reason == BP_STOP_INVALID)
        bp_say(line, "almost no sample of some pixel is valid, so noise cannot be estimated and --error "
                     "cannot be reached");
    if (rule->error > 0.0 && end->reason == BP_STOP_TIME)
        bp_say(line, "noise is still above --error: time ran out");
    /* Nothing seen in n independent samples: below 3/n with 95 % confidence (Hanley, Lippman-Hand 1983). */
    if (end->reason == BP_STOP_BLACK)
        bp_say(
            line,
            "the picture is black, so noise cannot be estimated: none of %s sample%s found light, so fewer "
            "than 1 in %.0f do",
            samples, bp_plural(traced), (double)traced / 3.0);
    if (end->reason == BP_STOP_CONSTANT)
        bp_say(line,
               "all samples of each pixel are equal, so there is no noise to reduce: none of %s sample%s "
               "differs, so fewer than 1 in %.0f do",
               samples, bp_plural(traced), (double)traced / 3.0);
}

/* A picture of the background alone is rarely what was meant. Paths of one segment met nothing, or ended
 * where they met something. */
static void say_emptiness(const BpCommandLine *line, const BpRunResult *result) {
    const BpRenderReport *report = &result->report;
    const BpScene *scene = result->scene;
    char samples[32];
    if (report->samples == 0 || report->segments != report->samples || report->truncated_paths > 0) return;
    if (bp_scene_shapes(scene) == 0)
        bp_say(line, "the scene has no spheres: the picture shows the background alone");
    else if (!bp_scene_has_shape_in_view(scene) || bp_scene_always_scatters(scene))
        bp_say(line,
               "the picture shows no %s: %s sample%s saw the background alone; check \"lookfrom\", "
               "\"lookat\" and \"vfov\" of the camera",
               bp_scene_noun(scene), bp_format_count((double)report->samples, samples, sizeof samples),
               bp_plural(report->samples));
}

/* A sphere around the camera shuts out all light, unless light comes through it: glass, or a boundary. */
static bool is_inside_a_sphere(const BpScene *scene) {
    const double *from = scene->camera.lookfrom;
    for (size_t i = 0; i < scene->sphere_count; i++) {
        const BpSphere *sphere = &scene->spheres[i];
        const double x = from[0] - sphere->center[0], y = from[1] - sphere->center[1],
                     z = from[2] - sphere->center[2];
        const BpMaterialKind kind = scene->materials[sphere->material].kind;
        if (!bp_material_is(kind, BP_HAS_INSIDE) && x * x + y * y + z * z < sphere->radius * sphere->radius)
            return true;
    }
    return false;
}

/* Light of which most of the noise is a claim, since samples have hardly found it. */
static void say_unseen(const BpCommandLine *line, const BpRunResult *result) {
    if (!(result->claim.unseen_part > 0.5) || line->quiet) return;
    BpPage page;
    bp_page_begin(&page, stderr);
    fputs("most of this noise is light that samples have hardly found yet. ", page.text);
    bp_unseen_print(result->scene, &result->unseen, result->claim.luminance,
                    result->report.effects.caustics && line->caustics == BP_CAUSTICS_OFF, page.text);
    fputc('\n', page.text);
    bp_page_end(&page, line, stderr);
}

void bp_run_print_summary(const BpCommandLine *line, const BpRunResult *result, const BpStopRule *rule,
                          const BpLoopEnd *end) {
    const BpRenderReport *report = &result->report;
    char samples[32], text[32], all[32], rate[32], count[64];
    BpSceneInfo info;
    bp_scene_info(result->scene, &info);
    snprintf(count, sizeof count, "%" PRIu64 " sample%s per pixel", result->samples_per_pixel,
             bp_plural(result->samples_per_pixel));
    if (result->samples_per_pixel == 0) snprintf(count, sizeof count, "less than one sample per pixel");
    const char *more_samples = "";
    if (result->options->adaptive) {
        uint64_t least, most;
        double mean;
        bp_film_sample_counts(result->film, &least, &most, &mean);
        snprintf(count, sizeof count, "%.1f samples per pixel (%" PRIu64 " to %" PRIu64 ")", mean, least,
                 most);
    } else if (result->film->partial && result->samples_per_pixel > 0) {
        more_samples = " and part of the next";
    }
    bp_say(line, "%s: %" PRIu32 "x%" PRIu32 ", %s%s, noise %s", result->output, info.width, info.height,
           count, more_samples, bp_format_percent(result->claim.nrmse, text, sizeof text));
    /* The first launch, in which a driver may compile, says nothing about the rate. */
    const double tracing = fmax(end->seconds - report->first_launch_seconds, 1.0e-9);
    const uint64_t own = report->samples - report->resumed_samples;
    bp_say(line, "%s sample%s traced in %s (%s/s), %s in total",
           bp_format_count((double)own, samples, sizeof samples), bp_plural(own),
           bp_format_seconds(tracing, text, sizeof text),
           bp_format_count((double)own / tracing, rate, sizeof rate),
           bp_format_seconds(bp_clock_seconds() - result->times.start, all, sizeof all));
    say_unseen(line, result);
    /* Half the noise takes four times the samples. */
    const double more = own > 0 ? 3.0 * tracing * (double)report->samples / (double)own : NAN;
    if (result->claim.nrmse > 0.0 && own > 0)
        bp_say(line, "halving the noise: %s more", bp_format_seconds(more, text, sizeof text));
    else if (isnan(result->claim.nrmse))
        bp_say(line, "%s",
               result->samples_per_pixel < 2 ? "estimating noise needs at least two samples per pixel"
               : report->invalid_samples > 0 ? "estimating noise needs valid samples in every pixel"
               : is_inside_a_sphere(result->scene)
                   ? "the picture is black, so its noise is unknown: the camera is inside a sphere; check "
                     "\"lookfrom\" and the spheres"
                   : "the picture is black, so its noise is unknown: nothing that the camera sees is lit; "
                     "check \"background\", and \"emit\" of the materials");
    if (report->calibration_seconds > 0) {
        char words[BP_CALIBRATION_TEXT];
        bp_say(line, "calibrated %s in %s, once: %s", report->device.name,
               bp_format_seconds(report->calibration_seconds, text, sizeof text),
               bp_calibration_text(&report->calibration, words));
    }
    say_stop(line, result, rule, end);
    say_emptiness(line, result);
    if (report->truncated_paths > 0)
        bp_say(
            line, "%s of the paths were cut off at %" PRIu32 " segment%s (--depth) and counted as black",
            bp_format_percent((double)report->truncated_paths / (double)report->samples, text, sizeof text),
            result->options->max_depth, bp_plural(result->options->max_depth));
    if (result->scene->medium != 0 && 2 * report->truncated_paths > report->samples)
        bp_say(
            line,
            "the \"medium\" of the whole scene has no end, so no light of the sky comes through it; put it "
            "into a large sphere of an \"interface\" material instead, as its \"interior\"");
    bp_result_warn(line, result->film);
    char causes[BP_INVALID_TEXT_SIZE];
    if (report->invalid_samples > 0)
        bp_say(line, "warning: %" PRIu64 " sample%s invalid%s and left out of the picture",
               result->film->invalid_samples, result->film->invalid_samples == 1 ? " was" : "s were",
               bp_film_invalid_causes(result->film, causes));
}

BpStatus bp_run_interrupted(const BpCommandLine *line, const BpStopRule *rule, const BpLoopEnd *end,
                            const BpCheckpoint *checkpoint, const BpRunResult *result, BpError *err) {
    char command[8192];
    const bool kept = checkpoint->is_result || checkpoint->written > 0;
    bp_fail(err, BP_ERR_INTERRUPTED,
            "interrupted after %" PRIu64 " of %" PRIu64
            " sample%s per pixel%s; %s holds the picture so far%s",
            result->samples_per_pixel, rule->samples_max, bp_plural(rule->samples_max),
            result->samples_per_pixel == 0 ? " (pixels without a sample are black)" : "", result->output,
            kept                          ? "; this command continues it:"
            : checkpoint->path[0] != '\0' ? ""
                                          : "; with --checkpoint SECONDS, another run could continue it");
    if (kept)
        bp_error_attach(err, bp_checkpoint_command(line, checkpoint, rule->seconds - end->seconds, command,
                                                   sizeof command));
    return BP_ERR_INTERRUPTED;
}
