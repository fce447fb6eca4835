/* chunk_sizer.h: limits the size of chunks, so that a launch of a kernel stays short.
 *
 * In:    the depth of paths, times of chunks that are done.   Out: numbers of samples.
 * Knows: counting and dividing.   Does not know: OpenCL, clocks, pixels.
 *
 * Paths of one picture can differ a million times in length: beside a sky lies a room of mirrors. So the
 * speed of the latest chunk is what is expected, and two bounds are the worst case: as long as parts of the
 * picture have not been traced, every path may be as long as the depth allows; afterwards, samples may be as
 * slow as the slowest of the last two passes over the picture. */
#ifndef BP_RENDER_CHUNK_SIZER_H
#define BP_RENDER_CHUNK_SIZER_H

#include <stdbool.h>
#include <stdint.h>

#define BP_CHUNK_FIRST_SAMPLES 16384u /* the first chunk only measures */
#define BP_CHUNK_SEGMENTS                                                                                    \
    (1u << 22)                /* of a chunk in the unknown; a core traces ten million a second and more */
#define BP_CHUNK_PATIENCE 3.0 /* a chunk through the slowest part takes this many times what is wanted */

/* Zero-initialised: nothing has been measured yet. */
typedef struct BpChunkSizer {
    uint32_t max_depth; /* the most segments of a path */
    uint32_t together;  /* samples that a device traces side by side: fewer take as long as these */
    double latest;      /* seconds a sample, of the latest chunk; 0: none yet */
    double slowest, slowest_before; /* seconds a sample, of this pass and of the one before */
    uint64_t gathered_samples;      /* of chunks too small to tell */
    double gathered_seconds;
    uint32_t passes; /* begun */
} BpChunkSizer;

void bp_chunk_sizer_init(BpChunkSizer *sizer, uint32_t max_depth, uint32_t together);

/* A chunk of `samples` took `seconds`. */
void bp_chunk_sizer_measure(BpChunkSizer *sizer, uint64_t samples, double seconds);

/* From here on chunks belong to another pass over the picture. */
void bp_chunk_sizer_begin_pass(BpChunkSizer *sizer);

/* The slowest samples of the last two passes, in seconds a sample; 0: nothing measured yet. */
double bp_chunk_sizer_slowest(const BpChunkSizer *sizer);

/* Samples for a chunk that should take `seconds`, given that samples may be as slow as `slowest`; at least 1.
 */
uint32_t bp_chunk_sizer_samples(const BpChunkSizer *sizer, double seconds, double slowest);

#endif
