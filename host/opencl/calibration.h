/* calibration.h: the fastest form of the kernel on a device, remembered in the user's cache.
 *
 * In:    a device's description, a calibration.   Out: the calibration, in a later process.
 * Knows: what an outcome depends on.   Does not know: how it is found (render/calibrate.h).
 *
 * Each device has a small text file, ~/.cache/ballpark/calibration-....txt, which a person can read. It holds
 * all that the outcome depends on, in words, and a checksum: a file that is damaged or does not match is
 * ignored. Pictures do not depend on it. */
#ifndef BP_OPENCL_CALIBRATION_H
#define BP_OPENCL_CALIBRATION_H

#include "base/status.h"

#include <stdbool.h>

typedef struct BpCalibration {
    BpKernelForm form;         /* BP_KERNEL_SAMPLE or BP_KERNEL_POOL; BP_KERNEL_AUTO: nothing was found */
    uint32_t local_size;       /* work-items in a work-group */
    uint32_t samples_per_item; /* pixel samples of a work-item, on average; 1 in the sample form */
    double gain;               /* its speed, as a multiple of that without calibration */
} BpCalibration;

/* Loads the calibration of the device, if it was found with the same kernels, of which `kernels` is a hash.
 */
bool bp_calibration_recall(const BpDeviceInfo *device, uint64_t kernels, BpCalibration *calibration);
/* Saves it; if that fails, it is not remembered. */
void bp_calibration_keep(const BpDeviceInfo *device, uint64_t kernels, const BpCalibration *calibration);

#endif
