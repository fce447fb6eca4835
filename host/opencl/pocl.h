/* pocl.h: requirements of PoCL, the OpenCL driver of processors, that it does not report when they are
 * missing.
 *
 * In:    the environment, the processor's name.   Out: what is missing, and the remedy, as text.
 * Knows: PoCL's cache folder, that it calls a linker, how it names processors.   Does not know: scenes,
 * kernels. */
#ifndef BP_OPENCL_POCL_H
#define BP_OPENCL_POCL_H

#include "base/status.h"

#include <stdbool.h>

#define BP_POCL_PLATFORM "Portable Computing Language"

/* Whether PoCL cannot write its folder for compiled kernels, without which it offers no device or builds
 * nothing; then `text` reports that, with the folder and the remedy. Creates the folder as PoCL would. */
bool bp_pocl_cache_fails(char text[512]);

/* Whether a folder of PATH has a linker. Without one most versions of PoCL end the process when they finish a
 * kernel; some need none. */
bool bp_pocl_finds_linker(void);

/* Whether PoCL has no working compiler for this processor. Before 3.1 it uses its compiler's name of the
 * processor. If the compiler is older than the processor, kernels may use fewer instructions than PoCL's own
 * functions: then the compiler ends the process or takes all memory. `model`: the processor's name in
 * /proc/cpuinfo. */
bool bp_pocl_is_too_old(const char *driver, const char *name, const char *model);
/* The same for a device on this machine. */
bool bp_pocl_fails_here(const BpDeviceInfo *info);

#endif
