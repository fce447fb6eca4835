/* open_render.h: renders of a test on the default device, which stays open until the program ends.
 *
 * In:    a scene, options of a render.   Out: a render, to be destroyed by the caller.
 * Knows: the render loop.   Does not know: what is tested.
 *
 * Opening the device, its self-test and a program's build take a tenth of a second, even where the driver has
 * the kernel compiled. Tests draw hundreds of small pictures, so what one render has built, the next need not
 * build. */
#ifndef TESTS_SUPPORT_OPEN_RENDER_H
#define TESTS_SUPPORT_OPEN_RENDER_H

#include "opencl/device.h"
#include "render/render.h"

#include <stdlib.h>

static BpDevice *opened_device; /* NULL until the first render */

static inline void close_opened_device(void) {
    bp_device_close(&opened_device);
}

/* bp_render_create on that device. Not thread-safe. BP_ERR_DEVICE: there is none. */
static inline BpStatus open_render_on_device(const BpScene *scene, const BpRenderOptions *options,
                                             BpRender **render, BpError *err) {
    if (opened_device == NULL) {
        BpDeviceInfo info;
        BpStatus status = bp_device_find(NULL, &info, err);
        if (status == BP_OK) status = bp_device_open(&info, &opened_device, err);
        if (status != BP_OK) return status;
        atexit(close_opened_device);
    }
    return bp_render_create_on(scene, options, &opened_device, 1, render, err);
}

#endif
