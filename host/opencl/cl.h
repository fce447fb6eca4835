/* cl.h: OpenCL's header, an open device, and the errors of OpenCL's calls.
 *
 * In:    an error code.   Out: a message.
 * Knows: OpenCL's version, its errors.   Does not know: how a device is opened (device.h). */
#ifndef BP_OPENCL_CL_H
#define BP_OPENCL_CL_H

#include "base/status.h"

#include <stdbool.h>

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

/* A program that an open device has built. */
typedef struct BpBuilt {
    uint64_t key; /* hash of source and build options */
    cl_program program;
    char *log; /* "" if the driver wrote none */
} BpBuilt;

typedef struct BpDevice {
    BpDeviceInfo info; /* compute_units: those that may be used */
    cl_device_id id;
    BpBuilt *built; /* kept while the device is open, so that equal programs are built once */
    size_t built_count;
    cl_context context;
    cl_command_queue queue; /* in order, with profiling */
} BpDevice;

/* "CL_OUT_OF_RESOURCES" for -5, and so on; never NULL. */
const char *bp_cl_error_name(cl_int code);
/* bp_fail() with the name of the call, the name of the error and, for common ones, a remedy. `device`:
 * Optional; named in the message. */
BpStatus bp_cl_fail(BpError *err, cl_int code, const char *call, const BpDevice *device);

#endif
