/* test_thread_pool.c: a thread pool does every piece once, round after round. */
#include "base/thread_pool.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct Round {
    uint32_t done[3000]; /* each piece touches its own */
    unsigned size;
    int stranger; /* a thread that the thread pool does not have */
} Round;

static void touch(void *context, uint32_t piece, unsigned thread) {
    Round *round = context;
    ++round->done[piece];
    if (thread >= round->size) round->stranger = 1;
}

static void every_piece_once(void **state) {
    (void)state;
    const uint32_t pieces[] = {0, 1, 2, 7, 3000};
    for (unsigned threads = 0; threads <= 9; ++threads) {
        BpThreadPool *pool = bp_thread_pool_create(threads);
        assert_non_null(pool);
        assert_in_range(bp_thread_pool_size(pool), 1, 64);
        if (threads == 1) assert_int_equal(bp_thread_pool_size(pool), 1);
        Round *round = calloc(1, sizeof *round);
        round->size = bp_thread_pool_size(pool);
        for (int repeat = 0; repeat < 200; ++repeat) {
            const uint32_t count = pieces[repeat % 5];
            memset(round->done, 0, sizeof round->done);
            bp_parallel_for(pool, touch, round, count);
            for (uint32_t i = 0; i < 3000; ++i) assert_int_equal(round->done[i], i < count);
        }
        assert_false(round->stranger);
        free(round);
        bp_thread_pool_destroy(&pool);
        assert_null(pool);
        bp_thread_pool_destroy(&pool);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_piece_once)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
