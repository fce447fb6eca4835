/* cmd_cost.c: `ballpark cost`.
 *
 * In:    a scene, a time budget.   Out: a table; a page, a document, a CSV file.
 * Knows: the study, files, the terminal.   Does not know: how anything is measured. */
#include "commands.h"

#include "base/format.h"
#include "base/json_memory.h"
#include "cli/job/setup.h"
#include "cli/output/json_file.h"
#include "cli/output/output.h"
#include "cli/process/interrupt.h"
#include "cli/terminal/page.h"
#include "cli/terminal/terminal.h"
#include "study/study.h"

#include <stdlib.h>
#include <string.h>

static void show_progress(const BpStudyProgress *progress) {
    char text[160], left[32];
    snprintf(text, sizeof text, "%3.0f %%  %s left  %s", 100 * progress->fraction,
             bp_format_seconds(progress->seconds_left, left, sizeof left), progress->doing);
    text[bp_terminal_columns() < sizeof text ? bp_terminal_columns() - 1 : sizeof text - 1] = '\0';
    bp_terminal_show(progress->finished ? "" : text);
}

/* Ctrl-C ends a study early; the results are those of the sample counts that every configuration has reached.
 */
static BpStatus run_study(const BpCommandLine *line, BpStudy *study, BpError *err) {
    BpStudyProgress progress = {0};
    const bool live = bp_terminal_is_live(line->quiet);
    BpStatus status = BP_OK;
    while (status == BP_OK && !progress.finished && !bp_interrupted()) {
        status = bp_study_step(study, &progress, err);
        if (live && status == BP_OK) show_progress(&progress);
    }
    if (live) bp_terminal_show("");
    return status == BP_OK && !progress.finished ? bp_study_stop(study, err) : status;
}

typedef bool Print(const BpStudyResult *result, FILE *out);

typedef struct Printed {
    const BpStudyResult *result;
    Print *print;
} Printed;

static BpStatus print_part(const void *what, FILE *out, BpError *err) {
    const Printed *printed = what;
    const bool written = printed->print(printed->result, out);
    if (!written && bp_json_memory_failed())
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the results");
    return bp_print_end(out, written, err);
}

static BpStatus check_outputs(const BpCommandLine *line, BpError *err) {
    const char *const files[] = {line->csv, line->json};
    if (line->output != NULL)
        BP_TRY(bp_line_check_named(line, line->output, ".html", "the study is written as an HTML page", err));
    for (size_t f = 0; f < sizeof files / sizeof files[0]; ++f)
        if (files[f] != NULL) BP_TRY(bp_line_check_output(line, files[f], err));
    return BP_OK;
}

static BpStatus write_results(const BpCommandLine *line, const BpStudyResult *result, BpError *err) {
    const char *const files[] = {line->output, line->json, line->csv};
    bool to_stdout = false;
    for (size_t f = 0; f < sizeof files / sizeof files[0]; ++f)
        if (files[f] != NULL && strcmp(files[f], "-") == 0) to_stdout = true;
    const Printed whole = {result, bp_study_print_page}, points = {result, bp_study_print_csv};
    BpStatus status = BP_OK;
    /* A study takes minutes: a file that cannot be written does not keep the others, or the table, from being
     * written. The first failure is reported. */
    if (line->output != NULL) status = bp_line_write(line, line->output, print_part, &whole, err);
    if (line->csv != NULL) {
        const BpStatus written =
            bp_line_write(line, line->csv, print_part, &points, status == BP_OK ? err : NULL);
        if (status == BP_OK) status = written;
    }
    if (line->json != NULL) {
        const BpStatus written =
            bp_json_write(line, bp_study_json(result), line->json, status == BP_OK ? err : NULL);
        if (status == BP_OK) status = written;
    }
    if (!to_stdout) {
        BpPage page;
        bp_page_begin(&page, stdout);
        bp_study_print(result, page.text);
        bp_page_end(&page, line, stdout);
    }
    if (status != BP_OK) return status;
    if (result->cut_short)
        return bp_fail(err, BP_ERR_INTERRUPTED, "interrupted; these results are from the first %.0f seconds",
                       result->seconds);
    return BP_OK;
}

/* Loads the scene at the size of the study: --width, otherwise the scene's width, up to a limit. */
static BpStatus load_scene(const BpCommandLine *line, BpScene **scene, BpSceneInfo *full, BpError *err) {
    BP_TRY(bp_setup_load(line, line->operands[0], scene, err));
    bp_scene_info(*scene, full);
    if (bp_option_given(line, BP_OPTION_WIDTH)) return bp_scene_set_width(*scene, line->width, err);
    if (full->width <= BP_STUDY_WIDTH_DEFAULT) return BP_OK;
    return bp_scene_set_width(*scene, BP_STUDY_WIDTH_DEFAULT, err);
}

static BpStatus find_device(const BpCommandLine *line, BpDeviceInfo *device, BpError *err) {
    BpDeviceInfo *devices = NULL;
    size_t count = 0;
    if (line->device != NULL && strcmp(line->device, "all") == 0)
        return bp_fail(err, BP_ERR_USAGE,
                       "--device all: ballpark cost measures one device; give its number or name");
    BP_TRY(bp_setup_devices(line, &devices, &count, err));
    *device = devices[0];
    free(devices);
    return bp_setup_self_test(line, device, 1, err);
}

BpStatus bp_command_cost(const BpCommandLine *line, BpError *err) {
    BpStatus status = BP_OK;
    BpScene *scene = NULL;
    BpStudy *study = NULL;
    BpDeviceInfo device;
    BpRenderOptions options;
    BpSceneInfo full;
    const double seconds =
        bp_option_given(line, BP_OPTION_TIME) ? line->time_seconds : BP_STUDY_SECONDS_DEFAULT;

    BP_TRY(check_outputs(line, err));
    BP_TRY_GOTO(status, load_scene(line, &scene, &full, err), done);
    BP_TRY_GOTO(status, bp_setup_options(line, scene, &options, err), done);
    if (!bp_option_given(line, BP_OPTION_SAMPLER)) options.sampler = BP_SAMPLER_SOBOL; /* as render */
    BP_TRY_GOTO(status, find_device(line, &device, err), done);
    bp_interrupt_catch();
    BP_TRY_GOTO(status, bp_render_choose_caustics(scene, &options, &device, err), done);
    BP_TRY_GOTO(status,
                bp_study_create(scene, &options, &device, full.width, full.height, seconds, &study, err),
                done);
    bp_line_say_overwritten(line, line->output);
    bp_line_say_overwritten(line, line->csv);
    bp_line_say_overwritten(line, line->json);
    BP_TRY_GOTO(status, run_study(line, study, err), done);
    status = write_results(line, bp_study_result(study), err);
done:
    bp_study_destroy(&study);
    bp_scene_destroy(&scene);
    return status;
}
