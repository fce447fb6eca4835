/* test_interrupt.c: signals: before there is something to save, the first, the same key twice, the second;
 * and who gets none. */
#include "base/clock.h"
#include "cli/process/interrupt.h"

#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

enum { SURVIVED = 7, NOT_NOTED = 2 };
#define LIMIT_SECONDS 60 /* only so that a hang is a failure */

static void pause_ms(long milliseconds) {
    struct timespec left = {.tv_sec = milliseconds / 1000, .tv_nsec = milliseconds % 1000 * 1000000};
    while (nanosleep(&left, &left) != 0) continue;
}

typedef struct Signals {
    bool catches;
    int first;
    long pause; /* milliseconds between the two, at least */
    int second; /* 0: none */
    long after; /* milliseconds in which the second may end the process */
} Signals;

static _Noreturn void be_child(const Signals *signals) {
    bp_interrupt_install();
    if (signals->catches) bp_interrupt_catch();
    if (bp_interrupted()) _exit(1);
    kill(getpid(), signals->first);
    /* Another thread notes it, in its own time. */
    const double start = bp_clock_seconds();
    while (!bp_interrupted() && bp_clock_seconds() - start < LIMIT_SECONDS) pause_ms(1);
    if (!bp_interrupted()) _exit(NOT_NOTED);
    pause_ms(signals->pause);
    if (signals->second != 0) {
        kill(getpid(), signals->second);
        pause_ms(signals->after);
    }
    _exit(SURVIVED);
}

/* Exit code of a child that installs, catches if told, and sends itself the signals; *seconds that it took.
 */
static int exit_code(const Signals *signals, double *seconds) {
    const double start = bp_clock_seconds();
    const pid_t child = fork();
    if (child == 0) be_child(signals);
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    if (seconds != NULL) *seconds = bp_clock_seconds() - start;
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void nothing_to_save(void **unused) {
    (void)unused;
    assert_int_equal(exit_code(&(Signals){.first = SIGINT}, NULL), 130);
    assert_int_equal(exit_code(&(Signals){.first = SIGTERM}, NULL), 130);
}

static void first_is_noted(void **unused) {
    (void)unused;
    assert_int_equal(exit_code(&(Signals){.catches = true, .first = SIGINT}, NULL), SURVIVED);
    assert_int_equal(exit_code(&(Signals){.catches = true, .first = SIGTERM}, NULL), SURVIVED);
}

/* On a machine that stood still for a quarter of a second between the two, they are two keys and prove
 * nothing: once more. Where one key counts as two, the child ends long before that. */
static void same_key_counts_once(void **unused) {
    (void)unused;
    const Signals signals = {.catches = true, .first = SIGINT, .pause = 50, .second = SIGINT, .after = 300};
    double seconds = 0;
    int code = exit_code(&signals, &seconds);
    for (int again = 0; code == 130 && seconds >= 0.25 && again < 20; ++again)
        code = exit_code(&signals, &seconds);
    assert_int_equal(code, SURVIVED);
}

static void second_ends_at_once(void **unused) {
    (void)unused;
    const int pairs[][2] = {{SIGINT, SIGINT}, {SIGINT, SIGTERM}, {SIGTERM, SIGINT}};
    for (int i = 0; i < 3; ++i) {
        const Signals signals = {.catches = true,
                                 .first = pairs[i][0],
                                 .pause = 400,
                                 .second = pairs[i][1],
                                 .after = 1000 * LIMIT_SECONDS};
        assert_int_equal(exit_code(&signals, NULL), 130);
    }
}

/* Even where whoever started the program ignores the signals, as shells do for what runs in the background.
 */
static void ignored_before(void **unused) {
    (void)unused;
    void (*const before)(int) = signal(SIGINT, SIG_IGN);
    const int code = exit_code(&(Signals){.first = SIGINT}, NULL);
    signal(SIGINT, before);
    assert_int_equal(code, 130);
}

static bool holds_off(void) {
    sigset_t set;
    pthread_sigmask(SIG_SETMASK, NULL, &set);
    return sigismember(&set, SIGINT) == 1 && sigismember(&set, SIGTERM) == 1;
}

static void *look(void *held_off) {
    *(bool *)held_off = holds_off();
    return NULL;
}

/* What a driver starts, threads and programs, has the mask of who started it: Ctrl-C passes it by. */
static void drivers_get_none(void **unused) {
    (void)unused;
    const pid_t child = fork();
    if (child == 0) {
        bool held_off = false;
        pthread_t thread;
        bp_interrupt_install();
        if (!holds_off() || pthread_create(&thread, NULL, look, &held_off) != 0) _exit(1);
        pthread_join(thread, NULL);
        _exit(held_off ? 0 : 2);
    }
    int status = -1;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_to_save),      cmocka_unit_test(first_is_noted),
        cmocka_unit_test(same_key_counts_once), cmocka_unit_test(second_ends_at_once),
        cmocka_unit_test(ignored_before),       cmocka_unit_test(drivers_get_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
