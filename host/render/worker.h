/* worker.h: one device that works on one render: its program, its buffers, its chunks.
 *
 * In:    packed scene, chunks.   Out: replicate sums on the device, times.
 * Knows: OpenCL, the kernels' arguments.   Does not know: when passes end, what other devices do. */
#ifndef BP_RENDER_WORKER_H
#define BP_RENDER_WORKER_H

#include "film/film.h"
#include "schedule.h"
#include "worker_state.h"

/* Opens `info`, builds the program, uploads `packed`, which it takes over and leaves empty. Refuses what does
 * not fit the device's memory, naming the limit. Free with bp_worker_destroy(). */
BpStatus bp_worker_create(const BpDeviceInfo *info, BpPacked *packed, const BpWorkerSetup *setup,
                          BpWorker **worker, BpError *err);
void bp_worker_destroy(BpWorker **worker);

/* Sets the arguments that every tracing kernel begins with (SCENE_PARAMETERS of kernels/integrator/scene.cl):
 * worker->scene_arguments of them. */
BpStatus bp_worker_bind_scene(BpWorker *worker, cl_kernel kernel, BpError *err);

/* The number of work-items for a chunk of `count` pixel samples. */
uint32_t bp_worker_items(const BpWorker *worker, uint32_t count);

/* Queues a chunk and returns; waits for the oldest first when BP_WORKER_FLIGHT are under way. */
BpStatus bp_worker_start(BpWorker *worker, const BpChunk *chunk, BpError *err);
/* For a program with a pixel list: waits for everything, and from here on a chunk's pixels are numbers in
 * `list` (of `count` pixels, at most those of the picture), which is copied. */
BpStatus bp_worker_set_pixels(BpWorker *worker, const uint32_t *list, uint32_t count, BpError *err);

/* Waits for the oldest chunk; does nothing when there is none. */
BpStatus bp_worker_wait(BpWorker *worker, BpError *err);
/* Waits for all chunks. */
BpStatus bp_worker_wait_for_all(BpWorker *worker, BpError *err);
/* Waits for the oldest unless there is room for one more. */
BpStatus bp_worker_make_room(BpWorker *worker, BpError *err);
/* Whether the oldest chunk is done, without waiting; true when none is under way. */
BpStatus bp_worker_oldest_done(BpWorker *worker, bool *done, BpError *err);

/* Pixel samples that a chunk should have to take `seconds`, 1 .. samples_limit; `slowest` as for
 * bp_chunk_sizer_samples(). */
uint32_t bp_worker_chunk_samples(const BpWorker *worker, double seconds, double slowest);

/* Waits for everything and adds this device's sums, counts and tallies into `film`. */
BpStatus bp_worker_collect(BpWorker *worker, BpFilm *film, BpError *err);

/* Waits for everything and copies the raw samples of the last chunk: count * 4 floats. */
BpStatus bp_worker_samples(BpWorker *worker, uint32_t count, float *values, BpError *err);

#endif
