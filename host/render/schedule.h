/* schedule.h: cuts a render into chunks.
 *
 * In:    pixels, samples, how many samples a chunk should have.   Out: chunks, one after the other.
 * Knows: numbers of pixels and samples.   Does not know: OpenCL, time, who traces a chunk.
 *
 * A render goes over the picture in passes; a pass gives every pixel the same number of samples, few at first
 * so that an early picture is whole, then more. A chunk is a range of pixels of one pass. What a pixel sample
 * computes does not depend on any of this. */
#ifndef BP_RENDER_SCHEDULE_H
#define BP_RENDER_SCHEDULE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct BpChunk {
    uint32_t first_pixel, pixel_count;
    uint64_t first_sample; /* absolute */
    uint32_t samples;      /* a pixel */
} BpChunk;

typedef struct BpSchedule {
    uint32_t pixels;
    uint64_t first_sample, samples; /* the range that every pixel gets; `samples` may be raised later */
    uint64_t before;                /* samples that every pixel has from elsewhere */
    uint64_t done;                  /* samples of the passes that were handed out whole */
    uint32_t pass_samples;          /* of the pass in progress; 0: none is */
    uint32_t next_pixel;
} BpSchedule;

void bp_schedule_init(BpSchedule *schedule, uint32_t pixels, uint64_t first_sample, uint64_t samples);

/* Whether there is a next chunk. */
bool bp_schedule_has_more(const BpSchedule *schedule);

/* The next chunk, of about `wanted` (at least 1) pixel samples and never more than that unless a pass has
 * begun with more samples per pixel; false when all was handed out. */
bool bp_schedule_take(BpSchedule *schedule, uint64_t wanted, BpChunk *chunk);

#endif
