/* stats.c: see stats.h. */
#include "stats.h"

#include "base/clock.h"
#include "base/json_text.h"
#include "base/names.h"
#include "json_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* JSON has no NaN. */
static json_t *json_number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *device_json(const BpDeviceInfo *info) {
    return json_pack("{s:o, s:o, s:o, s:s}", "platform", bp_json_text(info->platform), "name",
                     bp_json_text(info->name), "driver", bp_json_text(info->driver), "type",
                     bp_device_type_names[info->type]);
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
    return json_pack("{s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "total",
                     bp_clock_seconds() - times->start, "load", times->load, "tree", report->tree_seconds,
                     "kernel_build", report->kernel_build_seconds, "trace", report->trace_seconds, "write",
                     times->write, "pack", report->pack_seconds, "first_launch", report->first_launch_seconds,
                     "device", report->device_seconds);
}

json_t *bp_stats_json(const BpRunResult *result) {
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
    json_t *choices = json_pack("{s:s, s:s, s:s, s:s}", "kernel", bp_kernel_names[report->kernel],
                                "precision", bp_precision_names[report->precision], "math",
                                bp_math_names[report->math], "sampler", bp_sampler_names[report->sampler]);
    json_t *counts =
        json_pack("{s:o, s:I, s:I, s:[f,f,f], s:o, s:I, s:I}", "seconds", seconds_json(result), "samples",
                  (json_int_t)report->samples, "rays", (json_int_t)report->segments, "mean_radiance", mean[0],
                  mean[1], mean[2], "nrmse", json_number(result->nrmse), "invalid_samples",
                  (json_int_t)report->invalid_samples, "cut_paths", (json_int_t)report->cut_paths);
    json_t *run =
        json_pack("{s:s, s:o, s:I, s:i, s:b, s:o, s:s, s:i, s:I, s:I, s:s}", "numerics",
                  bp_numerics_names[report->numerics], "output", bp_json_text(result->output), "first_sample",
                  (json_int_t)options->first_sample, "replicates", (int)result->film->replicates, "partial",
                  result->film->partial, "rounding", json_number(bp_film_rounding(result->film)),
                  "stopped_by", bp_stop_reason_name(result->stopped_by), "devices", (int)result->device_count,
                  "device_bytes", (json_int_t)report->device_bytes, "scene_bytes",
                  (json_int_t)report->scene_bytes, "version", bp_version());
    uint64_t least, most;
    double mean_samples;
    bp_film_sample_counts(result->film, &least, &most, &mean_samples);
    json_t *pixels =
        json_pack("{s:b, s:I, s:f, s:I}", "adaptive", options->adaptive, "samples_min", (json_int_t)least,
                  "samples_mean", mean_samples, "samples_max", (json_int_t)most);
    const bool whole = root != NULL && choices != NULL && counts != NULL && run != NULL && pixels != NULL &&
                       json_object_update(root, choices) == 0 && json_object_update(root, counts) == 0 &&
                       json_object_update(root, run) == 0 && json_object_update(root, pixels) == 0;
    json_decref(choices);
    json_decref(counts);
    json_decref(run);
    json_decref(pixels);
    if (whole) return root;
    json_decref(root);
    return NULL;
}
