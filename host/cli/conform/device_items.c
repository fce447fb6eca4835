/* device_items.c: see device_items.h.
 *
 * The child writes a line of JSON for each thing that it begins ({"item", "doing"}) and for each item's end
 * ({"item", "result"} or {"item", "error", ...}); the last line may be cut where a driver ended the child. */
#include "device_items.h"

#include "base/clock.h"
#include "base/json_memory.h"
#include "base/json_text.h"
#include "cli/process/child_process.h"
#include "cli/process/interrupt.h"
#include "cli/terminal/terminal.h"

#include <stdlib.h>
#include <string.h>

/* A child ends by itself at its time limit. If a driver call prevents that, it is killed after this time. */
#define GRACE_SECONDS 5.0

/* ---- in the child ------------------------------------------------------------------------------------- */

/* Whether there was memory for the line and all its parts: jansson can lose one without an error. */
static bool write_line(json_t *line, FILE *out) {
    char *text = line != NULL ? json_dumps(line, JSON_REAL_PRECISION(17) | JSON_COMPACT) : NULL;
    const bool whole = text != NULL && !bp_json_memory_failed();
    if (whole) fprintf(out, "%s\n", text);
    fflush(out);
    free(text);
    json_decref(line);
    return whole;
}

static void write_lack_of_memory(size_t item, FILE *out) {
    fprintf(out, "{\"item\": %zu, \"code\": %d, \"error\": \"out of memory for a result\"}\n", item,
            (int)BP_ERR_MEMORY);
    fflush(out);
}

void bp_item_doing(FILE *out, size_t number, const char *doing) {
    write_line(json_pack("{s:I, s:s}", "item", (json_int_t)number, "doing", doing), out);
}

static void write_error(size_t item, BpError *error, FILE *out) {
    bp_error_add_remedy(error, BP_INTERFACE_COMMAND_LINE);
    json_t *line = json_pack("{s:I, s:i, s:o, s:o, s:i, s:i}", "item", (json_int_t)item, "code",
                             (int)error->code, "error", bp_json_text(error->message), "file",
                             bp_json_text(error->file), "line", error->line, "column", error->column);
    if (error->attachment != NULL) json_object_set_new(line, "attachment", bp_json_text(error->attachment));
    if (!write_line(line, out)) write_lack_of_memory(item, out);
}

static bool work_in_child(void *argument, FILE *out) {
    const BpDeviceItems *items = argument;
    const double begun = bp_clock_seconds();
    for (size_t i = 0; i < items->count; ++i) {
        BpError error = {0};
        BpStatus status = BP_OK;
        json_t *result = NULL;
        const double left = items->seconds - (bp_clock_seconds() - begun);
        if (items->seconds > 0 && left <= 0)
            status = bp_fail(&error, BP_ERR_INCONCLUSIVE, "time was up after %.3g s, before its turn",
                             items->seconds);
        else
            status = items->work(items, i, items->seconds > 0 ? left / (double)(items->count - i) : 0, out,
                                 &result, &error);
        if (status != BP_OK)
            write_error(i, &error, out);
        else if (!write_line(json_pack("{s:I, s:o}", "item", (json_int_t)i, "result", result), out))
            write_lack_of_memory(i, out);
        bp_error_clear(&error);
        if (status == BP_ERR_INTERRUPTED) break;
    }
    return true;
}

/* ---- in the parent ------------------------------------------------------------------------------------ */

static const char *text_of(const json_t *line, const char *key) {
    const char *text = json_string_value(json_object_get(line, key));
    return text != NULL ? text : "";
}

static void read_error(const json_t *line, BpError *error) {
    bp_fail(error, (BpStatus)json_integer_value(json_object_get(line, "code")), "%s", text_of(line, "error"));
    if (text_of(line, "file")[0] != '\0')
        bp_error_at(error, text_of(line, "file"), (int)json_integer_value(json_object_get(line, "line")),
                    (int)json_integer_value(json_object_get(line, "column")));
    if (json_object_get(line, "attachment") != NULL) bp_error_attach(error, text_of(line, "attachment"));
}

/* `doing`: the child's latest reported step. */
static void read_lines(const BpDeviceItems *items, const char *bytes, BpItemOutcome *outcomes,
                       char doing[64]) {
    for (const char *at = bytes, *end; (end = strchr(at, '\n')) != NULL; at = end + 1) {
        json_t *line = json_loadb(at, (size_t)(end - at), 0, NULL);
        const json_int_t number = json_integer_value(json_object_get(line, "item"));
        json_t *result = json_object_get(line, "result");
        if (line == NULL || number < 0 || (size_t)number >= items->count) {
            /* a line that was cut */
        } else if (json_object_get(line, "doing") != NULL) {
            snprintf(doing, 64, "%s", text_of(line, "doing"));
        } else if (result != NULL) {
            outcomes[number].result = json_incref(result);
        } else {
            read_error(line, &outcomes[number].error);
        }
        json_decref(line);
    }
}

/* Items without a report of the child: the first is the one during which it ended. */
static void fill_gaps(const BpDeviceItems *items, const BpChildReport *report, bool interrupted,
                      const char *doing, BpItemOutcome *outcomes) {
    const bool hung = report->end == BP_CHILD_HUNG;
    bool first = true;
    for (size_t i = 0; i < items->count; ++i) {
        BpError *error = &outcomes[i].error;
        if (outcomes[i].result != NULL || error->code != BP_OK) continue;
        if (interrupted)
            bp_fail(error, BP_ERR_INTERRUPTED, "interrupted before a verdict was reached");
        else if (!first)
            bp_fail(error, BP_ERR_BROKEN_DEVICE, "not reached, since the device failed earlier (%s)",
                    hung ? "hung" : report->failure);
        else if (hung)
            bp_fail(error, BP_ERR_BROKEN_DEVICE, "hung while %s: its driver did not return within %.3g s",
                    doing, items->seconds);
        else
            bp_fail(error, BP_ERR_BROKEN_DEVICE, "%s",
                    report->failure[0] != '\0' ? report->failure : "no result was returned");
        first = false;
    }
}

BpStatus bp_device_items_run(const BpDeviceItems *items, BpItemOutcome *outcomes, BpError *err) {
    BpChildReport report;
    char doing[64] = "starting";
    BpDeviceItems copy = *items;
    memset(outcomes, 0, items->count * sizeof *outcomes);
    BP_TRY(bp_run_in_child(work_in_child, &copy, items->seconds > 0 ? items->seconds + GRACE_SECONDS : 0,
                           &report, err));
    if (report.end != BP_CHILD_DONE && bp_terminal_is_live(items->quiet)) bp_terminal_show("");
    read_lines(items, report.bytes, outcomes, doing);
    /* A child that a second signal has ended does not show that its device is broken. */
    fill_gaps(items, &report, bp_interrupted(), doing, outcomes);
    free(report.bytes);
    if (bp_json_memory_failed()) { /* the result may be incomplete */
        bp_item_outcomes_clear(outcomes, items->count);
        memset(outcomes, 0, items->count * sizeof *outcomes);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the results of a device");
    }
    return BP_OK;
}

void bp_item_outcomes_clear(BpItemOutcome *outcomes, size_t count) {
    for (size_t i = 0; outcomes != NULL && i < count; ++i) {
        json_decref(outcomes[i].result);
        bp_error_clear(&outcomes[i].error);
    }
}
