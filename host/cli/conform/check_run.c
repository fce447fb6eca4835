/* check_run.c: see check_run.h. */
#include "check_run.h"

#include "base/format.h"
#include "check_entry.h"
#include "cli/output/content.h"
#include "cli/output/output.h"
#include "cli/process/interrupt.h"
#include "cli/terminal/terminal.h"
#include "item_device.h"

#include <stdlib.h>
#include <string.h>

static void show_progress(const char *name, const BpCheckProgress *progress) {
    char left[32], text[160] = "";
    const char *part = progress->reference ? "reference" : "kernel";
    if (!progress->finished)
        snprintf(text, sizeof text, "%s%s%s %3.0f %%", name, name[0] != '\0' ? ": " : "", part,
                 100 * progress->done);
    const size_t used = strlen(text);
    if (!progress->finished && progress->done > 0.02) /* before, the time left is a guess */
        snprintf(text + used, sizeof text - used, "  %s left",
                 bp_format_seconds(progress->seconds * (1 / progress->done - 1), left, sizeof left));
    bp_terminal_show(text);
}

/* What the child has beside the run. */
typedef struct Child {
    const BpCheckRun *run;
    BpItemDevice *device;
} Child;

static BpStatus write_map(const BpCheckRun *run, const BpCheckItem *item, const BpCheckResult *result,
                          BpError *err) {
    BpPicture picture;
    BP_TRY(bp_check_map(result, item->scene->transfer, &picture, err));
    const BpStatus status = bp_line_write_picture(run->line, run->map, &picture, run->map_format,
                                                  item->scene->transfer, NULL, err);
    bp_picture_clear(&picture);
    return status;
}

/* In the child. */
static BpStatus check_item(const BpDeviceItems *items, size_t number, double seconds, FILE *out,
                           json_t **item_result, BpError *err) {
    const Child *child = items->argument;
    const BpCheckRun *run = child->run;
    const BpCheckItem *item = &run->items[number];
    BpCheckOptions options = item->options;
    BpCheck *check = NULL;
    BpCheckProgress progress = {0};
    const BpCheckResult *result = NULL;
    char *text = NULL;
    const bool live = bp_terminal_is_live(run->quiet);
    BpStatus status = BP_OK;
    options.seconds = seconds;
    bp_item_doing(out, number, "building the kernel");
    BpWaiting *waiting = bp_waiting_begin(run->quiet, "building the kernel for %s", run->device->name);
    status = bp_item_device_open(child->device, err);
    if (status == BP_OK) status = bp_check_create(item->scene, &options, child->device->open, &check, err);
    bp_waiting_end(waiting);
    if (status != BP_OK) goto done;
    bp_item_doing(out, number, "rendering");
    while (!progress.finished) {
        BP_TRY_GOTO(status, bp_check_step(check, &progress, err), done);
        if (live) show_progress(run->count > 1 ? item->name : "", &progress);
        if (bp_interrupted()) {
            status = bp_fail(err, BP_ERR_INTERRUPTED, "interrupted before a verdict was reached");
            goto done;
        }
    }
    BP_TRY_GOTO(status, bp_check_result(check, &result, err), done);
    if (run->map != NULL) BP_TRY_GOTO(status, write_map(run, item, result, err), done);
    text = bp_verdict_text(&result->verdict);
    *item_result =
        json_pack("{s:o, s:s}", "entry", bp_check_entry(result, item->options.render.samples_per_pixel),
                  "text", text != NULL ? text : "");
    if (*item_result == NULL || text == NULL)
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a report");
done:
    if (live) bp_terminal_show("");
    free(text);
    bp_check_destroy(&check);
    bp_item_device_done(child->device, status);
    return status;
}

BpStatus bp_check_run(const BpCheckRun *run, BpItemOutcome *outcomes, BpError *err) {
    BpItemDevice device = {.info = run->device, .threads = run->items[0].options.render.threads};
    const Child child = {.run = run, .device = &device};
    const BpDeviceItems items = {.work = check_item,
                                 .argument = &child,
                                 .count = run->count,
                                 .seconds = run->seconds,
                                 .quiet = run->quiet};
    BP_TRY(bp_device_items_run(&items, outcomes, err));
    for (size_t i = 0; i < run->count; ++i) {
        const BpError *error = &outcomes[i].error;
        if (outcomes[i].result != NULL) continue;
        const bool open = error->code == BP_ERR_INCONCLUSIVE || error->code == BP_ERR_INTERRUPTED;
        json_t *entry = open ? bp_check_entry_inconclusive(run->device, error->message)
                             : bp_check_entry_failed(run->device, error->message);
        outcomes[i].result = json_pack("{s:o}", "entry", entry);
        if (outcomes[i].result == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a report");
    }
    return BP_OK;
}
