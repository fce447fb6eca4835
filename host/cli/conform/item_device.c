/* item_device.c: see item_device.h. */
#include "item_device.h"

#include "base/long_call.h"

BpStatus bp_item_device_open(BpItemDevice *device, BpError *err) {
    if (device->open != NULL) return BP_OK;
    /* Every further attempt would take as long as the first. */
    if (bp_long_call_hangs())
        return bp_fail(err, BP_ERR_BROKEN_DEVICE, "not reached, since the device failed earlier (hung)");
    return bp_device_open_part(device->info, device->threads, &device->open, err);
}

void bp_item_device_done(BpItemDevice *device, BpStatus status) {
    if (device->open != NULL && status != BP_OK) bp_device_close(&device->open);
}
