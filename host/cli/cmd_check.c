/* cmd_check.c: `ballpark check`.
 *
 * In:    a scene, devices.   Out: whether kernel and reference agree; a table, a document, a picture.
 * Knows: the check, devices, child processes, JSON.   Does not know: statistics, OpenCL. */
#include "commands.h"

#include "base/format.h"
#include "base/json_text.h"
#include "base/names.h"
#include "base/output_file.h"
#include "base/plural.h"
#include "base/shown.h"
#include "check/check.h"
#include "child_process.h"
#include "file_conflicts.h"
#include "image/image.h"
#include "interrupt.h"
#include "json_file.h"
#include "report_json.h"
#include "setup.h"
#include "terminal.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the report -------------------------------------------------------------------------------------- */

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

/* One device's result; NULL when out of memory. */
static json_t *result_json(const BpCheckResult *result) {
    const BpVerdict *v = &result->verdict;
    const BpRenderReport *report = &result->report;
    json_t *tests = json_array();
    for (int f = 0; f < BP_FAMILIES; ++f)
        if (v->worst[f].tests > 0) json_array_append_new(tests, test_json((BpVerdictFamily)f, &v->worst[f]));
    json_t *brightness = json_pack("{s:o, s:o, s:o, s:f, s:b, s:f}", "ratio", number(v->ratio), "low",
                                   number(v->ratio_low), "high", number(v->ratio_high), "confidence", 0.95,
                                   "equivalent", v->equivalent, "margin", BP_VERDICT_MARGIN);
    return json_pack(
        "{s:o, s:o, s:b, s:f, s:o, s:o, s:{s:o, s:f}, s:o, s:o, s:{s:I, s:I}, s:{s:f, s:f}, s:{s:I, s:I}, "
        "s:{s:f, s:f}, s:{s:o, s:f}}",
        "device", device_json(&report->device), "settings", bp_report_settings(report), "agree", v->agree,
        "level", v->level, "tests", tests, "brightness", brightness, "smallest_bias", "value",
        number(v->smallest_bias), "power", BP_VERDICT_POWER, "mean_kernel", three(v->mean_kernel),
        "mean_reference", three(v->mean_reference), "invalid_samples", "kernel",
        (json_int_t)v->invalid_kernel, "reference", (json_int_t)v->invalid_reference, "segments", "kernel",
        v->segments_kernel, "reference", v->segments_reference, "cut_paths", "kernel",
        (json_int_t)result->cut_kernel, "reference", (json_int_t)result->cut_reference, "seconds", "kernel",
        result->kernel_seconds, "reference", result->reference_seconds, "picture", "off",
        number(v->picture_off), "limit", BP_VERDICT_PICTURE_OFF);
}

/* One device that no result was returned: `message` says why. */
static json_t *failure_json(const BpDeviceInfo *device, const char *message) {
    return json_pack("{s:o, s:o}", "device", device_json(device), "error", bp_json_text(message));
}

/* The document: the scene, the settings and the results (an array, which it takes over). */
static json_t *document_json(const BpScene *scene, const BpCheckOptions *options, json_t *results) {
    return json_pack("{s:o, s:i, s:i, s:I, s:i, s:o, s:I, s:o}", "scene", bp_json_text(scene->path), "width",
                     (int)scene->camera.width, "height", (int)scene->camera.height, "samples_per_pixel",
                     (json_int_t)options->render.samples_per_pixel, "max_depth",
                     (int)options->render.max_depth, "seed", bp_json_whole(options->render.seed), "spheres",
                     (json_int_t)scene->sphere_count, "results", results);
}

static void table_row(const json_t *entry, FILE *out) {
    const json_t *device = json_object_get(entry, "device");
    fprintf(out, "%3d  %-9s  ", (int)json_integer_value(json_object_get(device, "number")),
            json_object_get(entry, "error") != NULL         ? "FAILED"
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

/* A table of all results, a line each. */
static void print_table(const json_t *results, FILE *out) {
    fprintf(out, "     verdict    ratio     |z|/limit  device\n");
    size_t index;
    json_t *entry;
    json_array_foreach(results, index, entry) {
        table_row(entry, out);
    }
}

typedef struct CheckTask {
    const BpCommandLine *line;
    const BpScene *scene;
    const BpCheckOptions *options;
    const BpDeviceInfo *device;
    const char *map; /* file, or NULL */
    BpFormat map_format;
} CheckTask;

static void show_progress(const BpCheckProgress *progress) {
    char left[32], text[80] = "";
    const char *part = progress->reference ? "reference" : "kernel";
    if (!progress->finished) snprintf(text, sizeof text, "%s %3.0f %%", part, 100 * progress->done);
    if (!progress->finished && progress->done > 0.02) /* before, the time left is a guess */
        snprintf(text, sizeof text, "%s %3.0f %%  %s left", part, 100 * progress->done,
                 bp_format_seconds(progress->seconds * (1 / progress->done - 1), left, sizeof left));
    bp_terminal_show(text);
}

static BpStatus write_map(const CheckTask *task, const BpCheckResult *result, BpError *err) {
    BpPicture picture;
    BP_TRY(bp_check_map(result, task->scene->transfer, &picture, err));
    const BpStatus status =
        bp_picture_write(&picture, task->map, task->map_format, task->scene->transfer, err);
    bp_picture_clear(&picture);
    return status;
}

/* Checks one device in this process. `shown`: prints the verdict for people there, unless NULL. */
static BpStatus check_device(const CheckTask *task, FILE *shown, json_t **report, bool *agree, BpError *err) {
    BpCheck *check = NULL;
    BpCheckProgress progress = {0};
    const BpCheckResult *result = NULL;
    const bool live = bp_terminal_is_live(task->line->quiet);
    BpStatus status = BP_OK;
    BpWaiting *waiting =
        bp_waiting_begin(task->line->quiet, "building the kernel for %s", task->device->name);
    status = bp_check_create(task->scene, task->options, task->device, &check, err);
    bp_waiting_end(waiting);
    if (status != BP_OK) goto done;
    while (!progress.finished) {
        BP_TRY_GOTO(status, bp_check_step(check, &progress, err), done);
        if (live) show_progress(&progress);
        if (bp_interrupted()) {
            status = bp_fail(err, BP_ERR_INTERRUPTED, "interrupted before a verdict was reached");
            goto done;
        }
    }
    BP_TRY_GOTO(status, bp_check_result(check, &result, err), done);
    *agree = result->verdict.agree;
    if (task->map != NULL) BP_TRY_GOTO(status, write_map(task, result, err), done);
    *report = result_json(result);
    char *text = bp_verdict_text(&result->verdict);
    if (*report == NULL || text == NULL)
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a report");
    else if (shown != NULL) {
        bp_show(task->scene->path, false, shown);
        fputs(" on ", shown);
        bp_show(result->report.device.name, false, shown);
        fputs(" (", shown);
        bp_show(result->report.device.platform, false, shown);
        fprintf(shown, ")\n%ux%u pixels, %llu sample%s each: %s", result->kernel.width, result->kernel.height,
                (unsigned long long)task->options->render.samples_per_pixel,
                bp_plural(task->options->render.samples_per_pixel), text);
    }
    free(text);
done:
    if (live) bp_terminal_show("");
    bp_check_destroy(&check);
    return status;
}

/* ---- every device, each in a process of its own ------------------------------------------------------ */

static bool list_in_child(void *argument, FILE *out) {
    BpDeviceInfo *list = NULL;
    size_t count = 0;
    BpError err = {0};
    (void)argument;
    const BpStatus status = bp_devices_list(&list, &count, &err);
    if (status != BP_OK) fputs(err.message, out);
    const bool good = status == BP_OK && fwrite(list, sizeof *list, count, out) == count;
    free(list);
    bp_error_clear(&err);
    return good;
}

static bool check_in_child(void *argument, FILE *out) {
    const CheckTask *task = argument;
    json_t *report = NULL;
    bool agree;
    BpError err = {0};
    const BpStatus status = check_device(task, NULL, &report, &agree, &err);
    if (status != BP_OK) fputs(err.message, out);
    const bool good = status == BP_OK && json_dumpf(report, out, JSON_REAL_PRECISION(17)) == 0;
    json_decref(report);
    bp_error_clear(&err);
    return good;
}

/* "map.png" for device 2 becomes "map-2.png". */
static void map_name(const char *map, unsigned device, char *name, size_t size) {
    const char *slash = strrchr(map, '/'), *dot = strrchr(slash != NULL ? slash : map, '.');
    const size_t stem = dot != NULL ? (size_t)(dot - map) : strlen(map);
    snprintf(name, size, "%.*s-%u%s", (int)stem, map, device, dot != NULL ? dot : "");
}

/* The devices' own maps must be told apart from the other files, like the map that the command line names. */
static BpStatus check_map_names(const CheckTask *task, const BpDeviceInfo *devices, size_t count,
                                BpError *err) {
    BpCommandLine line = *task->line;
    char name[4096];
    line.map = name;
    for (size_t d = 0; d < count && task->map != NULL; ++d) {
        map_name(task->map, devices[d].number, name, sizeof name);
        BP_TRY(bp_file_conflicts_check(&line, NULL, err));
        BP_TRY(bp_file_conflicts_check_scene(&line, NULL, task->scene, err));
        BP_TRY(bp_output_check(name, err));
    }
    return BP_OK;
}

static BpStatus check_all(CheckTask *task, json_t *results, bool *agree, bool *broken, BpError *err) {
    char *bytes = NULL, failure[256];
    size_t size = 0;
    const char *map = task->map;
    BP_TRY(bp_run_in_child(list_in_child, NULL, &bytes, &size, failure, err));
    if (failure[0] != '\0') {
        free(bytes);
        return bp_fail(err, BP_ERR_DEVICE, "listing the OpenCL devices failed: %s", failure);
    }
    BpDeviceInfo *devices = (BpDeviceInfo *)(void *)bytes;
    const size_t count = size / sizeof *devices;
    BpStatus status = BP_OK;
    if (count == 0)
        status = bp_fail(err, BP_ERR_DEVICE, "no OpenCL device; `ballpark devices` says what to install");
    if (status == BP_OK) status = check_map_names(task, devices, count, err);
    for (size_t d = 0; d < count && status == BP_OK && !bp_interrupted(); ++d) {
        char *text = NULL, name[4096];
        json_t *entry = NULL;
        task->device = &devices[d];
        map_name(map != NULL ? map : "", devices[d].number, name, sizeof name);
        task->map = map != NULL ? name : NULL;
        if (!task->line->quiet) {
            fprintf(stderr, "checking device %u, ", devices[d].number);
            bp_show(devices[d].name, false, stderr);
            fputc('\n', stderr);
        }
        if (devices[d].refusal[0] != '\0') {
            entry = failure_json(&devices[d], devices[d].refusal);
        } else {
            status = bp_run_in_child(check_in_child, task, &text, &size, failure, err);
            if (status == BP_OK && failure[0] == '\0') entry = json_loads(text, 0, NULL);
            if (status == BP_OK && entry == NULL)
                entry = failure_json(&devices[d], failure[0] != '\0' ? failure : "no result was returned");
        }
        if (json_object_get(entry, "error") != NULL)
            *broken = true;
        else if (!json_is_true(json_object_get(entry, "agree")))
            *agree = false;
        if (json_array_append_new(results, entry) != 0 && status == BP_OK)
            status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a report");
        free(text);
    }
    if (bp_interrupted() && status == BP_OK) status = bp_fail(err, BP_ERR_INTERRUPTED, "interrupted");
    free(bytes);
    return status;
}

/* ---- the command --------------------------------------------------------------------------------------- */

static BpStatus find_map_format(const BpCommandLine *line, CheckTask *task, BpError *err) {
    if (line->map == NULL) return BP_OK;
    if (!bp_format_from_path(line->map, &task->map_format) || task->map_format == BP_FORMAT_BPA)
        return bp_fail(err, BP_ERR_USAGE, "--map %s: expected a name that ends in .png, .ppm, .pfm or .exr",
                       line->map);
    task->map = line->map;
    return bp_output_check(line->map, err);
}

BpStatus bp_command_check(const BpCommandLine *line, BpError *err) {
    BpScene *scene = NULL;
    BpDeviceInfo device;
    CheckTask task = {.line = line};
    BpCheckOptions options = {.level = BP_VERDICT_LEVEL};
    json_t *results = NULL, *report = NULL;
    bool agree = true, broken = false;
    const bool all = line->device != NULL && strcmp(line->device, "all") == 0;
    const bool to_stdout = line->json != NULL && strcmp(line->json, "-") == 0;
    BpStatus status = BP_OK;

    if (line->json != NULL) BP_TRY(bp_json_check(line->json, err));
    BP_TRY(find_map_format(line, &task, err));
    BP_TRY_GOTO(status, bp_setup_scene(line, line->operands[0], &scene, err), done);
    if (!bp_option_given(line, BP_OPTION_WIDTH) && scene->camera.width > BP_CHECK_WIDTH_DEFAULT)
        BP_TRY_GOTO(status, bp_scene_set_width(scene, BP_CHECK_WIDTH_DEFAULT, err), done);
    BP_TRY_GOTO(status, bp_setup_options(line, scene, &options.render, err), done);
    if (!bp_option_given(line, BP_OPTION_SPP)) options.render.samples_per_pixel = BP_CHECK_SAMPLES_DEFAULT;
    options.render.sampler = BP_SAMPLER_INDEPENDENT;
    bp_setup_warn(line, scene, options.render.precision);
    task.scene = scene;
    task.options = &options;
    results = json_array();
    bp_interrupt_catch();

    if (all) {
        BP_TRY_GOTO(status, check_all(&task, results, &agree, &broken, err), done);
        if (!to_stdout) print_table(results, stdout);
    } else {
        BP_TRY_GOTO(status, bp_setup_try_device(line->device, err), done);
        BP_TRY_GOTO(status, bp_device_find(line->device, &device, err), done);
        task.device = &device;
        BP_TRY_GOTO(status, check_device(&task, to_stdout ? NULL : stdout, &report, &agree, err), done);
        json_array_append_new(results, report);
    }
    if (line->json != NULL) {
        status = bp_json_write(document_json(scene, &options, json_incref(results)), line->json, err);
        if (status != BP_OK) goto done;
    }
    if (!agree)
        status = bp_fail(err, BP_ERR_DISAGREE, "%s: kernel and reference disagree", scene->path);
    else if (broken)
        status = bp_fail(err, BP_ERR_DEVICE, "%s: a device failed before it could be checked", scene->path);
done:
    json_decref(results);
    bp_scene_destroy(&scene);
    return status;
}
