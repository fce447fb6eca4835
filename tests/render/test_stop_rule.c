/* test_stop_rule.c: the stop rules on made-up renders: counts are fixed, every rule ends, none ends early. */
#include "render/stop_rule.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

/* A render whose error is `one_sample` / sqrt(samples) and which traces `rate` samples per pixel a second. */
static BpStopReason run(const BpStopRule *rule, double one_sample, double rate, BpStopState *state,
                        int *looks) {
    BpStopReason reason = BP_STOP_NOT_YET;
    memset(state, 0, sizeof *state);
    uint64_t next = bp_stop_first(rule);
    for (*looks = 0; reason == BP_STOP_NOT_YET; ++*looks) {
        assert_true(next > state->samples && next <= rule->samples_max);
        assert_true(*looks < 1000);
        state->seconds += (double)(next - state->samples) / rate;
        state->samples = next;
        state->nrmse = one_sample / sqrt((double)next);
        reason = bp_stop_decide(rule, state, &next);
    }
    return reason;
}

static void samples_alone(void **unused) {
    (void)unused;
    BpStopRule rule;
    BpStopState state;
    int looks = 0;
    for (uint64_t samples = 1; samples < 200; samples += 13) {
        bp_stop_rule_init(&rule, 0.0, 0.0, samples, 100);
        assert_int_equal(run(&rule, 1.0, 1.0, &state, &looks), BP_STOP_SAMPLES);
        assert_int_equal(state.samples, samples);
        assert_int_equal(looks, 1); /* one stretch: nothing is read on the way */
    }
}

static void checkpoints_are_fixed(void **unused) {
    (void)unused;
    BpStopRule rule;
    bp_stop_rule_init(&rule, 0.01, 0.0, (uint64_t)1 << 26, 1000000);
    assert_int_equal(bp_stop_checkpoint(&rule, 0.0), 16);
    uint64_t count = 16;
    while (count < 1000000) {
        assert_int_equal(bp_stop_checkpoint(&rule, (double)count), count);
        const uint64_t next = bp_stop_checkpoint(&rule, (double)count + 1.0);
        assert_int_equal(next % 4, 0);
        assert_true(next > count);
        assert_true(count < 64 ? next == count + 4 : (double)next <= 1.126 * (double)count);
        count = next;
    }
}

static void small_pictures_wait_longer(void **unused) {
    (void)unused;
    BpStopRule rule;
    bp_stop_rule_init(&rule, 1.0, 0.0, (uint64_t)1 << 26, 1);
    assert_true(rule.samples_min >= 65536);
    assert_true(bp_stop_first(&rule) >= 65536);
    bp_stop_rule_init(&rule, 1.0, 0.0, 10, 1); /* unless there are not so many */
    assert_int_equal(bp_stop_first(&rule), 10);
}

static void error_is_reached_and_not_passed_by_far(void **unused) {
    (void)unused;
    for (double error = 0.3; error > 1.0e-3; error *= 0.77) {
        BpStopRule rule;
        BpStopState state;
        int looks = 0;
        bp_stop_rule_init(&rule, error, 0.0, (uint64_t)1 << 26, 1000000);
        assert_int_equal(run(&rule, 2.0, 1.0, &state, &looks), BP_STOP_ERROR);
        assert_true(state.nrmse <= error);
        const double needed = fmax(16.0, pow(2.0 / error, 2.0));
        assert_true((double)state.samples <= 1.13 * needed + 4.0);
        assert_true(looks <= 25);
    }
}

/* An adaptive render's error falls faster at first than its samples foretell: shorter jumps, and more looks.
 */
static void adaptive_goes_in_smaller_steps(void **unused) {
    (void)unused;
    for (double error = 0.3; error > 1.0e-3; error *= 0.77) {
        BpStopRule rule;
        BpStopState state = {.samples = 0};
        bp_stop_rule_init(&rule, error, 0.0, (uint64_t)1 << 26, 1000000);
        assert_false(rule.adaptive);
        rule.adaptive = true;
        uint64_t next = bp_stop_first(&rule);
        int looks = 0;
        do {
            state.samples = next;
            state.nrmse = (next > 16 ? 1.4 : 2.0) / sqrt((double)next);
            assert_true(++looks <= 40);
        } while (bp_stop_decide(&rule, &state, &next) == BP_STOP_NOT_YET &&
                 next <= 2.26 * (double)state.samples);
        assert_true(state.nrmse <= error);
        assert_true((double)state.samples <= 1.13 * fmax(16.0, pow(1.4 / error, 2.0)) + 20.0);
    }
    BpStopRule rule;
    BpStopState state;
    int looks = 0;
    bp_stop_rule_init(&rule, 0.0, 10.0, (uint64_t)1 << 26, 10000);
    rule.adaptive = true;
    assert_int_equal(run(&rule, 1.0, 100.0, &state, &looks), BP_STOP_TIME);
    assert_true(state.seconds <= 10.0 * (1.0 + 1.0e-9) && state.seconds > 9.9);
}

static void the_clock_does_not_move_an_error_rule(void **unused) {
    (void)unused;
    BpStopRule rule;
    BpStopState slow, fast;
    int looks = 0;
    bp_stop_rule_init(&rule, 0.02, 0.0, (uint64_t)1 << 26, 10000);
    run(&rule, 1.0, 0.1, &slow, &looks);
    run(&rule, 1.0, 1.0e6, &fast, &looks);
    assert_int_equal(slow.samples, fast.samples);
}

static void time_is_used_and_kept(void **unused) {
    (void)unused;
    for (double seconds = 0.01; seconds < 1000.0; seconds *= 3.7) {
        for (double rate = 0.02; rate < 1.0e5; rate *= 13.0) {
            BpStopRule rule;
            BpStopState state;
            int looks = 0;
            bp_stop_rule_init(&rule, 0.0, seconds, (uint64_t)1 << 26, 10000);
            assert_int_equal(run(&rule, 1.0, rate, &state, &looks), BP_STOP_TIME);
            /* One sample a pixel there must be; beyond it no stretch begins that would not end in time. */
            assert_true(state.seconds <= fmax(seconds, 1.0 / rate) * (1.0 + 1.0e-9));
            assert_true(state.seconds + 1.0 / rate >= seconds * (1.0 - 1.0e-9));
        }
    }
}

/* Samples that were there before took no time: the rate is that of the samples since. */
static void a_resumed_render_knows_its_rate(void **unused) {
    (void)unused;
    BpStopRule rule;
    uint64_t next = 0;
    bp_stop_rule_init(&rule, 0.0, 100.0, (uint64_t)1 << 26, 100);
    BpStopState state = {.samples = 1000, .samples_before = 1000, .seconds = 0.001};
    assert_int_equal(bp_stop_decide(&rule, &state, &next), BP_STOP_NOT_YET);
    assert_int_equal(next, 1001); /* one tells */
    state = (BpStopState){.samples = 1010, .samples_before = 1000, .seconds = 50};
    assert_int_equal(bp_stop_decide(&rule, &state, &next), BP_STOP_NOT_YET);
    assert_in_range(next, 1011, 1020);
    state.seconds = 99;
    assert_int_equal(bp_stop_decide(&rule, &state, &next), BP_STOP_TIME);
    state = (BpStopState){.samples = 1000, .samples_before = 1000, .seconds = 101};
    assert_int_equal(bp_stop_decide(&rule, &state, &next), BP_STOP_TIME);
}

static void the_first_rule_counts(void **unused) {
    (void)unused;
    BpStopRule rule;
    BpStopState state;
    int looks = 0;
    bp_stop_rule_init(&rule, 0.01, 10.0, 500, 10000);
    assert_int_equal(run(&rule, 0.1, 1000.0, &state, &looks), BP_STOP_ERROR);
    assert_int_equal(run(&rule, 1.0, 10.0, &state, &looks), BP_STOP_TIME);
    assert_int_equal(run(&rule, 10.0, 1000.0, &state, &looks), BP_STOP_SAMPLES);
    assert_int_equal(state.samples, 500);
}

static void black_constant_and_unknown_end(void **unused) {
    (void)unused;
    BpStopRule rule;
    uint64_t next = 0;
    bp_stop_rule_init(&rule, 0.01, 0.0, 1000, 10000);
    const BpStopState black = {.samples = 16, .seconds = 1.0, .nrmse = NAN, .black = true};
    const BpStopState constant = {.samples = 16, .seconds = 1.0, .nrmse = 0.0};
    const BpStopState unknown = {.samples = 16, .seconds = 1.0, .nrmse = NAN};
    const BpStopState early = {.samples = 8, .seconds = 1.0, .nrmse = 0.0};
    assert_int_equal(bp_stop_decide(&rule, &black, &next), BP_STOP_BLACK);
    assert_int_equal(bp_stop_decide(&rule, &constant, &next), BP_STOP_CONSTANT);
    assert_int_equal(bp_stop_decide(&rule, &unknown, &next), BP_STOP_INVALID);
    assert_int_equal(bp_stop_decide(&rule, &early, &next), BP_STOP_NOT_YET);
    assert_true(next > 8);
}

static void expectation(void **unused) {
    (void)unused;
    BpStopRule rule;
    bp_stop_rule_init(&rule, 0.01, 0.0, 1000000, 10000);
    const BpStopState state = {.samples = 100, .seconds = 1.0, .nrmse = 0.1};
    assert_true(fabs(bp_stop_expected(&rule, &state) - 10000.0) < 1.0);
    bp_stop_rule_init(&rule, 0.01, 5.0, 1000000, 10000);
    assert_true(fabs(bp_stop_expected(&rule, &state) - 500.0) < 1.0);
    bp_stop_rule_init(&rule, 0.01, 5.0, 300, 10000);
    assert_true(bp_stop_expected(&rule, &state) == 300.0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_alone),
        cmocka_unit_test(checkpoints_are_fixed),
        cmocka_unit_test(small_pictures_wait_longer),
        cmocka_unit_test(error_is_reached_and_not_passed_by_far),
        cmocka_unit_test(adaptive_goes_in_smaller_steps),
        cmocka_unit_test(the_clock_does_not_move_an_error_rule),
        cmocka_unit_test(time_is_used_and_kept),
        cmocka_unit_test(a_resumed_render_knows_its_rate),
        cmocka_unit_test(the_first_rule_counts),
        cmocka_unit_test(black_constant_and_unknown_end),
        cmocka_unit_test(expectation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
