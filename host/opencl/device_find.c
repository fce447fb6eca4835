/* device_find.c: see device_find.h. */
#include "device_find.h"

#include "base/memory_limit.h"
#include "device_choose.h"
#include "driver_start.h"
#include "forked.h"
#include "pocl.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- asking OpenCL ------------------------------------------------------------------------------------ */

/* Copies `from` without white space at its ends: drivers pad names. */
static void copy_trimmed(char *to, size_t size, const char *from) {
    while (isspace((unsigned char)*from)) ++from;
    size_t length = strlen(from);
    while (length > 0 && isspace((unsigned char)from[length - 1])) --length;
    if (length >= size) length = size - 1;
    memcpy(to, from, length);
    to[length] = '\0';
}

/* A text property of the device, heap; "" if it has none, NULL: out of memory. */
static char *device_text(cl_device_id id, cl_device_info what) {
    size_t size = 0;
    if (clGetDeviceInfo(id, what, 0, NULL, &size) != CL_SUCCESS) size = 0;
    char *text = calloc(1, size + 1);
    if (text == NULL || size == 0) return text;
    if (clGetDeviceInfo(id, what, size, text, NULL) != CL_SUCCESS) text[0] = '\0';
    return text;
}

/* false: out of memory, which is not the device's answer. */
static bool device_text_into(cl_device_id id, cl_device_info what, char *to, size_t size) {
    char *text = device_text(id, what);
    const bool known = text != NULL;
    copy_trimmed(to, size, known ? text : "");
    free(text);
    return known;
}

static void platform_name(cl_platform_id platform, char *to, size_t size) {
    char text[256] = "";
    if (clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof text, text, NULL) != CL_SUCCESS) text[0] = '\0';
    text[sizeof text - 1] = '\0';
    copy_trimmed(to, size, text[0] != '\0' ? text : "a platform without a name");
}

static bool device_flag(cl_device_id id, cl_device_info what) {
    cl_bool flag = CL_FALSE;
    return clGetDeviceInfo(id, what, sizeof flag, &flag, NULL) == CL_SUCCESS && flag != CL_FALSE;
}

static uint64_t device_ulong(cl_device_id id, cl_device_info what) {
    cl_ulong number = 0;
    return clGetDeviceInfo(id, what, sizeof number, &number, NULL) == CL_SUCCESS ? number : 0;
}

static unsigned device_uint(cl_device_id id, cl_device_info what) {
    cl_uint number = 0;
    return clGetDeviceInfo(id, what, sizeof number, &number, NULL) == CL_SUCCESS ? number : 0;
}

bool bp_device_has_extension(cl_device_id id, const char *name) {
    char *text = device_text(id, CL_DEVICE_EXTENSIONS);
    bool found = false;
    const size_t length = strlen(name);
    for (const char *at = text; at != NULL && !found; at = strchr(at, ' ')) {
        while (*at == ' ') ++at;
        found = strncmp(at, name, length) == 0 && (at[length] == ' ' || at[length] == '\0');
        if (*at == '\0') break;
    }
    free(text);
    return found;
}

bool bp_device_rounds_quotients(cl_device_id id) {
    return (device_ulong(id, CL_DEVICE_SINGLE_FP_CONFIG) & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
}

/* Names what every kernel needs and this device lacks, as a whole phrase; "" if it lacks nothing. False: out
 * of memory. */
static bool find_lack(cl_device_id id, const BpDeviceInfo *info, char refusal[128]) {
    unsigned major = 0, minor = 0;
    char profile[64];
    if (!device_text_into(id, CL_DEVICE_PROFILE, profile, sizeof profile)) return false;
    const uint64_t single = device_ulong(id, CL_DEVICE_SINGLE_FP_CONFIG);
    refusal[0] = '\0';
    if (sscanf(info->version, "OpenCL %u.%u", &major, &minor) != 2)
        snprintf(refusal, 128, "it does not report its OpenCL version (1.2 is needed)");
    else if (major < 1 || (major == 1 && minor < 2))
        snprintf(refusal, 128, "it has OpenCL %u.%u (1.2 is needed)", major, minor);
    else if (!info->has_compiler)
        snprintf(refusal, 128, "its driver has no compiler");
    else if (!device_flag(id, CL_DEVICE_ENDIAN_LITTLE))
        snprintf(refusal, 128, "it is not little-endian");
    else if (strcmp(profile, "EMBEDDED_PROFILE") == 0 && !bp_device_has_extension(id, "cles_khr_int64"))
        snprintf(refusal, 128, "it has the embedded profile without `long` (cles_khr_int64)");
    else if ((single & CL_FP_INF_NAN) == 0)
        snprintf(refusal, 128, "its float has no infinities and NaN");
    else if ((single & CL_FP_ROUND_TO_NEAREST) == 0)
        snprintf(refusal, 128, "its float does not round to nearest");
    else if (!info->available)
        snprintf(refusal, 128, "it is not available now");
    else if (bp_pocl_fails_here(info))
        snprintf(
            refusal, 128,
            "PoCL %.16s is too old for this processor; PoCL 3.1 or Intel's driver works (docs/PYTHON.md)",
            info->driver);
    return true;
}

/* PoCL detects vectors on x86 processors only and reports one lane for all others. 64-bit ARM always has
 * vectors of four. */
static unsigned float_lanes_of(cl_device_id id, const BpDeviceInfo *info) {
    const unsigned lanes = device_uint(id, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT);
#ifdef __aarch64__
    if (lanes < 4 && info->type == BP_DEVICE_CPU && strcmp(info->platform, BP_POCL_PLATFORM) == 0) return 4;
#else
    (void)info;
#endif
    return lanes;
}

/* false: out of memory. */
static bool describe(cl_device_id id, cl_platform_id platform, unsigned number, BpDeviceInfo *info) {
    memset(info, 0, sizeof *info);
    info->number = number;
    platform_name(platform, info->platform, sizeof info->platform);
    if (!device_text_into(id, CL_DEVICE_NAME, info->name, sizeof info->name) ||
        !device_text_into(id, CL_DEVICE_VENDOR, info->vendor, sizeof info->vendor) ||
        !device_text_into(id, CL_DEVICE_VERSION, info->version, sizeof info->version) ||
        !device_text_into(id, CL_DRIVER_VERSION, info->driver, sizeof info->driver))
        return false;
    const uint64_t type = device_ulong(id, CL_DEVICE_TYPE);
    info->type = (type & CL_DEVICE_TYPE_GPU) != 0   ? BP_DEVICE_GPU
                 : (type & CL_DEVICE_TYPE_CPU) != 0 ? BP_DEVICE_CPU
                                                    : BP_DEVICE_OTHER;
    info->compute_units = device_uint(id, CL_DEVICE_MAX_COMPUTE_UNITS);
    info->float_lanes = float_lanes_of(id, info);
    info->memory_bytes = device_ulong(id, CL_DEVICE_GLOBAL_MEM_SIZE);
    info->largest_allocation_bytes = device_ulong(id, CL_DEVICE_MAX_MEM_ALLOC_SIZE);
    info->has_double = device_ulong(id, CL_DEVICE_DOUBLE_FP_CONFIG) != 0;
    info->has_compiler = device_flag(id, CL_DEVICE_COMPILER_AVAILABLE);
    info->available = device_flag(id, CL_DEVICE_AVAILABLE);
    info->clock_mhz = device_uint(id, CL_DEVICE_MAX_CLOCK_FREQUENCY);
    info->has_shared_memory = device_flag(id, CL_DEVICE_HOST_UNIFIED_MEMORY);
    return find_lack(id, info, info->refusal);
}

/* All platforms, heap; *count 0 and NULL if there is none, which is not an error. */
static BpStatus list_platforms(cl_platform_id **platforms, cl_uint *count, BpError *err) {
    *platforms = NULL;
    *count = 0;
    BP_TRY(bp_drivers_use(err));
    /* Without any driver, this loader returns CL_PLATFORM_NOT_FOUND_KHR; others return 0 platforms. */
    if (clGetPlatformIDs(0, NULL, count) != CL_SUCCESS || *count == 0) {
        *count = 0;
        return BP_OK;
    }
    *platforms = calloc(*count, sizeof **platforms);
    if (*platforms == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for a list of OpenCL platforms");
    const cl_int code = clGetPlatformIDs(*count, *platforms, NULL);
    if (code == CL_SUCCESS) return BP_OK;
    free(*platforms);
    *platforms = NULL;
    *count = 0;
    return bp_cl_fail(err, code, "clGetPlatformIDs", NULL);
}

BpStatus bp_device_ids(BpDeviceInfo **list, cl_device_id **ids, size_t *count, BpError *err) {
    BpStatus status;
    cl_platform_id *platforms = NULL;
    cl_uint platform_count = 0;
    BpDeviceInfo *infos = NULL;
    cl_device_id *handles = NULL;
    size_t found = 0;
    *list = NULL;
    if (ids != NULL) *ids = NULL;
    *count = 0;

    BP_TRY(bp_drivers_start(err));
    BP_TRY_GOTO(status, list_platforms(&platforms, &platform_count, err), cleanup);
    for (cl_uint p = 0; p < platform_count; ++p) {
        cl_uint here = 0;
        /* A platform without devices (CL_DEVICE_NOT_FOUND), or one that fails, hides no other platform. */
        if (clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, 0, NULL, &here) != CL_SUCCESS || here == 0)
            continue;
        BpDeviceInfo *more_infos = realloc(infos, (found + here) * sizeof *infos);
        if (more_infos != NULL) infos = more_infos;
        cl_device_id *more_handles = realloc(handles, (found + here) * sizeof(cl_device_id));
        if (more_handles != NULL) handles = more_handles;
        if (more_infos == NULL || more_handles == NULL) {
            status = bp_fail(err, BP_ERR_MEMORY, "no memory for a list of OpenCL devices");
            goto cleanup;
        }
        if (clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, here, handles + found, NULL) != CL_SUCCESS)
            continue;
        for (cl_uint d = 0; d < here; ++d, ++found) {
            if (describe(handles[found], platforms[p], (unsigned)found, &infos[found])) continue;
            status = bp_fail(err, BP_ERR_MEMORY, "out of memory for the description of an OpenCL device");
            goto cleanup;
        }
    }
    *list = infos;
    infos = NULL;
    *count = found;
    if (ids != NULL) {
        *ids = handles;
        handles = NULL;
    }

cleanup:
    free(platforms);
    free(infos);
    free(handles);
    return status;
}

BpStatus bp_devices_list(BpDeviceInfo **list, size_t *count, BpError *err) {
    return bp_device_ids(list, NULL, count, err);
}

/* No device at all: an error with the platforms and a remedy. */
static BpStatus fail_without_devices(BpError *err) {
    cl_platform_id *platforms = NULL;
    cl_uint count = 0;
    char names[384] = "", fault[512];
    bool pocl = false;
    BP_TRY(list_platforms(&platforms, &count, err));
    for (cl_uint p = 0; p < count; ++p) {
        char name[128];
        platform_name(platforms[p], name, sizeof name);
        pocl = pocl || strcmp(name, BP_POCL_PLATFORM) == 0;
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", p == 0 ? "" : ", ", name);
    }
    free(platforms);
    if (count == 0 && bp_memory_limit() > 0)
        return bp_fail(err, BP_ERR_DEVICE,
                       "no OpenCL platform, perhaps for lack of memory, of which this process may have %.0f "
                       "MiB (ulimit -v): "
                       "allow it more, or " BP_NO_DEVICE_REMEDY,
                       (double)bp_memory_limit() / 1048576);
    if (count == 0) return bp_fail(err, BP_ERR_DEVICE, "no OpenCL platform: " BP_NO_DEVICE_REMEDY);
    if (pocl && bp_pocl_cache_fails(fault)) return bp_fail(err, BP_ERR_DEVICE, "no OpenCL device: %s", fault);
    return bp_fail(err, BP_ERR_DEVICE,
                   "no OpenCL device (platforms without devices: %s): " BP_NO_DEVICE_REMEDY, names);
}

BpStatus bp_device_find(const char *text, BpDeviceInfo *device, BpError *err) {
    BpDeviceInfo *list = NULL;
    size_t count = 0;
    BP_TRY(bp_devices_list(&list, &count, err));
    BpStatus status =
        count > 0 ? bp_device_choose(list, count, text, device, err) : fail_without_devices(err);
    free(list);
    /* Only `check` distinguishes the two. */
    if (status == BP_ERR_NO_DEVICE || status == BP_ERR_BROKEN_DEVICE) status = BP_ERR_DEVICE;
    if (status != BP_OK && err != NULL) err->code = status;
    return status;
}
