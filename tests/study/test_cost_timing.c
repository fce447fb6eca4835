/* test_cost_timing.c: what `ballpark cost` makes of the times of rounds, disturbed ones among them. */
#include "support/unit_test.h"

#include "cost_random.h"
#include "study/timing.h"

#include <math.h>

typedef struct Summary {
    double ratio, seconds, width; /* means */
    int held;                     /* of 400: times that the interval held the true ratio */
} Summary;

/* A way that takes 1.2 times the base; both scatter by 1 %. `disturbed`: the machine is a third slower in
 * five whole rounds, and twice as slow in three of the way's alone. */
static Summary run_trials(bool disturbed) {
    enum { TRIALS = 400, COUNT = BP_STUDY_ROUNDS_MAX };
    Summary summary = {0};
    for (int t = 0; t < TRIALS; t++) {
        double base[COUNT], own[COUNT], samples[COUNT];
        for (size_t r = 0; r < COUNT; r++) {
            const double slow = disturbed && r < 5 ? 1.33 : 1;
            const double slower = disturbed && (r == 3 || r == 9 || r == 12) ? 2 : 1;
            samples[r] = r % 2 == 0 ? 48 : 47;
            base[r] = 0.001 * samples[r] * slow * (1 + 0.01 * normal());
            own[r] = 1.2 * 0.001 * samples[r] * slow * slower * (1 + 0.01 * normal());
        }
        const BpStudyEstimate ratio = bp_study_round_ratio(own, base, COUNT);
        summary.ratio += ratio.value / TRIALS;
        summary.width += (ratio.high - ratio.low) / TRIALS;
        summary.seconds += bp_study_round_seconds(base, samples, COUNT) / TRIALS;
        summary.held += ratio.low <= 1.2 && 1.2 <= ratio.high;
    }
    print_message("ratio %.4f of 1.2, %.4f s of 0.76, width %.3f, interval holds in %d of %d\n",
                  summary.ratio, summary.seconds, summary.width, summary.held, TRIALS);
    return summary;
}

static void test_quiet(void **state) {
    (void)state;
    stream.state = 7;
    const Summary quiet = run_trials(false);
    assert_true(fabs(quiet.ratio - 1.2) < 0.003);
    assert_true(fabs(quiet.seconds - 0.76) < 0.002);
    assert_true(quiet.held >= 380); /* 97.9 %, for that is how the ranks of 16 fall: 391.6 +- 2.9 */
    assert_true(quiet.width < 0.04);
}

static void test_disturbed(void **state) {
    (void)state;
    stream.state = 8;
    const Summary disturbed = run_trials(true);
    assert_true(fabs(disturbed.ratio - 1.2) < 0.01);
    assert_true(fabs(disturbed.seconds - 0.76) < 0.01);
    assert_true(disturbed.held >= 360);
}

/* Few rounds are added up, and say nothing of a ratio; nor does a clock that stands still. */
static void test_few_rounds(void **state) {
    (void)state;
    const double base[6] = {1, 2, 3, 4, 5, 6}, own[6] = {2, 4, 6, 8, 10, 12}, still[6] = {1, 2, 0, 4, 5, 6},
                 samples[6] = {1, 2, 3, 4, 5, 6};
    assert_true(bp_study_round_seconds(base, samples, 4) == 10);
    assert_true(bp_study_round_seconds(base, samples, 6) == 21);
    assert_true(bp_study_round_seconds(base, samples, 0) == 0);
    const double coarse[6] = {0, 0, 4, 0, 0, 4};
    assert_true(bp_study_round_seconds(coarse, samples, 6) == 8);
    assert_true(isnan(bp_study_round_ratio(own, base, 5).value));
    const BpStudyEstimate twice = bp_study_round_ratio(own, base, 6);
    assert_true(twice.value == 2 && twice.low == 2 && twice.high == 2);
    assert_true(isnan(bp_study_round_ratio(own, still, 6).value));
    assert_true(isnan(bp_study_round_ratio(still, base, 6).value));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_quiet),
        cmocka_unit_test(test_disturbed),
        cmocka_unit_test(test_few_rounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
