/* portion.c: see portion.h. */
#include "portion.h"

/* A strip gives each rank so many samples at least: a chunk of fewer costs more to start than to trace. */
#define STRIP_SAMPLES 32768u
#define STRIPS_MAX 8u

static uint64_t block_samples(const BpChunk *block) {
    return (uint64_t)block->pixel_count * block->samples;
}

uint32_t bp_portion_strips(const BpChunk *block, uint32_t ranks) {
    const uint64_t strips = block_samples(block) / ranks / STRIP_SAMPLES;
    if (strips < 1 || block->samples / ranks >= STRIPS_MAX) return 1;
    return strips < STRIPS_MAX ? (uint32_t)strips : STRIPS_MAX;
}

/* floor(length * fraction) without overflow. */
static uint64_t part_of(uint64_t length, uint64_t fraction) {
    return (length >> 32) * fraction + ((length & UINT32_MAX) * fraction >> 32);
}

void bp_portion_init(BpPortion *portion, const BpChunk *block, uint32_t strips, uint64_t low, uint64_t high) {
    *portion = (BpPortion){.block = *block, .strips = strips, .low = low, .high = high};
}

/* Goes to the next strip in which there is something. */
static bool next_strip(BpPortion *portion) {
    const uint64_t all = block_samples(&portion->block), step = all / portion->strips;
    while (portion->at == portion->end) {
        if (portion->strip == portion->strips) return false;
        const uint64_t first = portion->strip * step;
        const uint64_t length = portion->strip + 1 == portion->strips ? all - first : step;
        portion->at = first + part_of(length, portion->low);
        portion->end = first + part_of(length, portion->high);
        ++portion->strip;
    }
    return true;
}

bool bp_portion_take(BpPortion *portion, uint32_t wanted, BpChunk *chunk) {
    const BpChunk *block = &portion->block;
    if (portion->whole.done == portion->whole.samples) {
        if (!next_strip(portion)) return false;
        const uint64_t pixels = block->pixel_count, sample = portion->at / pixels,
                       pixel = portion->at % pixels;
        const uint64_t left = portion->end - portion->at, row = pixels - pixel;
        if (pixel != 0 || left < pixels) {
            uint64_t count = left < row ? left : row;
            if (count > wanted) count = wanted;
            *chunk = (BpChunk){block->first_pixel + (uint32_t)pixel, (uint32_t)count,
                               block->first_sample + sample, 1};
            portion->at += count;
            return true;
        }
        bp_schedule_init(&portion->whole, block->pixel_count, block->first_sample + sample, left / pixels);
        portion->whole.before = left / pixels; /* as many samples a pass as may be */
        portion->at += left / pixels * pixels;
    }
    bp_schedule_take(&portion->whole, wanted, chunk);
    chunk->first_pixel += block->first_pixel;
    return true;
}

void bp_portion_divide(const double *weights, uint32_t ranks, uint64_t *fractions) {
    double all = 0, sum = 0;
    for (uint32_t r = 0; r < ranks; ++r) all += weights[r];
    fractions[0] = 0;
    for (uint32_t r = 0; r < ranks; ++r) {
        sum += weights[r];
        const double fraction = sum / all * (double)BP_PORTION_WHOLE;
        const uint64_t next = fraction < (double)BP_PORTION_WHOLE ? (uint64_t)fraction : BP_PORTION_WHOLE;
        fractions[r + 1] = next > fractions[r] ? next : fractions[r];
    }
    fractions[ranks] = BP_PORTION_WHOLE;
}
