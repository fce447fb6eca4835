/* kernel_cache.h: compiled programs, kept in the user's cache.
 *
 * In:    a device, a source, its options, and the built program.   Out: the program, in a later process.
 * Knows: OpenCL's program binaries, files.   Does not know: what a program computes.
 *
 * Programs lie in $XDG_CACHE_HOME/ballpark/kernels or ~/.cache/ballpark/kernels, a file each, which no other
 * user can write. A file holds the source, the options, and in words the device, its driver and those
 * properties of the processor and the environment on which a compiler depends: it is used only if all of
 * these match, and a checksum covers it. So a damaged or wrong file merely costs a build, and so does a
 * folder that cannot be read or written. Files appear whole, so processes need not wait for each other.
 * Beyond the folder's size limit, the least recently used programs are removed.
 *
 * PoCL keeps programs itself. Of other drivers, only programs that took long to build are kept: a driver with
 * a cache of its own builds them in no time when it gets them again. BALLPARK_KERNEL_CACHE=on keeps programs
 * in any case, =off never. */
#ifndef BP_OPENCL_KERNEL_CACHE_H
#define BP_OPENCL_KERNEL_CACHE_H

#include "cl.h"

#define BP_KERNEL_CACHE_BYTES_MAX (256u << 20)

typedef enum BpKernelCacheMode {
    BP_KERNEL_CACHE_AUTO, /* programs that took long, except PoCL's */
    BP_KERNEL_CACHE_ON,
    BP_KERNEL_CACHE_OFF
} BpKernelCacheMode;

/* Reads BALLPARK_KERNEL_CACHE: "on", "off" or, without it, automatic. BP_ERR_USAGE: another value. */
BpStatus bp_kernel_cache_mode(BpKernelCacheMode *mode, BpError *err);

/* The program, built for `device`, with its build log in *log, heap; NULL if the cache has none that can be
 * used. `options`: everything that clBuildProgram gets. `log`: Optional. */
cl_program bp_kernel_cache_load(const BpDevice *device, const char *source, const char *options, char **log);

/* Stores a program that clBuildProgram has just built. A failure is ignored. The folder's programs are then
 * brought below `bytes_max`. */
void bp_kernel_cache_store(const BpDevice *device, const char *source, const char *options,
                           cl_program program, const char *log, uint64_t bytes_max);

/* Whether programs that took `build_seconds` of the processor are to be kept, in this mode. */
bool bp_kernel_cache_wants(const BpDevice *device, BpKernelCacheMode mode, double build_seconds);

/* The path of the program's file, heap; NULL without a home for caches. For tests. */
char *bp_kernel_cache_path(const BpDevice *device, const char *source, const char *options);

#endif
