/* pocl_probe.h: tests whether PoCL can compile on this machine.
 *
 * In:    a device of PoCL.   Out: that a kernel was built and has run, or an error.
 * Knows: devices, programs.   Does not know: what PoCL needs (pocl.h). */
#ifndef BP_OPENCL_POCL_PROBE_H
#define BP_OPENCL_POCL_PROBE_H

#include "base/status.h"

/* Builds and runs a kernel that cannot be in any cache. Where PoCL finds no linker this may end the process.
 */
BpStatus bp_pocl_try_kernel(const BpDeviceInfo *info, BpError *err);

#endif
