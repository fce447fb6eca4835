/* test_chunk_sizer.c: chunks stay short whatever a path costs, and few where paths are short. Pictures are
 * made up: a number of seconds for every pixel; the clock is a sum. */
#include "render/chunk_sizer.h"
#include "render/schedule.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define WANTED_SECONDS 0.1
#define SEGMENT_SECONDS (1.0 / 15e6) /* of the slower form on one core */
#define FLIGHT 2                     /* chunks that are chosen before the oldest is measured */

typedef struct World {
    uint32_t pixels, max_depth, together;
    uint32_t long_first, long_count; /* pixels whose paths are as long as the depth allows */
    uint32_t short_depth;            /* of all others */
    uint64_t samples;
} World;

typedef struct Outcome {
    double longest, total; /* seconds: of a chunk, of all */
    uint32_t chunks;
    uint32_t first, second; /* samples of the first chunks */
} Outcome;

static double chunk_seconds(const World *world, const BpChunk *chunk) {
    const uint64_t begin = chunk->first_pixel, end = begin + chunk->pixel_count;
    const uint64_t long_end = (uint64_t)world->long_first + world->long_count;
    const uint64_t from = begin > world->long_first ? begin : world->long_first;
    const uint64_t to = end < long_end ? end : long_end;
    const uint64_t slow = to > from ? to - from : 0;
    double segments =
        (double)slow * world->max_depth + (double)(chunk->pixel_count - slow) * world->short_depth;
    segments *= chunk->samples;
    return 50e-6 + segments * SEGMENT_SECONDS / world->together;
}

static Outcome run(const World *world) {
    BpChunkSizer sizer;
    BpSchedule schedule;
    BpChunk chunk;
    Outcome outcome = {0};
    struct {
        uint64_t samples;
        double seconds;
    } flight[FLIGHT];
    int under_way = 0;
    bp_chunk_sizer_init(&sizer, world->max_depth, world->together);
    bp_schedule_init(&schedule, world->pixels, 0, world->samples);
    for (;;) {
        if (under_way == FLIGHT || (under_way > 0 && outcome.chunks == 1)) { /* the first one is waited for */
            bp_chunk_sizer_measure(&sizer, flight[0].samples, flight[0].seconds);
            flight[0] = flight[1];
            --under_way;
        }
        const uint32_t wanted =
            bp_chunk_sizer_samples(&sizer, WANTED_SECONDS, bp_chunk_sizer_slowest(&sizer));
        const bool has_more = bp_schedule_has_more(&schedule);
        assert_int_equal(bp_schedule_take(&schedule, wanted, &chunk), has_more);
        if (!has_more) break;
        if (chunk.first_pixel == 0) bp_chunk_sizer_begin_pass(&sizer);
        const double seconds = chunk_seconds(world, &chunk);
        flight[under_way].samples = (uint64_t)chunk.pixel_count * chunk.samples;
        flight[under_way++].seconds = seconds;
        outcome.total += seconds;
        if (seconds > outcome.longest) outcome.longest = seconds;
        ++outcome.chunks;
        const uint32_t count = chunk.pixel_count * chunk.samples;
        if (outcome.chunks == 1) outcome.first = count;
        if (outcome.chunks == 2) outcome.second = count;
    }
    return outcome;
}

/* Every path as long as the depth allows. */
static void mirrors_everywhere(void **state) {
    (void)state;
    for (uint32_t depth = 1; depth <= 1000000; depth *= 10)
        for (uint32_t together = 1; together <= 16; together *= 16) {
            const World world = {.pixels = 1000,
                                 .max_depth = depth,
                                 .together = together,
                                 .long_count = 1000,
                                 .short_depth = 1,
                                 .samples = 20};
            const Outcome outcome = run(&world);
            assert_true(outcome.longest < 0.5);
            assert_true(outcome.first <= BP_CHUNK_FIRST_SAMPLES);
            assert_true(outcome.first <= together || (uint64_t)outcome.first * depth <= BP_CHUNK_SEGMENTS);
            /* The time goes into samples, not into launches. */
            if (depth >= 1000) assert_true(50e-6 * outcome.chunks < 0.25 * outcome.total);
        }
}

/* A sky first, then a few pixels that see the mirrors: in the first pass nobody can know, later everybody. */
static void mirrors_behind_a_sky(void **state) {
    (void)state;
    for (uint32_t depth = 1000; depth <= 1000000; depth *= 10)
        for (uint32_t together = 1; together <= 16; together *= 16) {
            const World world = {.pixels = 90000,
                                 .max_depth = depth,
                                 .together = together,
                                 .long_first = 80000,
                                 .long_count = 2000,
                                 .short_depth = 1,
                                 .samples = 100};
            const Outcome outcome = run(&world);
            assert_true(outcome.longest < 1.0);
        }
}

/* The book's depth: paths of a few segments, and nobody pays for what cannot happen. */
static void ordinary_pictures(void **state) {
    (void)state;
    const World world = {.pixels = 1200 * 675,
                         .max_depth = 50,
                         .together = 16,
                         .long_first = 400000,
                         .long_count = 1000,
                         .short_depth = 3,
                         .samples = 100};
    const Outcome outcome = run(&world);
    assert_true(outcome.longest < 0.5);
    assert_int_equal(outcome.first, BP_CHUNK_FIRST_SAMPLES);
    assert_true(outcome.second > BP_CHUNK_FIRST_SAMPLES);
    /* No more than twice as many as there must be, but for the first two passes and the ends of passes. */
    assert_true(outcome.chunks < 2 * outcome.total / WANTED_SECONDS + 40);
    assert_true(50e-6 * outcome.chunks < 0.01 * outcome.total);
}

/* One chunk that another program delayed is forgotten two passes later, and a tiny one says nothing alone. */
static void forgets(void **state) {
    (void)state;
    BpChunkSizer sizer;
    bp_chunk_sizer_init(&sizer, 50, 1);
    for (int i = 0; i < 3; ++i) bp_chunk_sizer_begin_pass(&sizer);
    bp_chunk_sizer_measure(&sizer, 1, 0.5);
    assert_true(bp_chunk_sizer_slowest(&sizer) == 0);
    bp_chunk_sizer_measure(&sizer, 99999, 0.5);
    assert_true(bp_chunk_sizer_slowest(&sizer) > 0.99e-5 && bp_chunk_sizer_slowest(&sizer) < 1.01e-5);
    bp_chunk_sizer_measure(&sizer, 100000, 0.01); /* 1e-7 a sample, now */
    const double slowest = bp_chunk_sizer_slowest(&sizer);
    assert_int_equal(bp_chunk_sizer_samples(&sizer, 0.1, slowest),
                     30000); /* three times the time, through the slowest */
    bp_chunk_sizer_begin_pass(&sizer);
    assert_true(bp_chunk_sizer_slowest(&sizer) == slowest);
    bp_chunk_sizer_measure(&sizer, 100000, 0.01);
    bp_chunk_sizer_begin_pass(&sizer);
    assert_true(bp_chunk_sizer_slowest(&sizer) < 1.01e-7);
    assert_in_range(bp_chunk_sizer_samples(&sizer, 0.1, bp_chunk_sizer_slowest(&sizer)), 999999, 1000001);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mirrors_everywhere),
        cmocka_unit_test(mirrors_behind_a_sky),
        cmocka_unit_test(ordinary_pictures),
        cmocka_unit_test(forgets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
