/* item_device.h: one device for all items of work that a child has (device_items.h).
 *
 * In:    the device, its threads.   Out: the device, open: what one item has built, the next need not build.
 * Knows: devices.   Does not know: what the work is. */
#ifndef BP_CLI_CONFORM_ITEM_DEVICE_H
#define BP_CLI_CONFORM_ITEM_DEVICE_H

#include "opencl/device.h"

typedef struct BpItemDevice {
    const BpDeviceInfo *info;
    uint32_t threads; /* 0: all */
    BpDevice *open;   /* NULL until the first item needs it, and after an item that failed */
} BpItemDevice;

/* Before an item: opens it if it is not open. */
BpStatus bp_item_device_open(BpItemDevice *device, BpError *err);
/* After an item: closes it if that failed, since the device may be why. Otherwise the child's end closes it.
 */
void bp_item_device_done(BpItemDevice *device, BpStatus status);

#endif
