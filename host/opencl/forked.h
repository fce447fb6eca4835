/* forked.h: drivers that another process has started, from which this one was forked.
 *
 * In:    numbers of processes.   Out: an error in place of a call that would wait for ever.
 * Knows: drivers keep threads, and a fork copies none of them.   Does not know: OpenCL, devices. */
#ifndef BP_OPENCL_FORKED_H
#define BP_OPENCL_FORKED_H

#include "base/status.h"

#include <stdbool.h>

/* Before any call that a driver answers: the first one notes that this process starts them. BP_ERR_DEVICE: a
 * process from which this one was forked has started them. */
BpStatus bp_drivers_use(BpError *err);

/* Whether that is so: then what belongs to a driver is left alone, since releasing it could wait for ever.
 * It goes with the process. */
bool bp_drivers_left_behind(void);

#endif
