/* accumulator_file.h: accumulators as files (.bpa): one line of JSON, then sums and counts, little endian.
 *
 * In and out: BpAccumulator.   Knows: the file's layout.   Does not know: how the sums were made. */
#ifndef BP_ENGINE_ACCUMULATOR_FILE_H
#define BP_ENGINE_ACCUMULATOR_FILE_H

#include "accumulator.h"

/* Written atomically. */
BpStatus bp_accumulator_save(const BpAccumulator *accumulator, const char *path, BpError *err);
/* Refuses what is truncated, too long, or not an accumulator, naming what is wrong. */
BpStatus bp_accumulator_load(const char *path, BpAccumulator **accumulator, BpError *err);

#endif
