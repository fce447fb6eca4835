/* check_report.c: see check_report.h. */
#include "check_report.h"

#include "base/format.h"
#include "base/json_text.h"
#include "base/names.h"
#include "base/shown.h"
#include "json_file.h"

#include <math.h>
#include <string.h>

/* JSON has no NaN: what is not known is null. */
static json_t *number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *three(const double *values) {
    return json_pack("[o, o, o]", number(values[0]), number(values[1]), number(values[2]));
}

static json_t *device_json(const BpDeviceInfo *device) {
    return json_pack("{s:i, s:o, s:o, s:o, s:o, s:s}", "number", (int)device->number, "platform",
                     bp_json_text(device->platform), "name", bp_json_text(device->name), "version",
                     bp_json_text(device->version), "driver", bp_json_text(device->driver), "type",
                     bp_device_type_names[device->type]);
}

static json_t *test_json(BpVerdictFamily family, const BpVerdictTest *test) {
    static const char *const channels[] = {"red", "green", "blue"};
    return json_pack("{s:s, s:i, s:b, s:o, s:o, s:s, s:[i, i], s:o, s:o, s:b}", "family",
                     bp_verdict_family_name(family), "tests", (int)test->tests, "rejected",
                     test->z > test->limit, "z", number(test->z), "limit", number(test->limit), "channel",
                     channels[test->channel], "block", (int)test->column, (int)test->row, "kernel",
                     number(test->kernel), "reference", number(test->reference), "by_counts", test->counted);
}

json_t *bp_check_report_json(const BpCheckResult *result) {
    const BpVerdict *v = &result->verdict;
    const BpRenderReport *report = &result->report;
    json_t *tests = json_array();
    for (int f = 0; f < BP_FAMILIES; ++f)
        json_array_append_new(tests, test_json((BpVerdictFamily)f, &v->worst[f]));
    json_t *brightness = json_pack("{s:o, s:o, s:o, s:f, s:b, s:f}", "ratio", number(v->ratio), "low",
                                   number(v->ratio_low), "high", number(v->ratio_high), "confidence", 0.95,
                                   "equivalent", v->equivalent, "margin", BP_VERDICT_MARGIN);
    json_t *settings =
        json_pack("{s:s, s:s, s:s, s:s}", "kernel", bp_kernel_names[report->kernel], "precision",
                  bp_precision_names[report->precision], "math", bp_math_names[report->math], "numerics",
                  bp_numerics_names[report->numerics]);
    return json_pack(
        "{s:o, s:o, s:b, s:f, s:o, s:o, s:{s:o, s:f}, s:o, s:o, s:{s:I, s:I}, s:{s:f, s:f}, s:{s:I, s:I}, "
        "s:{s:f, s:f}, s:{s:o, s:f}}",
        "device", device_json(&report->device), "settings", settings, "agree", v->agree, "level", v->level,
        "tests", tests, "brightness", brightness, "smallest_bias", "value", number(v->smallest_bias), "power",
        BP_VERDICT_POWER, "mean_kernel", three(v->mean_kernel), "mean_reference", three(v->mean_reference),
        "invalid_samples", "kernel", (json_int_t)v->invalid_kernel, "reference",
        (json_int_t)v->invalid_reference, "segments", "kernel", v->segments_kernel, "reference",
        v->segments_reference, "cut_paths", "kernel", (json_int_t)result->cut_kernel, "reference",
        (json_int_t)result->cut_reference, "seconds", "kernel", result->kernel_seconds, "reference",
        result->reference_seconds, "picture", "off", number(v->picture_off), "limit", BP_VERDICT_PICTURE_OFF);
}

json_t *bp_check_report_failure(const BpDeviceInfo *device, const char *message) {
    return json_pack("{s:o, s:o}", "device", device_json(device), "error", bp_json_text(message));
}

json_t *bp_check_report_document(const BpScene *scene, const BpCheckOptions *options, json_t *results) {
    return json_pack("{s:o, s:i, s:i, s:I, s:i, s:o, s:I, s:o}", "scene", bp_json_text(scene->path), "width",
                     (int)scene->camera.width, "height", (int)scene->camera.height, "samples_per_pixel",
                     (json_int_t)options->render.samples_per_pixel, "max_depth",
                     (int)options->render.max_depth, "seed", bp_json_whole(options->render.seed), "spheres",
                     (json_int_t)scene->sphere_count, "results", results);
}

static void table_row(const json_t *entry, FILE *out) {
    const json_t *device = json_object_get(entry, "device");
    fprintf(out, "%3d  %-9s  ", (int)json_integer_value(json_object_get(device, "number")),
            json_object_get(entry, "error") != NULL         ? "BROKEN"
            : json_is_true(json_object_get(entry, "agree")) ? "agree"
                                                            : "DISAGREE");
    const json_t *ratio = json_object_get(json_object_get(entry, "brightness"), "ratio");
    if (json_is_real(ratio))
        fprintf(out, "%.6f  ", json_real_value(ratio));
    else
        fprintf(out, "%8s  ", "-");
    double worst = 0;
    size_t index;
    json_t *test;
    json_array_foreach(json_object_get(entry, "tests"), index, test) {
        worst = fmax(worst, json_real_value(json_object_get(test, "z")) /
                                json_real_value(json_object_get(test, "limit")));
    }
    if (json_object_get(entry, "tests") != NULL)
        fprintf(out, "%6.2f  ", worst);
    else
        fprintf(out, "%6s  ", "-");
    bp_show(json_string_value(json_object_get(device, "name")), false, out);
    fputs(" (", out);
    bp_show(json_string_value(json_object_get(device, "platform")), false, out);
    fputs(")\n", out);
    const char *error = json_string_value(json_object_get(entry, "error"));
    if (error == NULL) return;
    fputs("     ", out);
    bp_show(error, false, out);
    fputc('\n', out);
}

void bp_check_report_table(const json_t *results, FILE *out) {
    fprintf(out, "     verdict    ratio     |z|/limit  device\n");
    size_t index;
    json_t *entry;
    json_array_foreach(results, index, entry) {
        table_row(entry, out);
    }
}
