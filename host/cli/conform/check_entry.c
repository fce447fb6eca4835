/* check_entry.c: see check_entry.h. */
#include "check_entry.h"

#include "base/escape.h"
#include "base/json_text.h"
#include "base/names.h"
#include "cli/output/report_json.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const channels[] = {"red", "green", "blue"};

/* JSON has no NaN: an unknown number is null. */
static json_t *number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *three(const double *values) {
    return json_pack("[o, o, o]", number(values[0]), number(values[1]), number(values[2]));
}

json_t *bp_check_device_json(const BpDeviceInfo *device) {
    return json_pack("{s:i, s:o, s:o, s:o, s:o, s:s}", "number", (int)device->number, "platform",
                     bp_json_text(device->platform), "name", bp_json_text(device->name), "version",
                     bp_json_text(device->version), "driver", bp_json_text(device->driver), "type",
                     bp_device_type_names[device->type]);
}

static json_t *test_json(BpVerdictFamily family, const BpVerdictTest *test) {
    return json_pack("{s:s, s:i, s:b, s:o, s:o, s:s, s:[i, i], s:o, s:o, s:b}", "family",
                     bp_verdict_family_name(family), "tests", (int)test->tests, "rejected",
                     test->z > test->limit, "z", number(test->z), "limit", number(test->limit), "channel",
                     channels[test->channel], "block", (int)test->column, (int)test->row, "kernel",
                     number(test->kernel), "reference", number(test->reference), "by_counts", test->counted);
}

/* The reason why a verdict is not "agree"; "" if it is. */
static void explain(const BpVerdict *v, uint64_t samples, uint64_t asked, char *text, size_t size) {
    text[0] = '\0';
    if (v->conclusion == BP_AGREE) return;
    const BpVerdictTest *worst = NULL;
    for (int f = 0; f < BP_FAMILIES; ++f)
        if (v->worst[f].z > v->worst[f].limit &&
            (worst == NULL || v->worst[f].z / v->worst[f].limit > worst->z / worst->limit))
            worst = &v->worst[f];
    if (v->conclusion == BP_DISAGREE && v->invalid_kernel + v->invalid_reference > 0)
        snprintf(text, size, "%" PRIu64 " samples of the kernel and %" PRIu64 " of the reference are invalid",
                 v->invalid_kernel, v->invalid_reference);
    else if (worst != NULL)
        snprintf(text, size,
                 "%s: |z| is %.2f where %.2f is allowed (%s, %.4g in the kernel, %.4g in the reference)",
                 bp_verdict_family_name((BpVerdictFamily)(worst - v->worst)), worst->z, worst->limit,
                 channels[worst->channel], worst->kernel, worst->reference);
    else if (v->conclusion == BP_DISAGREE)
        snprintf(text, size,
                 "the picture differs by %.1g from the means of its samples, where %.1g is allowed",
                 v->picture_off, BP_VERDICT_PICTURE_OFF);
    else if (!isfinite(v->shown_within))
        snprintf(text, size, "the picture is black or too noisy to show anything");
    else if (samples < asked)
        snprintf(text, size,
                 "brightness is shown to be equal within %.3g %%, not within %.3g %%, as time was up after "
                 "%" PRIu64 " of %" PRIu64 " samples per pixel",
                 100 * v->shown_within, 100 * v->margin, samples, asked);
    else
        snprintf(text, size,
                 "brightness is shown to be equal within %.3g %%, not within %.3g %%; --spp %" PRIu64
                 " would probably settle it",
                 100 * v->shown_within, 100 * v->margin, bp_verdict_samples_needed(v, samples));
}

json_t *bp_check_entry(const BpCheckResult *result, uint64_t samples) {
    const BpVerdict *v = &result->verdict;
    const BpRenderReport *report = &result->report;
    char reason[400];
    json_t *tests = json_array();
    for (int f = 0; f < BP_FAMILIES; ++f)
        if (v->worst[f].tests > 0) json_array_append_new(tests, test_json((BpVerdictFamily)f, &v->worst[f]));
    json_t *brightness =
        json_pack("{s:o, s:o, s:o, s:f, s:o, s:f, s:b}", "ratio", number(v->ratio), "low",
                  number(v->ratio_low), "high", number(v->ratio_high), "confidence", 0.95, "shown_within",
                  number(v->shown_within), "margin", v->margin, "equivalent", v->shown_within <= v->margin);
    json_t *entry = json_pack(
        "{s:o, s:s, s:b, s:b, s:I, s:o, s:f, s:o, s:o, s:{s:o, s:f}, s:o, s:o, s:{s:I, s:I}, s:{s:f, s:f}, "
        "s:{s:I, s:I}, s:{s:f, s:f}, s:{s:o, s:f}}",
        "device", bp_check_device_json(&report->device), "verdict", bp_conclusion_name(v->conclusion),
        "agree", v->conclusion == BP_AGREE, "timed_out", result->timed_out, "samples_per_pixel",
        (json_int_t)result->samples_per_pixel, "settings", bp_report_settings(report), "level", v->level,
        "tests", tests, "brightness", brightness, "smallest_bias", "value", number(v->smallest_bias), "power",
        BP_VERDICT_POWER, "mean_kernel", three(v->mean_kernel), "mean_reference", three(v->mean_reference),
        "invalid_samples", "kernel", (json_int_t)v->invalid_kernel, "reference",
        (json_int_t)v->invalid_reference, "segments", "kernel", v->segments_kernel, "reference",
        v->segments_reference, "cut_paths", "kernel", (json_int_t)result->cut_kernel, "reference",
        (json_int_t)result->cut_reference, "seconds", "kernel", result->kernel_seconds, "reference",
        result->reference_seconds, "picture", "off", number(v->picture_off), "limit", BP_VERDICT_PICTURE_OFF);
    explain(v, result->samples_per_pixel, samples, reason, sizeof reason);
    if (reason[0] != '\0' && json_object_set_new(entry, "reason", json_string(reason)) != 0) {
        json_decref(entry);
        return NULL;
    }
    return entry;
}

static json_t *without_result(const BpDeviceInfo *device, const char *verdict, const char *reason) {
    return json_pack("{s:o, s:s, s:b, s:o}", "device", bp_check_device_json(device), "verdict", verdict,
                     "agree", false, "reason", bp_json_text(reason));
}

json_t *bp_check_entry_inconclusive(const BpDeviceInfo *device, const char *reason) {
    return without_result(device, "inconclusive", reason);
}

json_t *bp_check_entry_failed(const BpDeviceInfo *device, const char *reason) {
    json_t *entry = without_result(device, "failed", reason);
    /* The member that scripts look for if a device has no result. */
    if (json_object_set_new(entry, "error", bp_json_text(reason)) == 0) return entry;
    json_decref(entry);
    return NULL;
}

const char *bp_check_text(const json_t *object, const char *key) {
    const char *text = json_string_value(json_object_get(object, key));
    return text != NULL ? text : "";
}

const char *bp_check_label(const json_t *scene, char *text, size_t size) {
    const bool lights =
        strcmp(bp_check_text(scene, BP_CHECK_SAMPLING), bp_light_sampling_names[BP_LIGHT_SAMPLING_ON]) == 0;
    const bool caustics =
        strcmp(bp_check_text(scene, BP_CHECK_CAUSTICS), bp_caustics_names[BP_CAUSTICS_ON]) == 0;
    snprintf(text, size, "%s%s", bp_check_text(scene, "scene"),
             caustics ? " (caustics sampled)"
             : lights ? " (lights sampled)"
                      : "");
    return text;
}

const char *bp_check_device_text(const json_t *entry, const char *key) {
    return bp_check_text(json_object_get(entry, "device"), key);
}

const char *bp_check_device_title(const json_t *entry, char *text, size_t size) {
    char plain[640];
    snprintf(plain, sizeof plain, "%s (%s, driver %s)", bp_check_device_text(entry, "name"),
             bp_check_device_text(entry, "platform"), bp_check_device_text(entry, "driver"));
    return bp_escape(plain, text, size);
}

void bp_check_count(const json_t *entry, BpCheckCounts *counts) {
    const char *verdict = bp_check_text(entry, "verdict");
    if (strcmp(verdict, "agree") == 0)
        ++counts->agree;
    else if (strcmp(verdict, "disagree") == 0)
        ++counts->disagree;
    else if (strcmp(verdict, "inconclusive") == 0)
        ++counts->inconclusive;
    else if (strcmp(verdict, "skipped") == 0)
        ++counts->skipped;
    else
        ++counts->failed;
}

const char *bp_check_overall(const BpCheckCounts *counts) {
    if (counts->disagree > 0) return "disagree";
    if (counts->failed > 0) return "failed";
    if (counts->inconclusive > 0 || counts->agree == 0) return "inconclusive";
    return "agree";
}
