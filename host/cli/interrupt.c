/* interrupt.c: see interrupt.h. */
#include "interrupt.h"

#include "../base/status.h"

#include <signal.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* 0: no signal yet; else the time of the first one, in milliseconds, with bit 0 set. */
static volatile sig_atomic_t interrupted_ms;

enum { SAME_KEY_MS = 250 };

/* clock_gettime and _exit may be called in a signal handler (POSIX.1-2017, 2.4.3). */
static void on_signal(int signal_number) {
    (void)signal_number;
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const int now_ms = (int)((now.tv_sec % 1000000) * 1000 + now.tv_nsec / 1000000);
    const int first_ms = interrupted_ms;
    if (first_ms == 0)
        interrupted_ms = now_ms | 1;
    else if (now_ms - first_ms > SAME_KEY_MS)
        _exit(130);
}

void bp_interrupt_catch(void) {
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

bool bp_interrupted(void) {
    return interrupted_ms != 0;
}
