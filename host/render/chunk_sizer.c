/* chunk_sizer.c: see chunk_sizer.h. */
#include "chunk_sizer.h"

/* The second pass begins while the last chunks of the first are under way, so its chunks are not measured yet
 * either. */
#define UNKNOWN_PASSES 2u

void bp_chunk_sizer_init(BpChunkSizer *sizer, uint32_t max_depth, uint32_t together) {
    *sizer = (BpChunkSizer){.max_depth = max_depth, .together = together > 0 ? together : 1};
}

/* Samples of which each may be as long as the depth allows. */
static uint32_t unknown_samples(const BpChunkSizer *sizer) {
    const uint32_t samples = BP_CHUNK_SEGMENTS / (sizer->max_depth > 0 ? sizer->max_depth : 1);
    return samples > sizer->together ? samples : sizer->together;
}

static uint32_t first_samples(const BpChunkSizer *sizer) {
    const uint32_t samples = unknown_samples(sizer);
    return samples < BP_CHUNK_FIRST_SAMPLES ? samples : BP_CHUNK_FIRST_SAMPLES;
}

void bp_chunk_sizer_measure(BpChunkSizer *sizer, uint64_t samples, double seconds) {
    if (samples == 0) return;
    sizer->latest = seconds / (double)samples;
    /* The last chunk of a pass can be a single pixel, and its time may be that of another program's turn on
     * the processor. */
    sizer->gathered_samples += samples;
    sizer->gathered_seconds += seconds;
    if (sizer->gathered_samples < first_samples(sizer)) return;
    const double slow = sizer->gathered_seconds / (double)sizer->gathered_samples;
    if (slow > sizer->slowest) sizer->slowest = slow;
    sizer->gathered_samples = 0;
    sizer->gathered_seconds = 0;
}

void bp_chunk_sizer_begin_pass(BpChunkSizer *sizer) {
    sizer->slowest_before = sizer->slowest;
    sizer->slowest = 0;
    if (sizer->passes <= UNKNOWN_PASSES) ++sizer->passes;
}

double bp_chunk_sizer_slowest(const BpChunkSizer *sizer) {
    return sizer->slowest > sizer->slowest_before ? sizer->slowest : sizer->slowest_before;
}

uint32_t bp_chunk_sizer_samples(const BpChunkSizer *sizer, double seconds, double slowest) {
    if (sizer->latest <= 0) return first_samples(sizer);
    double samples = seconds / sizer->latest;
    const double bearable = BP_CHUNK_PATIENCE * seconds / slowest; /* infinite when nothing is known */
    if (samples > bearable) samples = bearable;
    const double unknown = unknown_samples(sizer);
    if (sizer->passes <= UNKNOWN_PASSES && samples > unknown) samples = unknown;
    if (samples < sizer->together) return sizer->together;
    return samples > UINT32_MAX ? UINT32_MAX : (uint32_t)samples;
}
