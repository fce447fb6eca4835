/* test_team.c: a team does every piece once, round after round. */
#include "base/team.h"

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
    int stranger; /* a worker that the team does not have */
} Round;

static void touch(void *context, uint32_t piece, unsigned worker) {
    Round *round = context;
    ++round->done[piece];
    if (worker >= round->size) round->stranger = 1;
}

static void every_piece_once(void **state) {
    (void)state;
    const uint32_t pieces[] = {0, 1, 2, 7, 3000};
    for (unsigned threads = 0; threads <= 9; ++threads) {
        BpTeam *team = bp_team_create(threads);
        assert_non_null(team);
        assert_in_range(bp_team_size(team), 1, 64);
        if (threads == 1) assert_int_equal(bp_team_size(team), 1);
        Round *round = calloc(1, sizeof *round);
        round->size = bp_team_size(team);
        for (int repeat = 0; repeat < 200; ++repeat) {
            const uint32_t count = pieces[repeat % 5];
            memset(round->done, 0, sizeof round->done);
            bp_team_run(team, touch, round, count);
            for (uint32_t i = 0; i < 3000; ++i) assert_int_equal(round->done[i], i < count);
        }
        assert_false(round->stranger);
        free(round);
        bp_team_destroy(&team);
        assert_null(team);
        bp_team_destroy(&team);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_piece_once)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
