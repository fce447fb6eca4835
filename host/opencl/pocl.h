/* pocl.h: what PoCL, the OpenCL driver of processors, needs from the system and does not say when it is
 * missing.
 *
 * In:    the environment.   Out: what is missing, and the remedy, as text.
 * Knows: PoCL's cache folder, and that it calls a linker.   Does not know: scenes, kernels. */
#ifndef BP_OPENCL_POCL_H
#define BP_OPENCL_POCL_H

#include "device.h"

#define BP_POCL_PLATFORM "Portable Computing Language"

/* Whether PoCL cannot write its folder for compiled kernels, without which it offers no device or builds
 * nothing; then `text` says so, names the folder and the remedy. Creates the folder as PoCL would. */
bool bp_pocl_cache_fails(char text[512]);

/* Whether a folder of PATH has a linker. Without one most versions of PoCL end the process when they finish a
 * kernel; some need none. */
bool bp_pocl_finds_linker(void);
/* Builds and runs a kernel that no cache can have. Where PoCL finds no linker this may end the process. */
BpStatus bp_pocl_try_kernel(const BpDeviceInfo *info, BpError *err);

#endif
