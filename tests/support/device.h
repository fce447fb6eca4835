/* device.h: the device that a test asks for, or the reason why there is none.
 *
 * Knows: the environment of tests.   Does not know: what is tested. */
#ifndef TESTS_SUPPORT_DEVICE_H
#define TESTS_SUPPORT_DEVICE_H

#include "opencl/device.h"

#include <stdio.h>
#include <stdlib.h>

/* Opens the device that BALLPARK_TEST_DEVICE names, or the default one. 0; or what main returns then: 77, for
 * a skipped test, when there is no device, and 1 when it cannot be opened. The reason is on standard error.
 */
static inline int test_device_open(BpDevice **device) {
    BpDeviceInfo info;
    BpError err = {0};
    if (bp_device_find(getenv("BALLPARK_TEST_DEVICE"), &info, &err) != BP_OK) {
        fprintf(stderr, "skipped: %s\n", err.message);
        return 77;
    }
    if (bp_device_open(&info, device, &err) != BP_OK) {
        fprintf(stderr, "%s\n", err.message);
        return 1;
    }
    return 0;
}

#endif
