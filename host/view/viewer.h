/* viewer.h: a picture that is rendered anew whenever the person at the window moves the camera.
 *
 * In:    a scene, a window.   Out: pictures on it, files that the person asks for.
 * Knows: what mouse and keys mean, when to render how large.   Does not know: SDL, the command line. */
#ifndef BP_VIEW_VIEWER_H
#define BP_VIEW_VIEWER_H

#include "window.h"

#include "scene/scene.h"

struct BpDevice;

typedef struct BpViewPlan {
    const char *name; /* of the scene, for the title */
    const BpWindow *window;
    struct BpDevice *const *devices; /* open, and outlive the view */
    size_t device_count;
    BpRenderOptions options; /* samples_per_pixel: the most */
    double target;           /* noise at which it rests, a fraction */
    BpTransfer transfer;     /* of the window */
    double exposure;         /* in stops, at the beginning */
    /* The person wants the picture kept: as it is shown, with the scene's camera as it is and so many stops
     * of exposure. A failure ends the view. */
    BpStatus (*save)(void *context, const BpScene *scene, const BpPicture *picture, double exposure,
                     BpError *err);
    void (*opened)(void *context); /* the window is there, and keys are heard */
    bool (*interrupted)(void);     /* Ctrl-C, asked between steps */
    void *context;
} BpViewPlan;

/* Help on keys and mouse, one line each. */
extern const char bp_view_keys[];

/* Fails if no window can be opened here, as far as can be told in advance: BP_ERR_DEVICE. */
BpStatus bp_view_ready(const BpWindow *window, BpError *err);

/* Opens the window, and returns when the person closes it, or with BP_ERR_INTERRUPTED; the caller then calls
 * its close(). Changes the camera of
 * `scene`. BP_ERR_DEVICE: no window can be opened, or the device failed; BP_ERR_MEMORY; what save() returns.
 */
BpStatus bp_view(const BpViewPlan *plan, BpScene *scene, BpError *err);

#endif
