/* partition.c: see partition.h. */
#include "partition.h"

/* A strip gives each rank so many samples at least: a chunk of fewer costs more to start than to trace. */
#define STRIP_SAMPLES 32768u
#define STRIPS_MAX 8u

static uint64_t block_samples(const BpChunk *block) {
    return (uint64_t)block->pixel_count * block->samples;
}

uint32_t bp_partition_strips(const BpChunk *block, uint32_t ranks) {
    const uint64_t strips = block_samples(block) / ranks / STRIP_SAMPLES;
    if (strips < 1 || block->samples / ranks >= STRIPS_MAX) return 1;
    return strips < STRIPS_MAX ? (uint32_t)strips : STRIPS_MAX;
}

/* floor(length * fraction) without overflow. */
static uint64_t part_of(uint64_t length, uint64_t fraction) {
    return (length >> 32) * fraction + ((length & UINT32_MAX) * fraction >> 32);
}

void bp_partition_init(BpPartition *partition, const BpChunk *block, uint32_t strips, uint64_t low,
                       uint64_t high) {
    *partition = (BpPartition){.block = *block, .strips = strips, .low = low, .high = high};
}

/* Goes to the next strip in which there is something. */
static bool next_strip(BpPartition *partition) {
    const uint64_t all = block_samples(&partition->block), step = all / partition->strips;
    while (partition->at == partition->end) {
        if (partition->strip == partition->strips) return false;
        const uint64_t first = partition->strip * step;
        const uint64_t length = partition->strip + 1 == partition->strips ? all - first : step;
        partition->at = first + part_of(length, partition->low);
        partition->end = first + part_of(length, partition->high);
        ++partition->strip;
    }
    return true;
}

bool bp_partition_take(BpPartition *partition, uint32_t wanted, BpChunk *chunk) {
    const BpChunk *block = &partition->block;
    if (partition->whole.done == partition->whole.samples) {
        if (!next_strip(partition)) return false;
        const uint64_t pixels = block->pixel_count, sample = partition->at / pixels,
                       pixel = partition->at % pixels;
        const uint64_t left = partition->end - partition->at, row = pixels - pixel;
        if (pixel != 0 || left < pixels) {
            uint64_t count = left < row ? left : row;
            if (count > wanted) count = wanted;
            *chunk = (BpChunk){block->first_pixel + (uint32_t)pixel, (uint32_t)count,
                               block->first_sample + sample, 1};
            partition->at += count;
            return true;
        }
        bp_schedule_init(&partition->whole, block->pixel_count, block->first_sample + sample, left / pixels);
        partition->whole.before = left / pixels; /* as many samples a pass as may be */
        partition->at += left / pixels * pixels;
    }
    bp_schedule_take(&partition->whole, wanted, chunk);
    chunk->first_pixel += block->first_pixel;
    return true;
}

void bp_partition_divide(const double *weights, uint32_t ranks, uint64_t *fractions) {
    double all = 0, sum = 0;
    for (uint32_t r = 0; r < ranks; ++r) all += weights[r];
    fractions[0] = 0;
    for (uint32_t r = 0; r < ranks; ++r) {
        sum += weights[r];
        const double fraction = sum / all * (double)BP_PARTITION_WHOLE;
        const uint64_t next = fraction < (double)BP_PARTITION_WHOLE ? (uint64_t)fraction : BP_PARTITION_WHOLE;
        fractions[r + 1] = next > fractions[r] ? next : fractions[r];
    }
    fractions[ranks] = BP_PARTITION_WHOLE;
}
