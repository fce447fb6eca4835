/* device_survey.h: lists the devices without trusting their drivers.
 *
 * In:    the drivers' files (.icd) that the OpenCL loader reads.   Out: a list of devices; the drivers that
 * crash or hang when they list theirs.
 * Knows: child processes, where the loader looks (OCL_ICD_VENDORS). Does
 * not know: OpenCL.
 *
 * The loader loads every driver into the process that calls it, so a driver that hangs blocks that process. A
 * child process lists all devices; only if it fails, one child per driver lists its devices, with a folder
 * that holds only that driver's file. Drivers that fail are excluded from then on: OCL_ICD_VENDORS names a
 * folder of the others' files, for this process and its children. */
#ifndef BP_CLI_PROCESS_DEVICE_SURVEY_H
#define BP_CLI_PROCESS_DEVICE_SURVEY_H

#include "temporary_folder.h"

#include <jansson.h>

typedef struct BpBrokenDriver {
    char file[512];    /* "/etc/OpenCL/vendors/some.icd" */
    char library[256]; /* what the file names */
    char failure[256]; /* "crashed: Segmentation fault" */
} BpBrokenDriver;

typedef struct BpDeviceSurvey {
    BpDeviceInfo *devices;
    size_t count;
    BpBrokenDriver *broken;
    size_t broken_count;
    BpTemporaryFolder folder; /* of the other drivers' files, if one is broken */
} BpDeviceSurvey;

/* Lists the devices; broken drivers are named on standard error too, unless `quiet`. `seconds`: per attempt.
 * Call it before this process uses OpenCL. BP_ERR_BROKEN_DEVICE: no list, although no single driver fails.
 * Clear it in any case, but only after the devices have been used. */
BpStatus bp_device_survey(double seconds, bool quiet, BpDeviceSurvey *survey, BpError *err);
/* The same if loading all drivers at once is known to fail: tries each by itself. */
BpStatus bp_device_survey_each(double seconds, bool quiet, BpDeviceSurvey *survey, BpError *err);
void bp_device_survey_clear(BpDeviceSurvey *survey);

/* The device that `text` selects, as by bp_device_choose(); the error names broken drivers too. */
BpStatus bp_device_survey_find(const BpDeviceSurvey *survey, const char *text, BpDeviceInfo *device,
                               BpError *err);

/* [{"file", "library", "failure"}]. NULL: out of memory. */
json_t *bp_device_survey_broken_json(const BpDeviceSurvey *survey);

#endif
