/* calibrate.h: which arrangement of the kernel is the fastest on a GPU, found by a short trial.
 *
 * In:    a device.   Out: the form of the kernel, and how samples are shared out among its work-items.
 * Knows: worker.h, the arrangements to be tried.   Does not know: which scene is to be rendered.
 *
 * No model of a GPU is good enough to choose between one work-item a sample and a pool (docs/GPU.md). So when
 * a GPU is first used, both trace a small copy of the book's cover in groups of several sizes, which takes
 * two builds and about a second. What is found is remembered (opencl/calibration.h). Pictures do not depend
 * on it. */
#ifndef BP_RENDER_CALIBRATE_H
#define BP_RENDER_CALIBRATE_H

#include "opencl/calibration.h"
#include "opencl/device.h"

/* Whether renders with these options let a calibration decide on this device. */
bool bp_calibrates(const BpDeviceInfo *device, const BpRenderOptions *options);

/* The remembered calibration. False: there is none. */
bool bp_calibration_known(const BpDeviceInfo *device, BpCalibration *calibration);

/* The remembered calibration, or else that of a trial. `open`: Optional; the device, where it is open.
 * *seconds: the trial's, 0 without one. False: the trial has no result, because the device failed; the render
 * reports that, or uses the defaults. */
bool bp_calibrate(const BpDeviceInfo *device, BpDevice *open, bool untested, BpCalibration *calibration,
                  double *seconds);

#endif
