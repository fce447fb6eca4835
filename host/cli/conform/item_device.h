/* item_device.h: one device for all items of work of a child process (device_items.h).
 *
 * In:    the device, its threads.   Out: the open device, on which later items reuse what earlier ones have
 * built.
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
/* After an item: closes the device if the item failed, since the device may be the cause. Otherwise it is
 * closed when the child ends. */
void bp_item_device_done(BpItemDevice *device, BpStatus status);

#endif
