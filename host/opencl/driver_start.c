/* driver_start.c: see driver_start.h. */
#include "driver_start.h"

#include "base/decimal.h"
#include "base/long_call.h"
#include "cl.h"
#include "driver_files.h"
#include "forked.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SECONDS_DEFAULT 20.0

/* Global, since the loader and the drivers belong to the process. */
static pthread_mutex_t start_mutex = PTHREAD_MUTEX_INITIALIZER;
static BpLongCall *start; /* NULL: not started yet; it is kept */
static pthread_mutex_t asked_mutex = PTHREAD_MUTEX_INITIALIZER;
static char asked[128]; /* the platform that is to list its devices; "": the loader is to list platforms */

BpStatus bp_driver_seconds(double *seconds, BpError *err) {
    const char *text = getenv(BP_DRIVER_SECONDS);
    *seconds = SECONDS_DEFAULT;
    if (text == NULL || text[0] == '\0') return BP_OK;
    const char *end = bp_decimal_parse(text, seconds);
    if (end != NULL && *end == '\0' && *seconds >= 0 && *seconds <= 1e6) return BP_OK;
    return bp_fail(err, BP_ERR_USAGE,
                   BP_DRIVER_SECONDS
                   " is \"%.40s\"; expected a number of seconds up to 1000000, 0 for no limit, or leave "
                   "it unset",
                   text);
}

/* Read by the signal handler for a driver's fault. */
static _Atomic(const char *) doing;

const char *bp_driver_doing(void) {
    return doing;
}

void bp_driver_tell(const char *what) {
    doing = what;
}

static void note_platform(cl_platform_id platform) {
    char name[sizeof asked] = "";
    if (clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof name, name, NULL) != CL_SUCCESS) name[0] = '\0';
    pthread_mutex_lock(&asked_mutex);
    memcpy(asked, name, sizeof asked);
    pthread_mutex_unlock(&asked_mutex);
}

/* Failures are ignored here: they will recur when the devices are listed. */
static void ask(void *nothing) {
    cl_platform_id platforms[BP_DRIVERS_MAX];
    cl_uint count = 0;
    (void)nothing;
    bp_driver_tell("starting");
    if (clGetPlatformIDs(BP_DRIVERS_MAX, platforms, &count) != CL_SUCCESS) count = 0;
    for (cl_uint p = 0; p < count && p < BP_DRIVERS_MAX; ++p) {
        cl_uint devices = 0;
        note_platform(platforms[p]);
        clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, 0, NULL, &devices);
    }
    bp_driver_tell(NULL);
}

/* "/etc/OpenCL/vendors/some.icd (libsome.so), ..." of all drivers. */
static void name_suspects(char *text, size_t size) {
    BpDriverFiles *drivers = malloc(sizeof *drivers);
    char library[256];
    text[0] = '\0';
    if (drivers == NULL) return;
    bp_driver_files_find(drivers);
    for (size_t d = 0; d < drivers->count; ++d) {
        const size_t used = strlen(text);
        bp_driver_files_library(drivers->files[d], library);
        snprintf(text + used, size - used, "%s%.200s (%.80s)", d == 0 ? "" : ", ", drivers->files[d],
                 library);
    }
    free(drivers);
}

static BpStatus say_hung(double seconds, BpError *err) {
    char suspects[500], platform[sizeof asked];
    name_suspects(suspects, sizeof suspects);
    pthread_mutex_lock(&asked_mutex);
    memcpy(platform, asked, sizeof platform);
    pthread_mutex_unlock(&asked_mutex);
    return bp_fail(
        err, BP_ERR_BROKEN_DEVICE,
        "an OpenCL driver hangs: %s%s did not answer within %.3g s; `ballpark devices` shows which driver is "
        "to blame: %s; remove it, or set OCL_ICD_VENDORS to the .icd file of another, "
        "or " BP_DRIVER_SECONDS " to a longer time",
        platform[0] != '\0' ? "the platform " : "the loader of drivers", platform, seconds, suspects);
}

BpStatus bp_drivers_start_until(bool (*stop)(void), BpError *err) {
    double seconds;
    BP_TRY(bp_drivers_use(err));
    BP_TRY(bp_driver_seconds(&seconds, err));
    pthread_mutex_lock(&start_mutex);
    if (start == NULL) start = bp_long_call_begin(ask, NULL, NULL, seconds == 0);
    BpLongCall *begun = start;
    pthread_mutex_unlock(&start_mutex);
    if (begun == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the start of the OpenCL drivers");
    if (bp_long_call_wait(begun, seconds, stop)) return BP_OK;
    return stop != NULL && stop()
               ? bp_fail(err, BP_ERR_INTERRUPTED, "interrupted while the OpenCL drivers started")
               : say_hung(seconds, err);
}

BpStatus bp_drivers_start(BpError *err) {
    const BpStatus status = bp_drivers_start_until(NULL, err);
    if (status != BP_ERR_BROKEN_DEVICE) return status;
    if (err != NULL) err->code = BP_ERR_DEVICE; /* the difference matters to the program alone */
    return BP_ERR_DEVICE;
}
