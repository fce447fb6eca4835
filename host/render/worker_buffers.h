/* worker_buffers.h: what a worker keeps on its device.
 *
 * In:    packed scene, size of the picture.   Out: the worker's buffers.
 * Knows: sizes and limits of OpenCL buffers.   Does not know: which chunks are traced. */
#ifndef BP_RENDER_WORKER_BUFFERS_H
#define BP_RENDER_WORKER_BUFFERS_H

#include "worker_state.h"

/* Where an array that grows with the spheres is larger than a buffer of the device may be: of how many parts
 * of what length the program's arrays consist. Where even the most parts do not suffice, as many, and the
 * upload fails. */
void bp_worker_choose_parts(BpWorker *worker, const BpPacked *packed, BpProgramOptions *program);

/* All fail with BP_ERR_LIMIT, naming what is too large and the device's limit, or with the driver's error. */

/* The arrays of worker->packed, which is then cleared unless the device uses a part of it in place. */
BpStatus bp_worker_upload_scene(BpWorker *worker, BpError *err);
/* Sums, counts and tallies of every pixel, zeroed. After the scene: both together must fit. */
BpStatus bp_worker_create_picture(BpWorker *worker, BpError *err);
/* For a program with a pixel list: room for all pixels, not filled. */
BpStatus bp_worker_create_pixel_list(BpWorker *worker, BpError *err);
/* Room for the raw samples of `count` pixel samples, which `items` work-items trace. Only with nothing under
 * way that uses the old room. */
BpStatus bp_worker_reserve_samples(BpWorker *worker, uint32_t count, uint32_t items, BpError *err);

#endif
