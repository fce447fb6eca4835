/* forked.c: see forked.h. */
#include "forked.h"

#include <stdatomic.h>
#include <unistd.h>

/* The process that has started the drivers; 0: none. A fork copies this, as it copies the drivers. */
static atomic_long owner;

bool bp_drivers_left_behind(void) {
    const long process = atomic_load(&owner);
    return process != 0 && process != (long)getpid();
}

BpStatus bp_drivers_use(BpError *err) {
    long none = 0;
    atomic_compare_exchange_strong(&owner, &none, (long)getpid());
    if (!bp_drivers_left_behind()) return BP_OK;
    return bp_fail(
        err, BP_ERR_DEVICE,
        "this process was forked from process %ld after that had used OpenCL, whose drivers do not "
        "survive a fork; fork before anything uses OpenCL, or start a new program instead (in "
        "Python, the start method \"spawn\" of multiprocessing)",
        atomic_load(&owner));
}
