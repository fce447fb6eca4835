/* worker_read.c: what chunks have left on a worker's device, read back; see worker.h. */
#include "worker.h"

#include <stdlib.h>

_Static_assert(FINE_BITS == BP_FINE_BITS, "the device's fine steps are the film's");

/* How many replicates of pixels are read back at a time; at least those of one pixel. */
#define COLLECT_CELLS 65536u

static BpStatus read_buffer(BpWorker *worker, cl_mem buffer, size_t offset, size_t bytes, void *out,
                            BpError *err) {
    CL_TRY(worker,
           clEnqueueReadBuffer(worker->device->queue, buffer, CL_TRUE, offset, bytes, out, 0, NULL, NULL),
           "clEnqueueReadBuffer");
    return BP_OK;
}

/* Adds the fine sums of the cells whose counts say that they have some; `fine` is room for a block. Most
 * pictures have none, and read nothing. */
static BpStatus collect_fine_sums(BpWorker *worker, size_t cell, size_t cells, const cl_uint *counts,
                                  cl_long *fine, BpFilm *film, BpError *err) {
    cl_uint flags = 0;
    for (size_t i = 0; i < cells; ++i) flags |= counts[i];
    film->coarse = film->coarse || (flags & COUNT_COARSE) != 0;
    if ((flags & COUNT_HAS_FINE) == 0) return BP_OK;
    BP_TRY(bp_film_add_fine_sums(film, err));
    BP_TRY(
        read_buffer(worker, worker->fine_sums, 3 * cell * sizeof *fine, 3 * cells * sizeof *fine, fine, err));
    for (size_t i = 0; i < 3 * cells; ++i)
        if ((counts[i / 3] & COUNT_HAS_FINE) != 0) film->fine_sums[3 * cell + i] += fine[i];
    return BP_OK;
}

/* Adds one block of `count` pixels, from `first` on; the arrays are room for it. */
static BpStatus collect_block(BpWorker *worker, size_t first, size_t count, cl_long *sums, cl_uint *counts,
                              cl_ulong *tallies, BpFilm *film, BpError *err) {
    const size_t k_count = worker->replicates, cell = first * k_count, cells = count * k_count;
    BP_TRY(read_buffer(worker, worker->sums, 3 * cell * sizeof *sums, 3 * cells * sizeof *sums, sums, err));
    BP_TRY(read_buffer(worker, worker->counts, cell * sizeof *counts, cells * sizeof *counts, counts, err));
    BP_TRY(read_buffer(worker, worker->tallies, TALLIES * first * sizeof *tallies,
                       TALLIES * count * sizeof *tallies, tallies, err));
    for (size_t i = 0; i < 3 * cells; ++i) film->sums[3 * cell + i] += sums[i];
    for (size_t i = 0; i < cells; ++i) film->counts[cell + i] += counts[i] & COUNT_SAMPLES;
    for (size_t i = 0; i < count; ++i) {
        const cl_ulong *const tally = tallies + TALLIES * i;
        film->segments += tally[TALLY_SEGMENTS];
        if (film->pixel_segments != NULL) film->pixel_segments[first + i] += tally[TALLY_SEGMENTS];
        film->truncated_paths += tally[TALLY_CUT];
#define ADD(member, place, words)                                                                            \
    film->member += tally[place];                                                                            \
    film->invalid_samples += tally[place];
        BP_INVALID_LIST(ADD)
#undef ADD
        film->shadow_rays += tally[TALLY_LAMP_RAYS];
        if (film->met == NULL) continue;
        for (size_t k = 0; k < k_count; ++k) film->met[first + i] += counts[i * k_count + k] & COUNT_SAMPLES;
        film->met[first + i] -= tally[TALLY_MISSED];
    }
    return collect_fine_sums(worker, cell, cells, counts, sums, film, err);
}

/* Block by block: room for all of it would be as much memory again, new to the process every time. */
BpStatus bp_worker_collect(BpWorker *worker, BpFilm *film, BpError *err) {
    BP_TRY(bp_worker_wait_for_all(worker, err));
    size_t block = COLLECT_CELLS / worker->replicates;
    if (block > worker->pixels) block = worker->pixels;
    cl_long *sums = malloc(block * worker->replicates * 3 * sizeof *sums);
    cl_uint *counts = malloc(block * worker->replicates * sizeof *counts);
    cl_ulong *tallies = malloc(block * TALLIES * sizeof *tallies);
    BpStatus status = BP_OK;
    if (sums == NULL || counts == NULL || tallies == NULL)
        status = bp_fail(err, BP_ERR_MEMORY, "no memory to read a picture of %u pixels back", worker->pixels);
    for (size_t first = 0; first < worker->pixels && status == BP_OK; first += block) {
        const size_t left = worker->pixels - first;
        status = collect_block(worker, first, left < block ? left : block, sums, counts, tallies, film, err);
    }
    free(sums);
    free(counts);
    free(tallies);
    return status;
}

BpStatus bp_worker_samples(BpWorker *worker, uint32_t count, float *values, BpError *err) {
    BP_TRY(bp_worker_wait_for_all(worker, err));
    const size_t numbers = (size_t)count * 4;
    if (worker->real_size == sizeof(float))
        return read_buffer(worker, worker->samples, 0, numbers * sizeof(float), values, err);
    double *wide = malloc(numbers * sizeof *wide);
    if (wide == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory to read %u samples back", count);
    const BpStatus status = read_buffer(worker, worker->samples, 0, numbers * sizeof *wide, wide, err);
    for (size_t i = 0; status == BP_OK && i < numbers; ++i) values[i] = (float)wide[i];
    free(wide);
    return status;
}
