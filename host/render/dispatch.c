/* dispatch.c: see dispatch.h. */
#include "dispatch.h"

#include <stdlib.h>
#include <time.h>

#define CHUNK_SECONDS 0.1 /* per dispatch: below the limit of every watchdog, long against its overhead */

BpStatus bp_dispatch_init(BpDispatch *dispatch, size_t worker_count, uint32_t chunk_samples, BpError *err) {
    *dispatch = (BpDispatch){.chunk_samples = chunk_samples};
    dispatch->workers = calloc(worker_count, sizeof(BpWorker *));
    if (dispatch->workers == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for a render");
    dispatch->worker_count = worker_count;
    return BP_OK;
}

void bp_dispatch_clear(BpDispatch *dispatch) {
    for (size_t i = 0; i < dispatch->worker_count; ++i) bp_worker_destroy(&dispatch->workers[i]);
    free(dispatch->workers);
    *dispatch = (BpDispatch){.workers = NULL};
}

BpStatus bp_dispatch_set_pixels(BpDispatch *dispatch, const uint32_t *list, uint32_t count, BpError *err) {
    for (size_t i = 0; i < dispatch->worker_count; ++i)
        BP_TRY(bp_worker_set_pixels(dispatch->workers[i], list, count, err));
    return BP_OK;
}

/* A worker with room for a chunk. When all are full, the one whose oldest chunk is done first: devices differ
 * in speed, and waiting for a slow one would keep a fast one idle. */
BpStatus bp_dispatch_free_worker(const BpDispatch *dispatch, BpWorker **found, BpError *err) {
    BpWorker *best = dispatch->workers[0];
    for (size_t i = 1; i < dispatch->worker_count; ++i)
        if (dispatch->workers[i]->flight_count < best->flight_count) best = dispatch->workers[i];
    const struct timespec pause = {.tv_nsec = 200000};
    while (dispatch->worker_count > 1 && best->flight_count == BP_WORKER_FLIGHT) {
        for (size_t i = 0; i < dispatch->worker_count && best->flight_count == BP_WORKER_FLIGHT; ++i) {
            BpWorker *worker = dispatch->workers[i];
            bool done = false;
            BP_TRY(bp_worker_oldest_done(worker, &done, err));
            if (!done) continue;
            BP_TRY(bp_worker_wait(worker, err));
            best = worker;
        }
        if (best->flight_count == BP_WORKER_FLIGHT) nanosleep(&pause, NULL);
    }
    *found = best;
    return bp_worker_make_room(best, err);
}

double bp_dispatch_slowest(const BpDispatch *dispatch) {
    double slowest = 0;
    for (size_t i = 0; i < dispatch->worker_count; ++i) {
        const double own = bp_chunk_sizer_slowest(&dispatch->workers[i]->sizer);
        if (own > slowest) slowest = own;
    }
    return slowest;
}

uint32_t bp_dispatch_chunk_samples(const BpDispatch *dispatch, const BpWorker *worker) {
    if (dispatch->chunk_samples != 0) return dispatch->chunk_samples;
    return bp_worker_chunk_samples(worker, CHUNK_SECONDS, bp_dispatch_slowest(dispatch));
}

void bp_dispatch_take(BpDispatch *dispatch, uint64_t wanted, BpChunk *chunk) {
    (void)bp_schedule_take(&dispatch->schedule, wanted, chunk);
    if (chunk->first_pixel == 0)
        for (size_t i = 0; i < dispatch->worker_count; ++i)
            bp_chunk_sizer_begin_pass(&dispatch->workers[i]->sizer);
}

BpStatus bp_dispatch_wait(const BpDispatch *dispatch, BpError *err) {
    for (size_t i = 0; i < dispatch->worker_count; ++i)
        BP_TRY(bp_worker_wait_for_all(dispatch->workers[i], err));
    return BP_OK;
}

uint64_t bp_dispatch_samples_done(const BpDispatch *dispatch) {
    uint64_t done = 0;
    for (size_t i = 0; i < dispatch->worker_count; ++i) done += dispatch->workers[i]->samples_done;
    return done;
}
