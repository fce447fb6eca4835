/* partition.h: the part of a block of samples that one rank of several traces.
 *
 * In:    a block, a share of it.   Out: chunks.
 * Knows: numbers of pixels and samples.   Does not know: OpenCL, time, how ranks talk (cluster/comm.h).
 *
 * The samples of a block stand in a row: sample by sample, and in each all pixels. The row is cut into
 * strips, and in each strip a rank has the part between two fractions. So shares of any size cover the block
 * exactly, those of many samples are mostly of whole samples, which all cost the same, and those of less than
 * a sample come from several places of the picture. */
#ifndef BP_RENDER_PARTITION_H
#define BP_RENDER_PARTITION_H

#include "schedule.h"

#define BP_PARTITION_WHOLE ((uint64_t)1 << 32) /* a fraction of 1 */

typedef struct BpPartition {
    BpChunk block;
    uint32_t strips, strip; /* in all; the next */
    uint64_t low, high;     /* fractions of a strip, in steps of 2^-32 */
    uint64_t at, end;       /* what is left of the current strip */
    BpSchedule whole;       /* of the whole samples at `at`; none: samples == done */
} BpPartition;

/* 0 <= low <= high <= BP_PARTITION_WHOLE. */
void bp_partition_init(BpPartition *partition, const BpChunk *block, uint32_t strips, uint64_t low,
                       uint64_t high);

/* Strips for a block that `ranks` share: few where each gets many whole samples, or where chunks would be
 * short. */
uint32_t bp_partition_strips(const BpChunk *block, uint32_t ranks);

/* The next chunk, of about `wanted` (at least 1) pixel samples; false when all were taken. */
bool bp_partition_take(BpPartition *partition, uint32_t wanted, BpChunk *chunk);

/* Shares in proportion to `weights`, which are positive: fractions[r] to fractions[r + 1] is that of rank r.
 */
void bp_partition_divide(const double *weights, uint32_t ranks, uint64_t *fractions);

#endif
