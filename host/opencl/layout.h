/* layout.h: proof that the device's compiler lays out the packed structs as the host's does.
 *
 * Knows: kernels/scene_types.h, the probe kernel.   Does not know: what the structs mean. */
#ifndef BP_OPENCL_LAYOUT_H
#define BP_OPENCL_LAYOUT_H

#include "device.h"

/* Runs probe_layout of `program`. BP_ERR_DEVICE, naming the struct, when sizes or offsets differ. */
BpStatus bp_layout_check(BpDevice *device, cl_program program, bool single_precision, BpError *err);

#endif
