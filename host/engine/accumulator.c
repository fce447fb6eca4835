/* accumulator.c: making, ranges and merging; see accumulator.h. */
#include "accumulator.h"

#include "../base/plural.h"
#include "../base/status.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define SAMPLES_END 4294967296u /* 2^32, one past the last sample number */

BpStatus bp_accumulator_create(uint32_t width, uint32_t height, uint32_t replicates,
                               BpAccumulator **accumulator, BpError *err) {
    *accumulator = NULL;
    if (width < 1 || height < 1 || width > BP_PICTURE_SIDE_MAX || height > BP_PICTURE_SIDE_MAX)
        return bp_fail(err, BP_ERR_LIMIT, "a picture of %" PRIu32 " x %" PRIu32 " pixels: sides are 1 to %u",
                       width, height, BP_PICTURE_SIDE_MAX);
    if (replicates < 1 || replicates > BP_REPLICATES_MAX)
        return bp_fail(err, BP_ERR_LIMIT, "%" PRIu32 " replicates: there are 1 to %u", replicates,
                       BP_REPLICATES_MAX);
    const size_t cells = (size_t)width * height * replicates;
    BpAccumulator *made = calloc(1, sizeof *made);
    if (made != NULL) {
        made->width = width;
        made->height = height;
        made->replicates = replicates;
        made->sums = calloc(cells, 3 * sizeof *made->sums);
        made->counts = calloc(cells, sizeof *made->counts);
    }
    if (made == NULL || made->sums == NULL || made->counts == NULL) {
        bp_accumulator_destroy(&made);
        return bp_fail(err, BP_ERR_MEMORY,
                       "out of memory for %" PRIu32 " x %" PRIu32 " pixels of %" PRIu32
                       " replicates (%zu MiB); make the picture smaller",
                       width, height, replicates, cells * 28 >> 20);
    }
    *accumulator = made;
    return BP_OK;
}

void bp_accumulator_destroy(BpAccumulator **accumulator) {
    if (accumulator == NULL || *accumulator == NULL) return;
    free((*accumulator)->ranges);
    free((*accumulator)->title);
    free((*accumulator)->sums);
    free((*accumulator)->counts);
    free((*accumulator)->pixel_segments);
    free(*accumulator);
    *accumulator = NULL;
}

/* ---- ranges of samples ---- */

/* How many s of [0, end) have s mod K = replicate. */
static uint64_t samples_before(uint64_t end, uint32_t replicates, uint32_t replicate) {
    return end / replicates + (end % replicates > replicate ? 1 : 0);
}

static uint64_t range_expected(const struct BpSampleRange *range, uint32_t replicates, uint32_t replicate) {
    return samples_before(range->first + range->count, replicates, replicate) -
           samples_before(range->first, replicates, replicate);
}

uint64_t bp_accumulator_expected(const BpAccumulator *accumulator, uint32_t replicate) {
    uint64_t total = 0;
    for (size_t i = 0; i < accumulator->range_count; i++)
        total += range_expected(&accumulator->ranges[i], accumulator->replicates, replicate);
    return total;
}

uint64_t bp_accumulator_range_total(const BpAccumulator *accumulator) {
    uint64_t total = 0;
    for (size_t i = 0; i < accumulator->range_count; i++) total += accumulator->ranges[i].count;
    return total;
}

/* Whether `range` can join the accumulator's ranges. */
static BpStatus check_range(const BpAccumulator *accumulator, const struct BpSampleRange *range,
                            BpError *err) {
    if (range->count < 1 || range->first >= SAMPLES_END || range->count > SAMPLES_END - range->first)
        return bp_fail(err, BP_ERR_USAGE,
                       "%" PRIu64 " sample%s from number %" PRIu64 " on: sample numbers are 0 to 2^32 - 1",
                       range->count, bp_plural(range->count), range->first);
    for (size_t i = 0; i < accumulator->range_count; i++) {
        const struct BpSampleRange *other = &accumulator->ranges[i];
        if (range->first < other->first + other->count && other->first < range->first + range->count)
            return bp_fail(err, BP_ERR_USAGE,
                           "samples %" PRIu64 " to %" PRIu64 " and %" PRIu64 " to %" PRIu64
                           " overlap: the same samples would count twice; render with another --first-sample",
                           other->first, other->first + other->count - 1, range->first,
                           range->first + range->count - 1);
    }
    return BP_OK;
}

static BpStatus check_limit(uint64_t samples, BpError *err) {
    if (samples <= BP_REPLICATE_SAMPLES_MAX) return BP_OK;
    return bp_fail(err, BP_ERR_LIMIT,
                   "%" PRIu64
                   " samples in one replicate of a pixel: the sums are exact up to %u; render fewer "
                   "samples, or more replicates",
                   samples, BP_REPLICATE_SAMPLES_MAX);
}

/* Puts a checked range in its place and joins it with its neighbours; there is room for one more. */
static void insert_range(BpAccumulator *accumulator, struct BpSampleRange range) {
    struct BpSampleRange *ranges = accumulator->ranges;
    size_t at = 0;
    while (at < accumulator->range_count && ranges[at].first < range.first) at++;
    memmove(&ranges[at + 1], &ranges[at], (accumulator->range_count - at) * sizeof *ranges);
    ranges[at] = range;
    accumulator->range_count++;
    size_t last = 0;
    for (size_t i = 1; i < accumulator->range_count; i++) {
        if (ranges[last].first + ranges[last].count == ranges[i].first)
            ranges[last].count += ranges[i].count;
        else
            ranges[++last] = ranges[i];
    }
    accumulator->range_count = last + 1;
}

static BpStatus make_room(BpAccumulator *accumulator, size_t more, BpError *err) {
    const size_t count = accumulator->range_count + more;
    struct BpSampleRange *ranges = realloc(accumulator->ranges, count * sizeof *ranges);
    if (ranges == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu sample ranges", count);
    accumulator->ranges = ranges;
    return BP_OK;
}

BpStatus bp_accumulator_add_range(BpAccumulator *accumulator, uint64_t first, uint64_t count, BpError *err) {
    const struct BpSampleRange range = {first, count};
    BP_TRY(check_range(accumulator, &range, err));
    for (uint32_t k = 0; k < accumulator->replicates; k++)
        BP_TRY(check_limit(bp_accumulator_expected(accumulator, k) +
                               range_expected(&range, accumulator->replicates, k),
                           err));
    BP_TRY(make_room(accumulator, 1, err));
    insert_range(accumulator, range);
    return BP_OK;
}

/* ---- merging ---- */

static BpStatus check_same_settings(const BpAccumulator *a, const BpAccumulator *b, BpError *err) {
#define BP_SAME(field, what, remedy)                                                                         \
    if (a->field != b->field)                                                                                \
    return bp_fail(err, BP_ERR_USAGE, "the renders cannot be merged: their " what " differ" remedy,          \
                   (int64_t)a->field, (int64_t)b->field)
#define BP_SAME_WORD(field, what, value, word, other)                                                        \
    if (a->field != b->field)                                                                                \
    return bp_fail(err, BP_ERR_USAGE, "the renders cannot be merged: their " what " differ (%s and %s)",     \
                   (int)a->field == (int)(value) ? (word) : (other),                                         \
                   (int)b->field == (int)(value) ? (word) : (other))
    BP_SAME(width, "widths", " (%" PRId64 " and %" PRId64 " pixels: --width)");
    BP_SAME(height, "heights", " (%" PRId64 " and %" PRId64 " pixels)");
    if (a->scene_hash != b->scene_hash)
        return bp_fail(err, BP_ERR_USAGE,
                       "the renders cannot be merged: they show different scenes (%016" PRIx64
                       " and %016" PRIx64 ")",
                       a->scene_hash, b->scene_hash);
    if (a->seed != b->seed)
        return bp_fail(err, BP_ERR_USAGE,
                       "the renders cannot be merged: their seeds differ (%" PRIu64 " and %" PRIu64
                       "); render both with one --seed and another --first-sample",
                       a->seed, b->seed);
    BP_SAME(replicates, "numbers of replicates", " (%" PRId64 " and %" PRId64 ")");
    BP_SAME(scale_log2, "fixed-point scales", " (2^%" PRId64 " and 2^%" PRId64 ")");
    BP_SAME(max_depth, "depths", " (--depth %" PRId64 " and %" PRId64 ")");
    BP_SAME_WORD(sampler, "samplers", BP_SAMPLER_SOBOL, "--sampler sobol", "--sampler independent");
    BP_SAME_WORD(precision, "precisions", BP_PRECISION_DOUBLE, "--precision double", "--precision single");
    BP_SAME_WORD(math, "kinds of mathematics", BP_MATH_FAST, "--math fast", "--math strict");
    BP_SAME_WORD(numerics, "numerics", BP_NUMERICS_PLAIN, "--numerics plain", "--numerics robust");
    BP_SAME(transfer, "transfer curves", " (numbers %" PRId64 " and %" PRId64 ")");
#undef BP_SAME
#undef BP_SAME_WORD
    return BP_OK;
}

static bool sum_overflows(int64_t a, int64_t b) {
    return b > 0 ? a > INT64_MAX - b : a < INT64_MIN - b;
}

BpStatus bp_accumulator_merge(BpAccumulator *into, const BpAccumulator *from, BpError *err) {
    BP_TRY(check_same_settings(into, from, err));
    for (size_t i = 0; i < from->range_count; i++) BP_TRY(check_range(into, &from->ranges[i], err));
    for (uint32_t k = 0; k < into->replicates; k++)
        BP_TRY(check_limit(bp_accumulator_expected(into, k) + bp_accumulator_expected(from, k), err));
    const size_t cells = (size_t)into->width * into->height * into->replicates;
    for (size_t i = 0; i < cells; i++) {
        BP_TRY(check_limit((uint64_t)into->counts[i] + from->counts[i], err));
        for (size_t c = 3 * i; c < 3 * i + 3; c++)
            if (sum_overflows(into->sums[c], from->sums[c]))
                return bp_fail(err, BP_ERR_LIMIT, "the sums of pixel %zu overflow 64 bits: a file is damaged",
                               i / into->replicates);
    }
    BP_TRY(make_room(into, from->range_count, err));

    for (size_t i = 0; i < from->range_count; i++) insert_range(into, from->ranges[i]);
    for (size_t i = 0; i < cells; i++) into->counts[i] += from->counts[i];
    for (size_t i = 0; i < 3 * cells; i++) into->sums[i] += from->sums[i];
    into->partial = into->partial || from->partial;
    into->segments += from->segments;
    into->cut_paths += from->cut_paths;
    into->invalid_samples += from->invalid_samples;
    return BP_OK;
}
