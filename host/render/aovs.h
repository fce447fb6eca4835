/* aovs.h: depth, normal and albedo of what each pixel shows first.
 *
 * In:    a device at work on a render whose program holds kernels/entry/aovs.cl.   Out: a picture's layers.
 * Knows: aov_list.h, aovs.cl, worker.h.   Does not know: how the picture is written.
 *
 * They follow from the scene, the seed and the camera rays of samples 0 to 15 of each pixel, whichever
 * samples the render is of. So they cost nothing while it runs and need nothing from other devices; and all
 * films of one scene and seed have the same, to the bit on devices that round alike. That is why a merge of
 * films can keep those of one of them. */
#ifndef BP_RENDER_AOVS_H
#define BP_RENDER_AOVS_H

#include "worker.h"

/* Samples of a pixel that are looked at, from number 0 on. */
#define BP_AOV_SAMPLES 16u

/* Fills depth, normal and albedo of `picture` (see BpPicture), which has the size of the render.
 * BP_ERR_MEMORY or BP_ERR_DEVICE; the picture then has none of the three. */
BpStatus bp_aovs_fill(BpWorker *worker, const BpScene *scene, BpPicture *picture, BpError *err);

#endif
