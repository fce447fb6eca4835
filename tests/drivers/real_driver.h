/* real_driver.h: what the driver itself answers, for libraries that are loaded before the program
 * (LD_PRELOAD) and change some of its answers.
 *
 * Knows: clGetDeviceInfo.   Does not know: which answers are changed. */
#ifndef REAL_DRIVER_H
#define REAL_DRIVER_H

#ifndef _GNU_SOURCE
#error "RTLD_NEXT needs _GNU_SOURCE"
#endif
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <stddef.h>

typedef cl_int DeviceInfo(cl_device_id, cl_device_info, size_t, void *, size_t *);

/* As clGetDeviceInfo, which the including file replaces. */
static inline cl_int real_device_info(cl_device_id device, cl_device_info what, size_t size, void *to,
                                      size_t *size_ret) {
    void *const next = dlsym(RTLD_NEXT, "clGetDeviceInfo");
    DeviceInfo *ask;
    *(void **)&ask = next;
    return ask(device, what, size, to, size_ret);
}

#endif
