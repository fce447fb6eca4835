/* driver_start.h: starts the drivers once per process, in one thread and with a time limit.
 *
 * In:    BALLPARK_DRIVER_SECONDS.   Out: drivers that have started; or an error that names those which did
 * not answer.
 * Knows: OpenCL's platforms.   Does not know: which devices there are.
 *
 * The OpenCL loader loads all drivers at the first call, and a driver looks for its devices at the first
 * query. Neither is thread-safe: PoCL 3.1 reports no devices to all threads but one, or crashes. And a driver
 * that hangs would block every caller. So everything that uses OpenCL begins with bp_drivers_start(): one
 * thread makes the first calls, all others wait, and none waits for ever. */
#ifndef BP_OPENCL_DRIVER_START_H
#define BP_OPENCL_DRIVER_START_H

#include "base/status.h"

#define BP_DRIVER_SECONDS "BALLPARK_DRIVER_SECONDS"

/* The time limit for a driver to start, and to open a device: BALLPARK_DRIVER_SECONDS, by default 20; 0: no
 * limit. BP_ERR_USAGE: it has another value. */
BpStatus bp_driver_seconds(double *seconds, BpError *err);

/* Waits until all drivers have listed their devices. BP_ERR_DEVICE: some driver hangs; later calls fail too,
 * unless it has answered by then. */
BpStatus bp_drivers_start(BpError *err);

/* The same for the program. BP_ERR_BROKEN_DEVICE: some driver hangs. BP_ERR_INTERRUPTED: stop() returned true
 * (Optional; polled while this waits: long_call.h). */
BpStatus bp_drivers_start_until(bool (*stop)(void), BpError *err);

/* What a driver is doing, for a signal handler: "starting" or "opening device 0 (...)"; NULL: nothing that
 * was recorded. With several threads, the latest record. */
const char *bp_driver_doing(void);
/* Records it. `what` must stay valid until the next record; NULL: the driver has returned. */
void bp_driver_tell(const char *what);

#endif
