/* pace.h: limits the size of chunks, so that a launch of a kernel stays short.
 *
 * In:    the depth of paths, times of chunks that are done.   Out: numbers of samples.
 * Knows: counting and dividing.   Does not know: OpenCL, clocks, pixels.
 *
 * Paths of one picture can differ a million times in length: beside a sky lies a room of mirrors. So the
 * speed of the latest chunk is what is expected, and two bounds are the worst case: as long as parts of the
 * picture have not been traced, every path may be as long as the depth allows; afterwards, samples may be as
 * slow as the slowest of the last two passes over the picture. */
#ifndef BP_RENDER_PACE_H
#define BP_RENDER_PACE_H

#include <stdbool.h>
#include <stdint.h>

#define BP_PACE_FIRST_SAMPLES 16384u /* the first chunk only measures */
#define BP_PACE_SEGMENTS                                                                                     \
    (1u << 22)               /* of a chunk in the unknown; a core traces ten million a second and more */
#define BP_PACE_PATIENCE 3.0 /* a chunk through the slowest part takes this many times what is wanted */

/* Zero-initialised: nothing has been measured yet. */
typedef struct BpPace {
    uint32_t max_depth; /* the most segments of a path */
    uint32_t together;  /* samples that a device traces side by side: fewer take as long as these */
    double latest;      /* seconds a sample, of the latest chunk; 0: none yet */
    double slowest, slowest_before; /* seconds a sample, of this pass and of the one before */
    uint64_t gathered_samples;      /* of chunks too small to tell */
    double gathered_seconds;
    uint32_t passes; /* begun */
} BpPace;

void bp_pace_init(BpPace *pace, uint32_t max_depth, uint32_t together);

/* A chunk of `samples` took `seconds`. */
void bp_pace_measure(BpPace *pace, uint64_t samples, double seconds);

/* From here on chunks belong to another pass over the picture. */
void bp_pace_begin_pass(BpPace *pace);

/* The slowest samples of the last two passes, in seconds a sample; 0: nothing measured yet. */
double bp_pace_slowest(const BpPace *pace);

/* Samples for a chunk that should take `seconds`, given that samples may be as slow as `slowest`; at least 1.
 */
uint32_t bp_pace_samples(const BpPace *pace, double seconds, double slowest);

#endif
