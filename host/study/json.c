/* json.c: the study as a document; see study.h. Packing NULL fails, so memory that runs out anywhere gives
 * NULL in the end. */
#include "study.h"

#include "base/json_text.h"

#include <math.h>

static json_t *number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *estimate(const BpStudyEstimate *e) {
    return json_pack("{s:o, s:o, s:o}", "value", number(e->value), "low", number(e->low), "high",
                     number(e->high));
}

/* Appends; a list that cannot grow becomes NULL. */
static void append(json_t **list, json_t *entry) {
    if (*list != NULL && json_array_append_new(*list, entry) == 0) return;
    if (*list == NULL) json_decref(entry);
    json_decref(*list);
    *list = NULL;
}

static json_t *point_json(const BpStudyPoint *point) {
    return json_pack("{s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:b}", "samples",
                     (json_int_t)point->samples, "seconds", number(point->seconds), "wall_seconds",
                     number(point->wall_seconds), "device_seconds", number(point->device_seconds),
                     "cpu_seconds", number(point->cpu_seconds), "claimed_nrmse", number(point->claimed),
                     "nrmse", number(point->nrmse), "mse", number(point->mse), "mse_error",
                     number(point->mse_error), "rel_mse", number(point->rel_mse), "front", point->front);
}

static json_t *series_json(const BpStudySeries *series) {
    const BpStudyConfiguration *configuration = &series->configuration;
    json_t *points = json_array();
    for (size_t i = 0; i < series->count; i++) append(&points, point_json(&series->points[i]));
    return json_pack("{s:s, s:s, s:s, s:s, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:{s:o, s:o}, s:o, s:o}",
                     "name", configuration->name, "axis", configuration->axis, "options",
                     configuration->command, "fresnel", bp_study_fresnel_name(configuration->fresnel),
                     "max_depth", (json_int_t)configuration->options.max_depth, "bias",
                     estimate(&series->bias), "bias_square", estimate(&series->bias_square), "change",
                     estimate(&series->change), "change_square", estimate(&series->change_square),
                     "seconds_per_sample", number(series->seconds_per_sample), "time_ratio",
                     estimate(&series->time_ratio), "fit", "floor", number(series->fit_floor), "slope",
                     number(series->fit_slope), "efficiency", number(series->efficiency), "points", points);
}

static json_t *advice_json(const BpStudyResult *result, const BpStudyAdvice *advice) {
    const BpStudyConfiguration *configuration = &result->series[advice->series].configuration;
    char text[512];
    return json_pack(
        "{s:f, s:b, s:o, s:o, s:o, s:b, s:o}", "nrmse", advice->target, "reached", advice->reachable,
        "configuration", advice->reachable ? json_string(configuration->name) : json_null(),
        "samples_per_pixel", number(advice->samples), "seconds", number(advice->seconds), "extrapolated",
        advice->extrapolated, "text", bp_json_text(bp_study_advice_text(result, advice, text, sizeof text)));
}

json_t *bp_study_json(const BpStudyResult *result) {
    const BpCamera *camera = &result->scene->camera;
    const BpDeviceInfo *device = &result->report.device;
    BpSceneInfo info;
    char warning[512];
    bp_scene_info(result->scene, &info);
    bp_study_shortness_text(result, warning, sizeof warning);
    json_t *series = json_array(), *advice = json_array();
    for (size_t s = 0; s < result->count; s++) append(&series, series_json(&result->series[s]));
    for (int t = 0; t < BP_STUDY_TARGETS; t++) append(&advice, advice_json(result, &result->advice[t]));
    return json_pack("{s:s, s:o, s:o, s:i, s:i, s:[i,i], s:{s:o, s:o, s:o}, s:{s:s, s:i, s:I, s:o}, s:o, "
                     "s:f, s:f, s:b, s:o, s:o, s:o}",
                     "version", bp_version(), "scene", bp_json_text(result->scene->path), "title",
                     bp_json_text(info.title), "width", (int)camera->width, "height", (int)camera->height,
                     "advice_size", (int)result->full_width, (int)result->full_height, "device", "platform",
                     bp_json_text(device->platform), "name", bp_json_text(device->name), "driver",
                     bp_json_text(device->driver), "reference", "kind",
                     result->reference_is_kernel ? "kernel in double precision" : "reference tracer",
                     "max_depth", (int)BP_STUDY_DEPTH, "samples_per_pixel",
                     (json_int_t)result->reference_samples, "nrmse", number(result->reference_error),
                     "brightness", number(result->brightness), "budget_seconds", result->budget, "seconds",
                     result->seconds, "cut_short", result->cut_short, "series", series, "advice", advice,
                     "warning", warning[0] == '\0' ? json_null() : json_string(warning));
}
