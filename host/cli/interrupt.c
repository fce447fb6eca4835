/* interrupt.c: see interrupt.h. */
#include "interrupt.h"

#include <signal.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { NOTHING_TO_SAVE = -1, SAME_KEY_MS = 250, EXIT_INTERRUPTED = 130 };

/* NOTHING_TO_SAVE; or 0: no signal yet; or the time of the first one, in milliseconds, with bit 0 set. */
static volatile sig_atomic_t interrupted_ms = NOTHING_TO_SAVE;

/* clock_gettime and _exit may be called in a signal handler (POSIX.1-2017, 2.4.3). */
static void on_signal(int signal_number) {
    (void)signal_number;
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const int now_ms = (int)((now.tv_sec % 1000000) * 1000 + now.tv_nsec / 1000000) | 1;
    const int first_ms = interrupted_ms;
    if (first_ms == NOTHING_TO_SAVE || (first_ms != 0 && now_ms - first_ms > SAME_KEY_MS))
        _exit(EXIT_INTERRUPTED);
    if (first_ms == 0) interrupted_ms = now_ms;
}

void bp_interrupt_install(void) {
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

void bp_interrupt_catch(void) {
    if (interrupted_ms != NOTHING_TO_SAVE) return;
    interrupted_ms = 0;
    /* A driver's compiler (LLVM) may by now have put a handler of its own before this one, and while that
     * runs a second signal ends the program. It has done its work: kernels are built before there is anything
     * to save. */
    bp_interrupt_install();
}

bool bp_interrupted(void) {
    return interrupted_ms > 0;
}
