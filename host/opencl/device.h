/* device.h: OpenCL contexts, and building a program for one device.
 *
 * In:    which device; source text.   Out: context, queue, program; a full build log on failure.
 * Knows: OpenCL.   Does not know: scenes, pictures. */
#ifndef BP_OPENCL_DEVICE_H
#define BP_OPENCL_DEVICE_H

#include "cl.h"
#include "device_find.h"

/* Opens the device that bp_devices_list or bp_device_find described. BP_ERR_DEVICE: it is gone, it lacks
 * something (info.refusal), or its driver failed. Close with bp_device_close(). */
BpStatus bp_device_open(const BpDeviceInfo *info, BpDevice **device, BpError *err);
/* The same for a part of a processor: at most `threads` of its compute units; 0: all. If the driver cannot
 * divide the device, all of it; device->info.compute_units is the number in use. */
BpStatus bp_device_open_part(const BpDeviceInfo *info, uint32_t threads, BpDevice **device, BpError *err);
void bp_device_close(BpDevice **device);

/* The complete build options of this device's programs, including a program's own `options` (Optional).
 * Heap; NULL: out of memory. */
char *bp_device_build_options(const BpDevice *device, const char *options);

/* Builds `source` with `options` (always -cl-std=CL1.2 first; correctly rounded quotients and roots where the
 * device has them; on NVIDIA with register counts in the log). `options`: Optional. The log, also of a
 * successful build, is written to *log when `log` is not NULL; the caller frees it. On failure the error has
 * the place of the first diagnostic, and the whole log as its attachment. Release *program with
 * clReleaseProgram(). Programs in the kernel cache (kernel_cache.h) are not compiled again. */
BpStatus bp_device_build(BpDevice *device, const char *source, const char *options, cl_program *program,
                         char **log, BpError *err);

#endif
