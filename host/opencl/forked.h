/* forked.h: detects drivers that a parent process had started when this one was forked.
 *
 * In:    process IDs.   Out: an error in place of a call that would wait for ever.
 * Knows: drivers keep threads, and a fork copies none of them.   Does not know: OpenCL, devices. */
#ifndef BP_OPENCL_FORKED_H
#define BP_OPENCL_FORKED_H

#include "base/status.h"

#include <stdbool.h>

/* To be called before any call into a driver; the first call records that this process starts them.
 * BP_ERR_DEVICE: a process from which this one was forked has started them. */
BpStatus bp_drivers_use(BpError *err);

/* Whether that is the case: then objects of drivers must not be released, since that could wait for ever.
 * They end with the process. */
bool bp_drivers_left_behind(void);

#endif
