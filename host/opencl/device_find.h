/* device_find.h: lists the devices, and what each lacks; see also ballpark.h.
 *
 * In:    what the OpenCL loader finds.   Out: BpDeviceInfo, or a message that says what to install.
 * Knows: OpenCL's platforms and devices.   Does not know: what devices are used for. */
#ifndef BP_OPENCL_DEVICE_FIND_H
#define BP_OPENCL_DEVICE_FIND_H

#include "cl.h"

/* bp_devices_list with the handle of each device in *ids; the caller frees both arrays. `ids`: Optional. */
BpStatus bp_device_ids(BpDeviceInfo **list, cl_device_id **ids, size_t *count, BpError *err);

/* True when `name` stands in the device's list of extensions. */
bool bp_device_has_extension(cl_device_id id, const char *name);

/* Whether the device offers quotients and square roots of floats that are rounded as the exact ones are (IEEE
 * 754). Every program but those of -cl-fast-relaxed-math then requests them, so that pictures have the same
 * bits; on other devices kernels round themselves (kernels/dialect/divide.cl). */
bool bp_device_rounds_quotients(cl_device_id id);

#endif
