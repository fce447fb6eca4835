/* test_partition.c: ranks that share a block of samples trace each of them once, whatever their speeds. */
#include "render/partition.h"

#include <stdlib.h>

#include "support/unit_test.h"

enum { RANKS_MAX = 80 };

typedef struct Seen {
    uint8_t *times; /* sample by sample, in each all pixels */
    BpChunk block;
    uint32_t wanted;
} Seen;

static void look(Seen *seen, const BpChunk *chunk) {
    const BpChunk *block = &seen->block;
    assert_true(chunk->pixel_count >= 1 && chunk->samples >= 1);
    assert_true((uint64_t)chunk->pixel_count * chunk->samples <= seen->wanted || chunk->pixel_count == 1);
    assert_true(chunk->first_pixel >= block->first_pixel);
    assert_true(chunk->first_pixel + chunk->pixel_count <= block->first_pixel + block->pixel_count);
    assert_true(chunk->first_sample >= block->first_sample);
    assert_true(chunk->first_sample + chunk->samples <= block->first_sample + block->samples);
    for (uint64_t s = chunk->first_sample - block->first_sample, n = 0; n < chunk->samples; ++n, ++s)
        for (uint32_t p = chunk->first_pixel - block->first_pixel, m = 0; m < chunk->pixel_count; ++m, ++p)
            ++seen->times[s * block->pixel_count + p];
}

/* Samples of the rank that has most, by its weight, against the mean. */
static void share(const BpChunk *block, const double *weights, uint32_t ranks, uint32_t strips,
                  uint32_t wanted) {
    uint64_t fractions[RANKS_MAX + 1];
    double all = 0;
    const size_t samples = (size_t)block->pixel_count * block->samples;
    Seen seen = {calloc(samples, 1), *block, wanted};
    bp_partition_divide(weights, ranks, fractions);
    for (uint32_t r = 0; r < ranks; ++r) all += weights[r];
    for (uint32_t r = 0; r < ranks; ++r) {
        BpPartition partition;
        BpChunk chunk;
        uint64_t own = 0;
        bp_partition_init(&partition, block, strips, fractions[r], fractions[r + 1]);
        while (bp_partition_take(&partition, wanted, &chunk)) {
            look(&seen, &chunk);
            own += (uint64_t)chunk.pixel_count * chunk.samples;
        }
        assert_true(!bp_partition_take(&partition, wanted, &chunk));
        const double due = (double)samples * weights[r] / all;
        assert_true((double)own > due - 2.0 * strips && (double)own < due + 2.0 * strips);
    }
    for (size_t i = 0; i < samples; ++i) assert_int_equal(seen.times[i], 1);
    free(seen.times);
}

static void each_sample_once(void **state) {
    (void)state;
    const BpChunk blocks[] = {{0, 7000, 0, 1}, {100, 7000, 4, 3},      {0, 640, 1000, 64},
                              {0, 1, 0, 1},    {5, 3, 4294967290u, 6}, {0, 33000, 17, 9}};
    const uint32_t wanted[] = {1, 100, 16384, 4000000};
    srand(1);
    for (size_t b = 0; b < sizeof blocks / sizeof blocks[0]; ++b)
        for (uint32_t ranks = 1; ranks < RANKS_MAX; ranks = 2 * ranks + 1)
            for (size_t w = 0; w < 4; ++w) {
                double weights[RANKS_MAX];
                if (wanted[w] == 1 && blocks[b].pixel_count > 1000) continue;
                for (uint32_t r = 0; r < ranks; ++r) weights[r] = 1e6 * (rand() % 1000 + 1);
                share(&blocks[b], weights, ranks, bp_partition_strips(&blocks[b], ranks), wanted[w]);
                share(&blocks[b], weights, ranks, 5, wanted[w]);
            }
}

/* The largest block that a schedule hands out does not overflow. */
static void huge_block(void **state) {
    (void)state;
    const BpChunk block = {0, 1u << 30, 0, UINT32_MAX};
    const double weights[] = {1, 3};
    uint64_t fractions[3];
    bp_partition_divide(weights, 2, fractions);
    assert_int_equal(fractions[1], BP_PARTITION_WHOLE / 4);
    BpPartition partition;
    BpChunk chunk;
    bp_partition_init(&partition, &block, 1, fractions[1], fractions[2]);
    assert_true(bp_partition_take(&partition, 1u << 22, &chunk));
    const uint64_t at = ((uint64_t)1 << 30) * UINT32_MAX / 4;
    assert_int_equal(chunk.first_sample, at >> 30);
    assert_int_equal(chunk.first_pixel, at & ((1u << 30) - 1));
}

/* Few samples a rank come from several places of the picture, many are whole ones. */
static void strips_where_they_help(void **state) {
    (void)state;
    const BpChunk one = {0, 921600, 0, 1}, many = {0, 921600, 0, 512}, tiny = {0, 1000, 0, 4};
    assert_int_equal(bp_partition_strips(&one, 2), 8);
    assert_int_equal(bp_partition_strips(&one, 64), 1);
    assert_int_equal(bp_partition_strips(&many, 2), 1);
    assert_int_equal(bp_partition_strips(&many, 256), 8);
    assert_int_equal(bp_partition_strips(&tiny, 2), 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_sample_once), cmocka_unit_test(huge_block),
                                       cmocka_unit_test(strips_where_they_help)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
