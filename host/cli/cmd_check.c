/* cmd_check.c: `ballpark check`.
 *
 * In:    a scene, devices.   Out: whether kernel and reference agree; a document; a picture.
 * Knows: the check, devices, processes.   Does not know: statistics, OpenCL. */
#include "commands.h"

#include "apart.h"
#include "base/format.h"
#include "base/output_file.h"
#include "base/plural.h"
#include "base/shown.h"
#include "check_report.h"
#include "image/image.h"
#include "interrupt.h"
#include "json_file.h"
#include "setup.h"
#include "terminal.h"

#include <stdlib.h>
#include <string.h>

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
            status = bp_fail(err, BP_ERR_INTERRUPTED, "interrupted before there was a verdict");
            goto done;
        }
    }
    BP_TRY_GOTO(status, bp_check_result(check, &result, err), done);
    *agree = result->verdict.agree;
    if (task->map != NULL) BP_TRY_GOTO(status, write_map(task, result, err), done);
    *report = bp_check_report_json(result);
    char *text = bp_verdict_text(&result->verdict);
    if (*report == NULL || text == NULL)
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a report");
    else if (shown != NULL) {
        bp_show(task->scene->path, false, shown);
        fputs(" on ", shown);
        bp_show(result->report.device.name, false, shown);
        fputs(" (", shown);
        bp_show(result->report.device.platform, false, shown);
        fprintf(shown, "), %ux%u pixels, %llu sample%s each: %s", result->kernel.width, result->kernel.height,
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

static bool list_apart(void *argument, FILE *out) {
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

static bool check_apart(void *argument, FILE *out) {
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

static BpStatus check_all(CheckTask *task, json_t *results, bool *agree, bool *broken, BpError *err) {
    char *bytes = NULL, failure[256];
    size_t size = 0;
    const char *map = task->map;
    BP_TRY(bp_run_apart(list_apart, NULL, &bytes, &size, failure, err));
    if (failure[0] != '\0') {
        free(bytes);
        return bp_fail(err, BP_ERR_DEVICE, "listing the OpenCL devices failed: %s", failure);
    }
    BpDeviceInfo *devices = (BpDeviceInfo *)(void *)bytes;
    const size_t count = size / sizeof *devices;
    BpStatus status = BP_OK;
    if (count == 0)
        status = bp_fail(err, BP_ERR_DEVICE, "no OpenCL device; `ballpark devices` says what to install");
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
            entry = bp_check_report_failure(&devices[d], devices[d].refusal);
        } else {
            status = bp_run_apart(check_apart, task, &text, &size, failure, err);
            if (status == BP_OK && failure[0] == '\0') entry = json_loads(text, 0, NULL);
            if (status == BP_OK && entry == NULL)
                entry = bp_check_report_failure(&devices[d], failure[0] != '\0' ? failure : "gave no result");
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
        return bp_fail(err, BP_ERR_USAGE, "--map %s: a picture's name ends in .png, .ppm, .pfm or .exr",
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
        if (!to_stdout) bp_check_report_table(results, stdout);
    } else {
        BP_TRY_GOTO(status, bp_setup_try_device(line->device, err), done);
        BP_TRY_GOTO(status, bp_device_find(line->device, &device, err), done);
        task.device = &device;
        BP_TRY_GOTO(status, check_device(&task, to_stdout ? NULL : stdout, &report, &agree, err), done);
        json_array_append_new(results, report);
    }
    if (line->json != NULL) {
        status =
            bp_json_write(bp_check_report_document(scene, &options, json_incref(results)), line->json, err);
        if (status != BP_OK) goto done;
    }
    if (!agree)
        status = bp_fail(err, BP_ERR_DISAGREE, "%s: kernel and reference disagree", scene->path);
    else if (broken)
        status = bp_fail(err, BP_ERR_DEVICE, "%s: a device broke before it could be checked", scene->path);
done:
    json_decref(results);
    bp_scene_destroy(&scene);
    return status;
}
