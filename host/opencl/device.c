/* device.c: opening a device and building programs for it; see device.h. */
#include "device.h"

#include "base/clock.h"
#include "base/long_call.h"
#include "driver_start.h"
#include "forked.h"
#include "kernel_cache.h"
#include "pocl.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Replaces the device by a part of it with `units` compute units (OpenCL 1.2, 4.3). Leaves it whole if the
 * driver refuses. The part is never released, which costs about a kilobyte each time a device is opened in
 * this way: a thread of PoCL still reads it after clFinish, while it releases the last event
 * (pocl/pocl#1229). When the part was released, a quarter of the runs ended in a segmentation fault. */
static void take_part(BpDevice *device, uint32_t units) {
    const cl_device_partition_property by_counts[] = {CL_DEVICE_PARTITION_BY_COUNTS,
                                                      (cl_device_partition_property)units,
                                                      CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
    cl_device_id part = NULL;
    cl_uint count = 0;
    if (device->info.type != BP_DEVICE_CPU || units >= device->info.compute_units) return;
    if (clCreateSubDevices(device->id, by_counts, 1, &part, &count) != CL_SUCCESS || count != 1) return;
    device->id = part;
    device->info.compute_units = units;
}

/* The calls into the driver that open a device. */
typedef struct Opening {
    cl_device_id id;
    cl_context context;
    cl_command_queue queue;
    cl_int code;
    const char *call; /* that gave the code */
    char what[600];   /* "opening device 0 (...)" */
} Opening;

static void open_device(Opening *opening) {
    cl_platform_id platform = NULL;
    opening->call = "clGetDeviceInfo(CL_DEVICE_PLATFORM)";
    opening->code = clGetDeviceInfo(opening->id, CL_DEVICE_PLATFORM, sizeof platform, &platform, NULL);
    if (opening->code != CL_SUCCESS) return;
    const cl_context_properties properties[] = {CL_CONTEXT_PLATFORM, (cl_context_properties)platform, 0};
    opening->call = "clCreateContext";
    opening->context = clCreateContext(properties, 1, &opening->id, NULL, NULL, &opening->code);
    if (opening->code != CL_SUCCESS) return;
    opening->call = "clCreateCommandQueue";
    opening->queue =
        clCreateCommandQueue(opening->context, opening->id, CL_QUEUE_PROFILING_ENABLE, &opening->code);
}

static void ask_to_open(void *argument) {
    Opening *opening = argument;
    bp_driver_tell(opening->what);
    open_device(opening);
    bp_driver_tell(NULL);
}

static void release_opening(void *argument) {
    Opening *opening = argument;
    if (opening->queue != NULL) clReleaseCommandQueue(opening->queue);
    if (opening->context != NULL) clReleaseContext(opening->context);
    free(opening);
}

/* Context and queue, unless the driver hangs (driver_start.h). */
static BpStatus open_within_limit(BpDevice *device, BpError *err) {
    double seconds;
    BP_TRY(bp_driver_seconds(&seconds, err));
    Opening *opening = calloc(1, sizeof *opening);
    if (opening == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "no memory to open device %u", device->info.number);
    opening->id = device->id;
    snprintf(opening->what, sizeof opening->what, "opening device %u (%s, %s, driver %s)",
             device->info.number, device->info.name, device->info.platform, device->info.driver);
    BpLongCall *call = bp_long_call_begin(ask_to_open, opening, release_opening, seconds == 0);
    if (call == NULL) {
        free(opening);
        return bp_fail(err, BP_ERR_MEMORY, "no memory to open device %u", device->info.number);
    }
    BpStatus status = BP_OK;
    if (!bp_long_call_wait(call, seconds, NULL)) {
        status = bp_fail(
            err, BP_ERR_DEVICE,
            "device %u (%s, %s, driver %s) hangs: it could not be opened within %.3g s; choose another "
            "one, or set " BP_DRIVER_SECONDS " to a longer time",
            device->info.number, device->info.name, device->info.platform, device->info.driver, seconds);
    } else if (opening->code != CL_SUCCESS) {
        status = bp_cl_fail(err, opening->code, opening->call, device);
    } else {
        device->context = opening->context;
        device->queue = opening->queue;
        opening->context = NULL;
        opening->queue = NULL;
    }
    bp_long_call_leave(call);
    return status;
}

BpStatus bp_device_open(const BpDeviceInfo *info, BpDevice **device, BpError *err) {
    return bp_device_open_part(info, 0, device, err);
}

BpStatus bp_device_open_part(const BpDeviceInfo *info, uint32_t threads, BpDevice **device, BpError *err) {
    BpStatus status;
    BpDeviceInfo *list = NULL;
    cl_device_id *ids = NULL;
    size_t count = 0;
    BpDevice *opened = NULL;
    *device = NULL;

    BP_TRY_GOTO(status, bp_device_ids(&list, &ids, &count, err), cleanup);
    /* The number alone could mean another device by now, if a driver was installed or a card removed. */
    if (info->number >= count || strcmp(list[info->number].name, info->name) != 0 ||
        strcmp(list[info->number].platform, info->platform) != 0) {
        status = bp_fail_with(BP_REMEDY_OTHER_DEVICE, err, BP_ERR_DEVICE, "device %u (%s) is no longer there",
                              info->number, info->name);
        goto cleanup;
    }
    if (list[info->number].refusal[0] != '\0') {
        status = bp_fail(err, BP_ERR_DEVICE, "device %u (%s) cannot render: %s", info->number, info->name,
                         list[info->number].refusal);
        goto cleanup;
    }
    opened = calloc(1, sizeof *opened);
    if (opened == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "no memory to open device %u", info->number);
        goto cleanup;
    }
    opened->info = list[info->number];
    opened->id = ids[info->number];
    if (threads > 0) take_part(opened, threads);
    BP_TRY_GOTO(status, open_within_limit(opened, err), cleanup);
    *device = opened;
    opened = NULL;
    status = BP_OK;

cleanup:
    bp_device_close(&opened);
    free(list);
    free(ids);
    return status;
}

static void release_objects(BpDevice *device) {
    if (device->queue != NULL) {
        clFinish(device->queue);
        clReleaseCommandQueue(device->queue);
    }
    for (size_t i = 0; i < device->built_count; ++i) clReleaseProgram(device->built[i].program);
    if (device->context != NULL) clReleaseContext(device->context);
}

void bp_device_close(BpDevice **device) {
    if (*device == NULL) return;
    if (!bp_drivers_left_behind()) release_objects(*device);
    for (size_t i = 0; i < (*device)->built_count; ++i) free((*device)->built[i].log);
    free((*device)->built);
    free(*device);
    *device = NULL;
}

/* The program's build log; "" if the driver has none; NULL: out of memory. */
static char *fetch_log(const BpDevice *device, cl_program program) {
    size_t size = 0;
    if (clGetProgramBuildInfo(program, device->id, CL_PROGRAM_BUILD_LOG, 0, NULL, &size) != CL_SUCCESS)
        size = 0;
    char *text = calloc(1, size + 1);
    if (text == NULL || size == 0) return text;
    if (clGetProgramBuildInfo(program, device->id, CL_PROGRAM_BUILD_LOG, size, text, NULL) != CL_SUCCESS)
        text[0] = '\0';
    return text;
}

/* Finds the first error in the log. Compilers built on Clang write "file:line:column: error: text", PoCL
 * "error: file:line:column: text". True when found; `file` and `text` end at the next colon or line. */
static bool first_complaint(const char *log, char file[128], int *line, int *column, char text[256]) {
    for (const char *at = log; at != NULL && *at != '\0';) {
        const char *end = strchr(at, '\n');
        const size_t length = end != NULL ? (size_t)(end - at) : strlen(at);
        char row[512];
        snprintf(row, sizeof row, "%.*s", (int)(length < sizeof row ? length : sizeof row - 1), at);
        const char *place = NULL, *complaint = NULL;
        const char *mark = strstr(row, "error: ");
        if (mark != NULL) {
            const char *after = mark + strlen("error: ");
            if (sscanf(after, "%127[^: ]:%d:%d", file, line, column) == 3) {
                place = after;
                complaint = strstr(after, ": ");
            } else if (sscanf(row, "%127[^: ]:%d:%d", file, line, column) == 3) {
                place = row;
                complaint = after - 2;
            }
        }
        if (place != NULL && complaint != NULL) {
            snprintf(text, 256, "%s", complaint + 2);
            return true;
        }
        at = end != NULL ? end + 1 : NULL;
    }
    return false;
}

static BpStatus build_failure(const BpDevice *device, cl_int code, const char *log, BpError *err) {
    char file[128], text[256], fault[512];
    int line = 0, column = 0;
    if (code != CL_BUILD_PROGRAM_FAILURE && (log == NULL || log[0] == '\0'))
        return bp_cl_fail(err, code, "clBuildProgram", device);
    if (log != NULL && first_complaint(log, file, &line, &column, text)) {
        bp_fail(err, BP_ERR_BUILD, "the kernel does not compile for %s (driver %s): %s", device->info.name,
                device->info.driver, text);
        bp_error_at(err, file, line, column);
    } else if (strcmp(device->info.platform, BP_POCL_PLATFORM) == 0 && bp_pocl_cache_fails(fault)) {
        bp_fail(err, BP_ERR_BUILD, "the kernel does not compile for %s: %s", device->info.name, fault);
    } else {
        bp_fail(err, BP_ERR_BUILD, "the kernel does not compile for %s (driver %s): %s", device->info.name,
                device->info.driver, bp_cl_error_name(code));
    }
    if (log != NULL && log[0] != '\0') bp_error_attach(err, log);
    return BP_ERR_BUILD;
}

/* Processes that compile at the same time into an empty cache disturb each other in PoCL 3.1: about one build
 * in sixty fails, without a compiler message, if eight do so on two cores. The next attempt succeeds. */
#define POCL_ATTEMPTS 8

/* Whether a build failed for a transient reason, not because of its source. */
static bool may_pass(const BpDevice *device, cl_int code, const char *log) {
    char file[128], text[256];
    int line, column;
    return code == CL_BUILD_PROGRAM_FAILURE && strcmp(device->info.platform, BP_POCL_PLATFORM) == 0 &&
           (log == NULL || !first_complaint(log, file, &line, &column, text));
}

char *bp_device_build_options(const BpDevice *device, const char *options) {
    if (options == NULL) options = "";
    /* -cl-nv-verbose makes NVIDIA's compiler put register and stack sizes into the log. */
    const char *verbose =
        bp_device_has_extension(device->id, "cl_nv_compiler_options") ? " -cl-nv-verbose" : "";
    const char *rounded =
        bp_device_rounds_quotients(device->id) && strstr(options, "-cl-fast-relaxed-math") == NULL
            ? " -cl-fp32-correctly-rounded-divide-sqrt"
            : "";
    const size_t size = strlen("-cl-std=CL1.2 ") + strlen(options) + strlen(rounded) + strlen(verbose) + 1;
    char *all = malloc(size);
    if (all != NULL)
        snprintf(all, size, "-cl-std=CL1.2%s%s%s%s", rounded, verbose, options[0] != '\0' ? " " : "",
                 options);
    return all;
}

BpStatus bp_device_build(BpDevice *device, const char *source, const char *options, cl_program *program,
                         char **log, BpError *err) {
    BpStatus status = BP_OK;
    cl_program built = NULL;
    char *all_options = NULL, *text = NULL;
    BpKernelCacheMode cache = BP_KERNEL_CACHE_OFF;
    *program = NULL;
    if (log != NULL) *log = NULL;
    BP_TRY(bp_kernel_cache_mode(&cache, err));

    all_options = bp_device_build_options(device, options);
    if (all_options == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "no memory to build a kernel");
        goto cleanup;
    }
    if (cache != BP_KERNEL_CACHE_OFF) built = bp_kernel_cache_load(device, source, all_options, &text);
    if (built != NULL) goto done;

    cl_int code;
    double seconds;
    for (int attempt = 1;; attempt++) {
        built = clCreateProgramWithSource(device->context, 1, &source, NULL, &code);
        if (code != CL_SUCCESS) {
            status = bp_cl_fail(err, code, "clCreateProgramWithSource", device);
            goto cleanup;
        }
        const double start = bp_processor_seconds();
        code = clBuildProgram(built, 1, &device->id, all_options, NULL, NULL);
        seconds = bp_processor_seconds() - start;
        text = fetch_log(device, built);
        if (code == CL_SUCCESS || attempt == POCL_ATTEMPTS || !may_pass(device, code, text)) break;
        clReleaseProgram(built);
        built = NULL;
        free(text);
    }
    if (code != CL_SUCCESS) {
        status = build_failure(device, code, text, err);
        goto cleanup;
    }
    if (bp_kernel_cache_wants(device, cache, seconds))
        bp_kernel_cache_store(device, source, all_options, built, text, BP_KERNEL_CACHE_BYTES_MAX);

done:
    *program = built;
    built = NULL;
    if (log != NULL) {
        *log = text;
        text = NULL;
    }

cleanup:
    if (built != NULL) clReleaseProgram(built);
    free(all_options);
    free(text);
    return status;
}
