/* device_choose.h: chooses a device of a list by a text.
 *
 * In:    a list of devices, a text as bp_device_find() takes it.
 * Out:   one of them, or a message that lists them.
 * Knows: what devices report.   Does not know: OpenCL. */
#ifndef BP_OPENCL_DEVICE_CHOOSE_H
#define BP_OPENCL_DEVICE_CHOOSE_H

#include "base/status.h"

#define BP_NO_DEVICE_REMEDY                                                                                  \
    "install an OpenCL driver: your GPU vendor's, or `apt install pocl-opencl-icd` to use the processor; "   \
    "`clinfo` shows what is there"

/* As bp_device_find() of ballpark.h, among the `count` devices of a list, which is not empty. `text`:
 * Optional. BP_ERR_NO_DEVICE: no device or several match, or none can render; BP_ERR_BROKEN_DEVICE: the one
 * that matches cannot render. */
BpStatus bp_device_choose(const BpDeviceInfo *list, size_t count, const char *text, BpDeviceInfo *device,
                          BpError *err);

#endif
