/* aovs.h: depth, normal and albedo of what each pixel shows first.
 *
 * In:    a device at work on a render whose program holds kernels/entry/aovs.cl.   Out: the layers of a
 * picture. Knows: aov_list.h, aovs.cl, worker.h.   Does not know: how the picture is written.
 *
 * They follow from the scene and the camera rays of a few samples, not from the sums of the render: so they
 * cost nothing while it runs, need nothing from other devices, and a film holds none. */
#ifndef BP_RENDER_AOVS_H
#define BP_RENDER_AOVS_H

#include "worker.h"

/* Samples of a pixel that are looked at; a render of fewer looks at its own. */
#define BP_AOV_SAMPLES 16u

/* Fills depth, normal and albedo of `picture` (see BpPicture), which has the size of the render, from samples
 * [first_sample, first_sample + samples) of every pixel, 1 <= samples. BP_ERR_MEMORY or BP_ERR_DEVICE; the
 * picture then has none of the three. */
BpStatus bp_aovs_fill(BpWorker *worker, const BpCamera *camera, uint32_t first_sample, uint32_t samples,
                      BpPicture *picture, BpError *err);

#endif
