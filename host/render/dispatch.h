/* dispatch.h: the workers of a render, and the chunks that they get.
 *
 * In:    workers, a schedule.   Out: who traces the next chunk, and how large it is.
 * Knows: which worker has room, how long chunks take.   Does not know: what is rendered, stop rules. *
 */
#ifndef BP_RENDER_DISPATCH_H
#define BP_RENDER_DISPATCH_H

#include "worker.h"

typedef struct BpDispatch {
    BpWorker **workers; /* owned; NULL while they are being made */
    size_t worker_count;
    BpSchedule schedule;    /* adaptive: of the pass under way */
    uint32_t chunk_samples; /* that a chunk has; 0: as many as take a while */
} BpDispatch;

/* Room for so many workers, which the caller makes. Release with bp_dispatch_clear(), also when it fails. */
BpStatus bp_dispatch_init(BpDispatch *dispatch, size_t worker_count, uint32_t chunk_samples, BpError *err);
void bp_dispatch_clear(BpDispatch *dispatch);

/* bp_worker_set_pixels() for all workers. */
BpStatus bp_dispatch_set_pixels(BpDispatch *dispatch, const uint32_t *list, uint32_t count, BpError *err);

/* A worker with room for a chunk; and how many pixel samples a chunk of its should have. */
BpStatus bp_dispatch_free_worker(const BpDispatch *dispatch, BpWorker **found, BpError *err);
uint32_t bp_dispatch_chunk_samples(const BpDispatch *dispatch, const BpWorker *worker);
/* The seconds of the slowest samples of all workers, as bp_chunk_sizer_slowest(), since each meets only some
 * parts of the picture. */
double bp_dispatch_slowest(const BpDispatch *dispatch);

/* The next chunk of the schedule, which has one, of about `wanted` pixel samples. */
void bp_dispatch_take(BpDispatch *dispatch, uint64_t wanted, BpChunk *chunk);

/* Until all chunks are done. */
BpStatus bp_dispatch_wait(const BpDispatch *dispatch, BpError *err);
/* Pixel samples of the chunks that are done. */
uint64_t bp_dispatch_samples_done(const BpDispatch *dispatch);

#endif
