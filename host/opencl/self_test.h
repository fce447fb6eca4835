/* self_test.h: known-answer tests that a device must pass before it renders.
 *
 * In:    an open device.   Out: nothing, or a message that names what it computes wrongly.
 * Knows: OpenCL, kernels/entry/self_test.cl.   Does not know: scenes, pictures.
 *
 * Integers (random numbers and fixed-point sums rest on them), rounding, fused and unfused products,
 * quotients and square roots within OpenCL's bounds, and rounded correctly where kernels use them, NaN and
 * infinities, vector lanes, loops with private arrays. It takes a fraction of a second, most of it
 * the compiler's, and is remembered. */
#ifndef BP_OPENCL_SELF_TEST_H
#define BP_OPENCL_SELF_TEST_H

#include "device.h"

/* The kernel files that the test's program is made of, in their order. */
#define BP_SELF_TEST_FILES 7
extern const char *const bp_self_test_files[BP_SELF_TEST_FILES];

/* Runs the self-test. BP_ERR_DEVICE: the message names the device, its driver, the first failure, and the
 * number of others. BP_ERR_BUILD, BP_ERR_MEMORY: it could not run. `kernel_text`: Optional, takes the place
 * of kernels/entry/self_test.cl (tests break it). */
BpStatus bp_self_test_run(BpDevice *device, const char *kernel_text, BpError *err);

/* Runs the self-test unless this device, driver, program version and test passed before, built with the same
 * options. What passed is remembered in $XDG_CACHE_HOME/ballpark or ~/.cache/ballpark; where that cannot be
 * written, the test runs every time. A failure is never remembered. *ran: whether it ran now; `ran`:
 * Optional. */
BpStatus bp_self_test_once(BpDevice *device, bool *ran, BpError *err);

/* The file that records that this device has passed; heap. NULL: the environment names no folder for caches.
 */
char *bp_self_test_memory_path(const BpDevice *device);

#endif
