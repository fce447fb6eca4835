/* device.h: OpenCL platforms, devices, contexts, and building a program for one device.
 *
 * In:    which device; source text.   Out: context, queue, program; a full build log on failure.
 * Knows: OpenCL.   Does not know: scenes, pictures. */
#ifndef BP_OPENCL_DEVICE_H
#define BP_OPENCL_DEVICE_H

#include "base/status.h"

#include <stdbool.h>

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

/* A program that an open device has built. */
typedef struct BpBuilt {
    uint64_t key; /* hash of source and build options */
    cl_program program;
    char *log; /* "" when the driver said nothing */
} BpBuilt;

typedef struct BpDevice {
    BpDeviceInfo info; /* compute_units: those that may be used */
    cl_device_id id;
    BpBuilt *built; /* kept while the device is open, so that equal programs are built once */
    size_t built_count;
    cl_context context;
    cl_command_queue queue; /* in order, with profiling */
} BpDevice;

/* bp_devices_list with the handle of each device in *ids; the caller frees both arrays. `ids`: Optional. */
BpStatus bp_device_ids(BpDeviceInfo **list, cl_device_id **ids, size_t *count, BpError *err);

/* Opens the device that bp_devices_list or bp_device_find described. BP_ERR_DEVICE: it is gone, it lacks
 * something (info.refusal), or its driver failed. Close with bp_device_close(). */
BpStatus bp_device_open(const BpDeviceInfo *info, BpDevice **device, BpError *err);
/* The same for a part of a processor: at most `threads` of its compute units; 0: all. Where the driver cannot
 * divide the device, all of it; device->info.compute_units tells. */
BpStatus bp_device_open_part(const BpDeviceInfo *info, uint32_t threads, BpDevice **device, BpError *err);
void bp_device_close(BpDevice **device);

/* "CL_OUT_OF_RESOURCES" for -5, and so on; never NULL. */
const char *bp_cl_error_name(cl_int code);
/* bp_fail with the name of the call, the error's name and, for the common ones, what to do about it.
 * `device`: Optional; named in the message. */
BpStatus bp_cl_fail(BpError *err, cl_int code, const char *call, const BpDevice *device);

/* True when `name` stands in the device's list of extensions. */
bool bp_device_has_extension(cl_device_id id, const char *name);

/* Whether the device offers quotients and square roots of floats that are rounded as the exact ones are
 * (IEEE 754). Every program but those of -cl-fast-relaxed-math then asks for them, so that pictures have the
 * same bits; on other devices kernels round themselves (kernels/dialect/divide.cl). */
bool bp_device_rounds_quotients(cl_device_id id);

/* The complete build options of this device's programs, including a program's own `options` (Optional).
 * Heap; NULL: out of memory. */
char *bp_device_build_options(const BpDevice *device, const char *options);

/* Builds `source` with `options` (always -cl-std=CL1.2 first; correctly rounded quotients and roots where the
 * device has them; NVIDIA's compiler is asked for its register counts). `options`: Optional. The log, also of
 * a successful build, is written to *log when `log` is not NULL; the caller frees it. On failure the error
 * carries the place of the first complaint, and the whole log as its attachment. Release *program with
 * clReleaseProgram(). What the kernel cache holds (kernel_cache.h) is not compiled again. */
BpStatus bp_device_build(BpDevice *device, const char *source, const char *options, cl_program *program,
                         char **log, BpError *err);

#endif
