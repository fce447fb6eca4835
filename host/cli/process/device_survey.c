/* device_survey.c: see device_survey.h. */
#include "device_survey.h"

#include "base/escape.h"
#include "base/json_text.h"
#include "child_process.h"
#include "interrupt.h"
#include "opencl/device_choose.h"
#include "opencl/driver_files.h"
#include "opencl/driver_start.h"

#include "cli/terminal/page.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- asking ------------------------------------------------------------------------------------------- */

/* `argument`: Optional, the folder of the drivers' files. */
static bool list_in_child(void *argument, FILE *out) {
    BpDeviceInfo *list = NULL;
    size_t count = 0;
    BpError err = {0};
    if (argument != NULL) setenv(BP_DRIVER_VENDORS, argument, 1);
    setenv(BP_DRIVER_SECONDS, "0", 1); /* the parent has the clock */
    const BpStatus status = bp_devices_list(&list, &count, &err);
    bp_error_add_remedy(&err, BP_INTERFACE_COMMAND_LINE);
    if (status != BP_OK) fputs(err.message, out);
    const bool good = status == BP_OK && (count == 0 || fwrite(list, sizeof *list, count, out) == count);
    free(list);
    bp_error_clear(&err);
    return good;
}

/* Parses the list of a child that has finished. */
static void keep_list(BpChildReport *report, BpDeviceSurvey *survey) {
    survey->devices = (BpDeviceInfo *)(void *)report->bytes;
    survey->count = report->size / sizeof *survey->devices;
    report->bytes = NULL;
}

/* ---- a folder of drivers' files ---------------------------------------------------------------------- */

/* Puts a file that names the library of one driver into `folder`, under its number; false: see errno. */
static bool enter(const char *folder, size_t number, const char *library) {
    char path[600];
    snprintf(path, sizeof path, "%s/%03zu.icd", folder, number);
    FILE *out = fopen(path, "w");
    if (out == NULL) return false;
    const bool written = fprintf(out, "%s\n", library) > 0;
    return fclose(out) == 0 && written;
}

static void leave(const char *folder, size_t number) {
    char path[600];
    snprintf(path, sizeof path, "%s/%03zu.icd", folder, number);
    unlink(path);
}

/* ---- finding who is to blame -------------------------------------------------------------------------- */

static void name_broken(const BpBrokenDriver *driver) {
    const BpCommandLine plain = {0};
    bp_say(&plain, "warning: the OpenCL driver %s (%s) is left out, as it %s", driver->file, driver->library,
           driver->failure);
}

/* Tries the drivers one by one; those that work are put into the survey's folder, the others into its list.
 */
static BpStatus try_each(const BpDriverFiles *drivers, double seconds, bool quiet, BpDeviceSurvey *survey,
                         BpError *err) {
    BpTemporaryFolder alone = {0};
    BpStatus status = bp_temporary_folder_make(&survey->folder, err);
    if (status == BP_OK) status = bp_temporary_folder_make(&alone, err);
    survey->broken = calloc(drivers->count + 1, sizeof *survey->broken);
    if (status == BP_OK && survey->broken == NULL)
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a list of %zu drivers", drivers->count);
    for (size_t d = 0; d < drivers->count && status == BP_OK && !bp_interrupted(); ++d) {
        BpChildReport report;
        char library[256];
        bp_driver_files_library(drivers->files[d], library);
        if (library[0] == '\0') continue; /* the loader finds no driver there either */
        bool written = enter(alone.path, d, library);
        if (written) status = bp_run_in_child(list_in_child, alone.path, seconds, &report, err);
        leave(alone.path, d);
        if (written && status == BP_OK) {
            free(report.bytes);
            if (report.end == BP_CHILD_DONE) written = enter(survey->folder.path, d, library);
        }
        if (!written)
            status = bp_fail(err, BP_ERR_FILE, "cannot write in the folder %s: %s", survey->folder.path,
                             strerror(errno));
        if (status != BP_OK || report.end == BP_CHILD_DONE) continue;
        BpBrokenDriver *broken = &survey->broken[survey->broken_count++];
        snprintf(broken->file, sizeof broken->file, "%s", drivers->files[d]);
        snprintf(broken->library, sizeof broken->library, "%s", library);
        snprintf(broken->failure, sizeof broken->failure, "%s", report.failure);
        if (!quiet) name_broken(broken);
    }
    bp_temporary_folder_remove(&alone);
    return status;
}

/* `failure`: the result of trying all at once. */
static BpStatus survey_each(double seconds, bool quiet, const char *failure, BpDeviceSurvey *survey,
                            BpError *err) {
    BpChildReport report;
    BpDriverFiles *drivers = malloc(sizeof *drivers);
    if (drivers == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a list of drivers");
    bp_driver_files_find(drivers);
    BpStatus status = BP_OK;
    if (drivers->count > 0) status = try_each(drivers, seconds, quiet, survey, err);
    if (bp_interrupted() && status == BP_OK) status = bp_fail(err, BP_ERR_INTERRUPTED, "interrupted");
    if (status == BP_OK && survey->broken_count == 0)
        status = bp_fail(err, BP_ERR_BROKEN_DEVICE,
                         "listing the OpenCL devices %s; no single driver in %s is to blame: set "
                         "OCL_ICD_VENDORS to the .icd file of one",
                         failure, drivers->place);
    if (status == BP_OK && setenv(BP_DRIVER_VENDORS, survey->folder.path, 1) != 0)
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for the environment");
    if (status == BP_OK) status = bp_run_in_child(list_in_child, NULL, seconds, &report, err);
    if (status == BP_OK && report.end == BP_CHILD_DONE)
        keep_list(&report, survey);
    else if (status == BP_OK) {
        free(report.bytes);
        status = bp_fail(err, BP_ERR_BROKEN_DEVICE,
                         "listing the OpenCL devices %s, even without the drivers that are broken: set "
                         "OCL_ICD_VENDORS to the .icd file of one",
                         report.failure);
    }
    free(drivers);
    return status;
}

BpStatus bp_device_survey(double seconds, bool quiet, BpDeviceSurvey *survey, BpError *err) {
    BpChildReport report;
    *survey = (BpDeviceSurvey){0};
    BP_TRY(bp_run_in_child(list_in_child, NULL, seconds, &report, err));
    if (report.end == BP_CHILD_DONE) {
        keep_list(&report, survey);
        return BP_OK;
    }
    free(report.bytes);
    if (bp_interrupted()) return bp_fail(err, BP_ERR_INTERRUPTED, "interrupted");
    return survey_each(seconds, quiet, report.failure, survey, err);
}

BpStatus bp_device_survey_each(double seconds, bool quiet, BpDeviceSurvey *survey, BpError *err) {
    *survey = (BpDeviceSurvey){0};
    return survey_each(seconds, quiet, "failed", survey, err);
}

void bp_device_survey_clear(BpDeviceSurvey *survey) {
    free(survey->devices);
    free(survey->broken);
    bp_temporary_folder_remove(&survey->folder);
    *survey = (BpDeviceSurvey){0};
}

BpStatus bp_device_survey_find(const BpDeviceSurvey *survey, const char *text, BpDeviceInfo *device,
                               BpError *err) {
    BpStatus status = BP_OK;
    if (survey->count > 0)
        status = bp_device_choose(survey->devices, survey->count, text, device, err);
    else if (survey->broken_count == 0) {
        status = bp_device_find(text, device, err); /* its message has the remedy */
        if (status == BP_ERR_DEVICE) status = BP_ERR_NO_DEVICE;
    } else
        status = bp_fail(err, BP_ERR_BROKEN_DEVICE, "no OpenCL device is left");
    if (status == BP_OK || survey->broken_count == 0) return status;
    const BpBrokenDriver *first = &survey->broken[0];
    char message[sizeof((BpError *)0)->message];
    bp_error_add_remedy(err, BP_INTERFACE_COMMAND_LINE);
    snprintf(message, sizeof message, "%s", err != NULL ? err->message : "");
    return bp_fail(err, BP_ERR_BROKEN_DEVICE,
                   "%s; the driver %s (%s) %s: repair or remove it, or set OCL_ICD_VENDORS to another's .icd "
                   "file",
                   message, first->file, first->library, first->failure);
}

json_t *bp_device_survey_broken_json(const BpDeviceSurvey *survey) {
    json_t *list = json_array();
    for (size_t d = 0; d < survey->broken_count && list != NULL; ++d) {
        const BpBrokenDriver *driver = &survey->broken[d];
        json_t *entry = json_pack("{s:o, s:o, s:o}", "file", bp_json_text(driver->file), "library",
                                  bp_json_text(driver->library), "failure", bp_json_text(driver->failure));
        if (json_array_append_new(list, entry) == 0) continue;
        json_decref(list);
        list = NULL;
    }
    return list;
}
