/* setup.c: see setup.h. */
#include "setup.h"

#include "base/escape.h"
#include "base/input_file.h"
#include "base/plural.h"
#include "cli/line/file_conflicts.h"
#include "cli/process/child_process.h"
#include "cli/process/driver_care.h"
#include "cli/terminal/page.h"
#include "film/film.h"
#include "formats/scene_load.h"
#include "opencl/pocl.h"
#include "opencl/pocl_probe.h"
#include "opencl/self_test.h"
#include "packed/rounding.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static BpStatus load(const char *path, const BpSceneChanges *changes, BpScene **scene, BpError *err) {
    static const char name[] = "standard input";
    char *text = NULL;
    size_t length = 0;
    if (strcmp(path, "-") != 0) return bp_scene_load_changed(path, changes, scene, err);
    if (isatty(STDIN_FILENO))
        return bp_fail(err, BP_ERR_USAGE,
                       "the scene \"-\" is standard input, which is the terminal; pipe a scene into it: "
                       "ballpark generate cover | ballpark render - -o cover.png");
    BP_TRY(bp_stream_read(stdin, 0, name, &text, &length, err));
    bp_driver_care_keep_input(text, length);
    const BpStatus status = bp_scene_parse_changed(text, length, name, changes, scene, err);
    free(text);
    return status;
}

static void say_fresnel(const BpCommandLine *line, const size_t counts[2]) {
    if (counts[1] == 0)
        bp_say(line, "--fresnel %s changes nothing: the scene has no dielectric material", line->fresnel);
    else if (counts[0] == 0)
        bp_say(line, "--fresnel %s changes nothing: the scene has this value", line->fresnel);
    else
        bp_say(line, "--fresnel %s overrides the scene in %zu of %zu dielectric material%s", line->fresnel,
               counts[0], counts[1], bp_plural(counts[1]));
}

/* A misspelt name adds a material that no sphere uses. */
static void say_unused_material(const BpCommandLine *line, const char *set, const BpScene *scene) {
    static const char list[] = "materials.";
    if (strncmp(set, list, sizeof list - 1) != 0) return;
    for (size_t m = 0; m < scene->material_count; m++) {
        const char *name = scene->materials[m].name, *rest = set + sizeof list - 1;
        const size_t length = strlen(name);
        if (strncmp(rest, name, length) != 0 || (rest[length] != '=' && rest[length] != '.')) continue;
        size_t i = 0;
        while (i < bp_scene_shapes(scene) && bp_shape_material(scene, i) != m) i++;
        if (i == bp_scene_shapes(scene))
            bp_say(line, "--set %s changes nothing: no %s has this material", set, bp_scene_noun(scene));
    }
}

void bp_setup_notes(const BpCommandLine *line, const BpScene *scene) {
    BpPage page;
    bp_page_begin(&page, stderr);
    bp_print_escaped(scene->notes, true, page.text);
    bp_page_end(&page, line, stderr);
}

BpStatus bp_setup_load_changed(const BpCommandLine *line, const char *path, const BpSceneChanges *changes,
                               BpScene **scene, BpError *err) {
    BpSceneChanges all = *changes;
    all.set = line->set.list;
    all.set_count = line->set.count;
    all.set_by = "--set";
    all.fresnel = line->fresnel;
    all.lighting = line->lighting;
    all.projection = line->projection;
    all.select = line->select;
    all.select_by = "--select";
    BP_TRY(load(path, &all, scene, err));
    BpStatus status = bp_file_conflicts_check_scene(line, NULL, *scene, err);
    if (status == BP_OK && bp_option_given(line, BP_OPTION_FRAME) && !(*scene)->has_particles)
        status = bp_fail(err, BP_ERR_USAGE, "--frame: %.400s has no particles, so it has one frame", path);
    if (status == BP_OK && line->select != NULL && !(*scene)->has_particles)
        status = bp_fail(err, BP_ERR_USAGE, "--select: %.400s has no particles to select from", path);
    if (status != BP_OK) bp_scene_destroy(scene);
    return status;
}

BpStatus bp_setup_load(const BpCommandLine *line, const char *path, BpScene **scene, BpError *err) {
    size_t counts[2] = {0, 0};
    const BpSceneChanges changes = {.has_frame = bp_option_given(line, BP_OPTION_FRAME),
                                    .frame = line->frame,
                                    .fit = line->fit,
                                    .fresnel_counts = counts};
    BP_TRY(bp_setup_load_changed(line, path, &changes, scene, err));
    if (line->fresnel != NULL) say_fresnel(line, counts);
    for (size_t i = 0; i < line->set.count; i++) say_unused_material(line, line->set.list[i], *scene);
    bp_setup_notes(line, *scene);
    return BP_OK;
}

BpStatus bp_setup_scene(const BpCommandLine *line, const char *path, BpScene **scene, BpError *err) {
    BP_TRY(bp_setup_load(line, path, scene, err));
    if (!bp_option_given(line, BP_OPTION_WIDTH)) return BP_OK;
    const BpStatus status = bp_scene_set_width(*scene, line->width, err);
    if (status != BP_OK) bp_scene_destroy(scene);
    return status;
}

BpStatus bp_setup_options(const BpCommandLine *line, const BpScene *scene, BpRenderOptions *options,
                          BpError *err) {
    bp_render_defaults(scene, options);
#define SKIP(...)
#define TAKE(number, name, letter, commands, help, type, member, ...)                                        \
    if (bp_option_given(line, BP_OPTION_##number)) options->member = line->member;
    BP_OPTION_LIST(SKIP, TAKE)
#undef TAKE
#undef SKIP
    options->all_effects = line->effects != NULL;
    const uint64_t samples_max = BP_SAMPLE_NUMBERS - options->first_sample;
    if (options->samples_per_pixel <= samples_max) return BP_OK;
    const bool asked = bp_option_given(line, BP_OPTION_SPP);
    /* With one of these options, the scene's sample count is not used. */
    if (!asked && (bp_option_given(line, BP_OPTION_ERROR) || bp_option_given(line, BP_OPTION_TIME) ||
                   bp_option_given(line, BP_OPTION_PIXEL))) {
        options->samples_per_pixel = samples_max;
        return BP_OK;
    }
    return bp_fail(err, BP_ERR_USAGE,
                   "--first-sample %" PRIu64 " leaves room for %" PRIu64
                   " sample%s per pixel (the last number is %" PRIu64 "), but %s asks for %" PRIu64
                   "; use --spp %" PRIu64 " or less, or --first-sample %" PRIu64 " or less",
                   options->first_sample, samples_max, bp_plural(samples_max), BP_SAMPLE_NUMBERS - 1,
                   asked ? "--spp" : "the scene's \"samples_per_pixel\"", options->samples_per_pixel,
                   samples_max, BP_SAMPLE_NUMBERS - options->samples_per_pixel);
}

BpStatus bp_setup_share(const BpCommandLine *line, BpRenderOptions *options, BpError *err) {
    if (!bp_option_given(line, BP_OPTION_SHARE)) return BP_OK;
    if (bp_option_given(line, BP_OPTION_ERROR) || line->adaptive)
        return bp_fail(err, BP_ERR_USAGE,
                       "--share and --%s contradict: the noise of the whole picture does not follow from one "
                       "share; leave "
                       "--%s out",
                       line->adaptive ? "adaptive" : "error", line->adaptive ? "adaptive" : "error");
    if (line->output == NULL)
        return bp_fail(err, BP_ERR_USAGE,
                       "--share %" PRIu32 "/%" PRIu32
                       " needs a file of its own: give one with --output FILE.bpa",
                       line->share.number, line->share.count);
    const uint64_t first = options->first_sample, samples = options->samples_per_pixel;
    const uint64_t round = options->replicates != 0 ? options->replicates : BP_REPLICATES_DEFAULT;
    const uint64_t rounds = (samples + round - 1) / round;
    if (line->share.count > rounds)
        return bp_fail(err, BP_ERR_USAGE,
                       "--share %" PRIu32 "/%" PRIu32 ": %" PRIu64 " sample%s per pixel make at most %" PRIu64
                       " share%s of %" PRIu64 " samples; use fewer shares, or --spp %" PRIu64 " or more",
                       line->share.number, line->share.count, samples, bp_plural(samples), rounds,
                       bp_plural(rounds), round, (line->share.count - 1) * round + 1);
    const uint64_t begin = rounds * (line->share.number - 1) / line->share.count * round;
    const uint64_t end = rounds * line->share.number / line->share.count * round;
    options->first_sample = first + begin;
    options->samples_per_pixel = (end < samples ? end : samples) - begin;
    options->job_first = first;
    options->job_samples = samples;
    return BP_OK;
}

void bp_setup_warn(const BpCommandLine *line, const BpScene *scene, BpPrecision precision) {
    BpRoundingWarnings limits;
    if (line->quiet) return;
    bp_rounding_warnings(scene, precision, &limits);
    for (unsigned i = 0; i < limits.count; ++i)
        bp_say(line, "warning: %s; use --precision double, or %s", limits.text[i], limits.remedy[i]);
}

static BpStatus all_devices(BpDeviceInfo **devices, size_t *count, BpError *err) {
    BP_TRY(bp_devices_list(devices, count, err));
    size_t kept = 0;
    for (size_t d = 0; d < *count; ++d)
        if ((*devices)[d].refusal[0] == '\0') (*devices)[kept++] = (*devices)[d];
    *count = kept;
    if (kept > 0) return BP_OK;
    free(*devices);
    *devices = NULL;
    BpDeviceInfo none;
    const BpStatus status = bp_device_find(NULL, &none, err); /* its message has the remedy */
    return status != BP_OK ? status : bp_fail(err, BP_ERR_DEVICE, "no OpenCL device that can render");
}

/* Runs in a child process. Other errors are ignored here: they will occur again, and be reported then. */
static bool try_device(void *argument, FILE *out) {
    BpDeviceInfo device;
    (void)out;
    if (bp_device_find(argument, &device, NULL) == BP_OK && strcmp(device.platform, BP_POCL_PLATFORM) == 0)
        (void)bp_pocl_try_kernel(&device, NULL);
    return true;
}

/* PoCL may need a linker, and ends the process if PATH has none. In that case this tries a kernel on the
 * device that `name` selects, in a child process. */
static BpStatus try_without_linker(const char *name, BpError *err) {
    char copy[256];
    BpChildReport report;
    if (bp_pocl_finds_linker()) return BP_OK;
    snprintf(copy, sizeof copy, "%s", name != NULL ? name : "");
    BP_TRY(bp_run_in_child(try_device, copy, 0, &report, err));
    free(report.bytes);
    if (report.end == BP_CHILD_DONE) return BP_OK;
    return bp_fail(err, BP_ERR_DEVICE, "the OpenCL driver %s", report.failure);
}

/* Of the remaining drivers, if some are broken. */
static BpStatus find_device(const BpDeviceSurvey *survey, const char *name, BpDeviceInfo **devices,
                            size_t *count, BpError *err) {
    *devices = malloc(sizeof **devices);
    if (*devices == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a device's description");
    BpStatus status = survey->broken_count > 0 ? bp_device_survey_find(survey, name, *devices, err)
                                               : bp_device_find(name, *devices, err);
    *count = status == BP_OK ? 1 : 0;
    if (status == BP_OK) return BP_OK;
    free(*devices);
    *devices = NULL;
    if (status == BP_ERR_NO_DEVICE || status == BP_ERR_BROKEN_DEVICE) status = BP_ERR_DEVICE;
    if (err != NULL) err->code = status;
    return status;
}

BpStatus bp_setup_devices(const BpCommandLine *line, BpDeviceInfo **devices, size_t *count, BpError *err) {
    const bool all = line->device != NULL && strcmp(line->device, "all") == 0;
    const char *name = all ? NULL : line->device;
    BpDeviceSurvey survey = {0};
    BpStatus status = BP_OK;
    BP_TRY_GOTO(status, bp_driver_care_survey(line, &survey, err), done);
    BP_TRY_GOTO(status, try_without_linker(name, err), done);
    BP_TRY_GOTO(status, bp_driver_care_start(line, err), done);
    status = all && (survey.broken_count == 0 || survey.count > 0)
                 ? all_devices(devices, count, err)
                 : find_device(&survey, name, devices, count, err);
done:
    bp_device_survey_clear(&survey);
    return status;
}

/* --threads is a hint: a GPU does not count threads, and not every driver can divide its device. */
static void say_threads(const BpCommandLine *line, const BpDeviceInfo *device, uint32_t used) {
    if (line->threads == 0 || used == line->threads) return;
    if (device->type != BP_DEVICE_CPU)
        bp_say(line, "--threads changes nothing on %s, which is not a CPU", device->name);
    else if (line->threads > used)
        bp_say(line, "--threads %" PRIu32 ": %s has %" PRIu32 ", and all of them are used", line->threads,
               device->name, used);
    else
        bp_say(line, "--threads %" PRIu32 ": the driver of %s cannot divide it, so all %" PRIu32 " are used",
               line->threads, device->name, used);
}

BpStatus bp_setup_self_test(const BpCommandLine *line, const BpDeviceInfo *devices, size_t count,
                            BpError *err) {
    for (size_t d = 0; d < count; ++d) {
        BpDevice *device = NULL;
        BpError fault = {0};
        BP_TRY(bp_device_open_part(&devices[d], line->threads, &device, err));
        say_threads(line, &devices[d], device->info.compute_units);
        const BpStatus status = bp_self_test_once(device, NULL, &fault);
        bp_device_close(&device);
        /* A test that could not run is not evidence against the device. */
        const bool failed = status == BP_ERR_DEVICE || status == BP_ERR_BUILD;
        bp_error_add_remedy(&fault, BP_INTERFACE_COMMAND_LINE);
        if (failed && line->force) {
            bp_say(line, "ballpark: warning: %s", fault.message);
        } else if (status != BP_OK) {
            bp_fail(err, status, "%s%s", fault.message, failed ? "; --force renders anyway" : "");
            bp_error_attach(err, fault.attachment);
        }
        bp_error_clear(&fault);
        if (status != BP_OK && !(failed && line->force)) return status;
    }
    return BP_OK;
}
