/* cmd_devices.c: `ballpark devices`.
 *
 * In:    nothing.   Out: a table, or JSON, of every OpenCL device, and the drivers that crash or hang.
 * Knows: BpDeviceInfo, calibrations, tables on a terminal.   Does not know: how a driver that may be broken
 * is tried (cli/process/device_survey.h). */
#include "commands.h"

#include "base/escape.h"
#include "base/json_text.h"
#include "base/names.h"
#include "base/wrap.h"
#include "cli/output/json_file.h"
#include "cli/output/output.h"
#include "cli/output/report_json.h"
#include "cli/process/device_survey.h"
#include "cli/process/interrupt.h"
#include "cli/terminal/page.h"
#include "cli/terminal/table.h"
#include "opencl/driver_start.h"
#include "render/calibrate.h"

#include <errno.h>
#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 8 };

static const char *type_text(BpDeviceType type) {
    return type == BP_DEVICE_CPU ? "CPU" : type == BP_DEVICE_GPU ? "GPU" : "other";
}

static void format_bytes(uint64_t bytes, char *text) {
    const double gib = (double)bytes / (1024.0 * 1024.0 * 1024.0);
    if (gib >= 0.95)
        snprintf(text, BP_CELL_SIZE, "%.1f GiB", gib);
    else
        snprintf(text, BP_CELL_SIZE, "%.0f MiB", gib * 1024.0);
}

static void fill_row(const BpDeviceInfo *info, bool is_default, const BpTable *table, size_t row) {
    snprintf(bp_table_cell(table, row, 0), BP_CELL_SIZE, "%u%s", info->number, is_default ? "*" : " ");
    snprintf(bp_table_cell(table, row, 1), BP_CELL_SIZE, "%s", type_text(info->type));
    bp_escape(info->name, bp_table_cell(table, row, 2), BP_CELL_SIZE);
    snprintf(bp_table_cell(table, row, 3), BP_CELL_SIZE, "%u", info->compute_units);
    format_bytes(info->memory_bytes, bp_table_cell(table, row, 4));
    format_bytes(info->largest_allocation_bytes, bp_table_cell(table, row, 5));
    snprintf(bp_table_cell(table, row, 6), BP_CELL_SIZE, "%s", info->has_double ? "yes" : "no");
    char text[2 * BP_CELL_SIZE];
    snprintf(text, sizeof text, "%s, driver %s", info->platform, info->driver);
    bp_escape(text, bp_table_cell(table, row, 7), BP_CELL_SIZE);
}

static BpStatus print_table(const BpCommandLine *line, const BpDeviceInfo *list, size_t count,
                            unsigned default_number, BpError *err) {
    static const char *const head[COLUMNS] = {"",       "type",           "name",   "units",
                                              "memory", "largest buffer", "double", "platform and driver"};
    static const bool right[COLUMNS] = {true, false, false, true, true, true, false, false};
    BpTable table;
    BpPage page;
    if (!bp_table_make(&table, COLUMNS, count + 1, right))
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a table of %zu devices", count);
    for (size_t c = 0; c < COLUMNS; ++c) snprintf(bp_table_cell(&table, 0, c), BP_CELL_SIZE, "%s", head[c]);
    for (size_t d = 0; d < count; ++d) fill_row(&list[d], list[d].number == default_number, &table, d + 1);
    bp_page_begin(&page, stdout);
    bp_table_print(&table, bp_page_columns(line, stdout), page.text);
    for (size_t d = 0; d < count; ++d) {
        if (list[d].refusal[0] == '\0') continue;
        fprintf(page.text, "%u  " BP_HANG "cannot render: ", list[d].number);
        bp_print_escaped(list[d].refusal, false, page.text);
        fputc('\n', page.text);
    }
    for (size_t d = 0; d < count; ++d) {
        BpCalibration calibration;
        char words[BP_CALIBRATION_TEXT];
        if (list[d].type != BP_DEVICE_GPU || list[d].refusal[0] != '\0') continue;
        const bool known = bp_calibration_known(&list[d], &calibration);
        fprintf(page.text, "%u  " BP_HANG "%s%s\n", list[d].number,
                known ? "calibrated: "
                      : "not calibrated yet: the first render tries which --kernel is the fastest",
                known ? bp_calibration_text(&calibration, words) : "");
    }
    if (default_number != UINT32_MAX) fprintf(page.text, "* default device\n");
    bp_page_end(&page, line, stdout);
    free(table.cells);
    return BP_OK;
}

static BpStatus write_json(const BpCommandLine *line, const BpDeviceSurvey *survey, unsigned default_number,
                           BpError *err) {
    json_t *devices = json_array();
    for (size_t d = 0; d < survey->count && devices != NULL; ++d) {
        const BpDeviceInfo *info = &survey->devices[d];
        json_t *entry =
            json_pack("{s:i, s:b, s:s, s:o, s:o, s:o, s:o, s:o, s:i, s:I, s:I, s:b, s:o}", "number",
                      (int)info->number, "default", info->number == default_number, "type",
                      bp_device_type_names[info->type], "platform", bp_json_text(info->platform), "name",
                      bp_json_text(info->name), "vendor", bp_json_text(info->vendor), "version",
                      bp_json_text(info->version), "driver", bp_json_text(info->driver), "compute_units",
                      (int)info->compute_units, "memory_bytes", (json_int_t)info->memory_bytes,
                      "largest_allocation_bytes", (json_int_t)info->largest_allocation_bytes, "double",
                      info->has_double, "refusal", bp_json_text(info->refusal));
        BpCalibration calibration;
        entry = bp_json_join(entry, json_pack("{s:o}", "calibration",
                                              bp_calibration_known(info, &calibration)
                                                  ? bp_calibration_json(&calibration)
                                                  : json_null()));
        if (json_array_append_new(devices, entry) != 0) {
            json_decref(devices);
            devices = NULL;
        }
    }
    json_t *root = devices != NULL ? json_pack("{s:o, s:o}", "devices", devices, "broken_drivers",
                                               bp_device_survey_broken_json(survey))
                                   : NULL;
    return bp_json_write(line, root, line->json, err);
}

BpStatus bp_command_devices(const BpCommandLine *line, BpError *err) {
    BpDeviceSurvey survey = {0};
    double seconds = line->timeout_seconds;
    if (!bp_option_given(line, BP_OPTION_TIMEOUT)) BP_TRY(bp_driver_seconds(&seconds, err));
    if (line->json != NULL) BP_TRY(bp_line_check_output(line, line->json, err));
    bp_interrupt_catch(); /* a signal ends the child that lists, too */
    BpStatus status = bp_device_survey(seconds, line->quiet, &survey, err), shown = BP_OK;
    if (status == BP_OK) {
        /* Without a default, no device can render; then its error has the remedy. */
        BpDeviceInfo chosen;
        status = bp_device_survey_find(&survey, NULL, &chosen, err);
        if (status == BP_ERR_NO_DEVICE || status == BP_ERR_BROKEN_DEVICE) status = BP_ERR_DEVICE;
        const unsigned default_number = status == BP_OK ? chosen.number : UINT32_MAX;
        if (line->json != NULL) {
            bp_line_say_overwritten(line, line->json);
            shown = write_json(line, &survey, default_number, err);
        } else if (survey.count > 0)
            shown = print_table(line, survey.devices, survey.count, default_number, err);
    } else {
        if (line->json != NULL) { /* else the list of an earlier run would be mistaken for this one's */
            bp_line_say_overwritten(line, line->json);
            (void)write_json(line, &survey, UINT32_MAX, NULL);
        }
        if (status == BP_ERR_BROKEN_DEVICE) status = BP_ERR_DEVICE;
    }
    if (shown == BP_OK && (fflush(stdout) != 0 || ferror(stdout)))
        shown = bp_fail(err, BP_ERR_FILE, "cannot write to standard output: %s", strerror(errno));
    bp_device_survey_clear(&survey);
    return shown != BP_OK ? shown : status;
}
