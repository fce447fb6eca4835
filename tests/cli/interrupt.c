/* Signals: before there is something to save, the first, the same key twice, the second. */
#include "cli/interrupt.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

enum { SURVIVED = 7 };

static void pause_ms(long milliseconds) {
    struct timespec left = {.tv_sec = milliseconds / 1000, .tv_nsec = milliseconds % 1000 * 1000000};
    while (nanosleep(&left, &left) != 0) continue;
}

/* Exit code of a child that installs, catches if told, and raises `first` and, after a pause, `second`. */
static int exit_code(bool catches, int first, long pause, int second) {
    const pid_t child = fork();
    if (child == 0) {
        bp_interrupt_install();
        if (catches) bp_interrupt_catch();
        if (bp_interrupted()) _exit(1);
        raise(first);
        if (!bp_interrupted()) _exit(2);
        pause_ms(pause);
        if (second != 0) raise(second);
        _exit(SURVIVED);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void nothing_to_save(void **unused) {
    (void)unused;
    assert_int_equal(exit_code(false, SIGINT, 0, 0), 130);
    assert_int_equal(exit_code(false, SIGTERM, 0, 0), 130);
}

static void first_is_noted(void **unused) {
    (void)unused;
    assert_int_equal(exit_code(true, SIGINT, 0, 0), SURVIVED);
    assert_int_equal(exit_code(true, SIGTERM, 0, 0), SURVIVED);
}

static void same_key_counts_once(void **unused) {
    (void)unused;
    assert_int_equal(exit_code(true, SIGINT, 0, SIGINT), SURVIVED);
}

static void second_ends_at_once(void **unused) {
    (void)unused;
    assert_int_equal(exit_code(true, SIGINT, 400, SIGINT), 130);
    assert_int_equal(exit_code(true, SIGINT, 400, SIGTERM), 130);
    assert_int_equal(exit_code(true, SIGTERM, 400, SIGINT), 130);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_to_save),
        cmocka_unit_test(first_is_noted),
        cmocka_unit_test(same_key_counts_once),
        cmocka_unit_test(second_ends_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
