/* interrupt.c: see interrupt.h. */
#include "interrupt.h"

#include "base/output_file.h"

#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <time.h>
#include <unistd.h>

enum { NOTHING_TO_SAVE = -1, SAME_KEY_MS = 250, EXIT_INTERRUPTED = 130 };

/* NOTHING_TO_SAVE; or 0: no signal yet; or the time of the first one, in milliseconds, with bit 0 set. */
static atomic_int interrupted_ms = NOTHING_TO_SAVE;

/* Whether a second one means "at once". A limit on processor time tells again every second, and a terminal
 * that goes away tells through the shell and by itself. */
static bool hastens(int number) {
    return number == SIGINT || number == SIGTERM;
}

static void note_signal(int number) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const int now_ms = (int)((now.tv_sec % 1000000) * 1000 + now.tv_nsec / 1000000) | 1;
    const int first_ms = interrupted_ms;
    if (first_ms == NOTHING_TO_SAVE ||
        (first_ms != 0 && hastens(number) && now_ms - first_ms > SAME_KEY_MS)) {
        bp_output_abandon();
        _exit(EXIT_INTERRUPTED);
    }
    if (first_ms == 0) interrupted_ms = now_ms;
}

static sigset_t watched_signals(void) {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    sigaddset(&set, SIGXCPU);
    /* nohup means it; but a blocked signal becomes pending even if it is ignored, and would be waited for. */
    struct sigaction hangup;
    if (sigaction(SIGHUP, NULL, &hangup) != 0 || hangup.sa_handler != SIG_IGN) sigaddset(&set, SIGHUP);
    return set;
}

static void *watch(void *began) {
    const sigset_t set = watched_signals();
    int number;
    sem_post(began);
    for (;;)
        if (sigwait(&set, &number) == 0) note_signal(number);
    return NULL;
}

/* A thread waits for the signals, and every other one holds them off. A handler would not do: Ctrl-C reaches
 * every process of the terminal, and a driver's linker, which starts with this process's mask but not with
 * its handlers, would die of it and take the driver and us along; and a driver's compiler (LLVM) puts
 * handlers of its own before ours. */
void bp_interrupt_install(void) {
    const sigset_t set = watched_signals();
    sigset_t held = set;
    pthread_t watcher;
    sem_t began;
    /* A hangup that is ignored as well: LLVM's handler, which comes before that, removes the files that it is
     * compiling into. */
    sigaddset(&held, SIGHUP);
    /* Ignored ones, as a shell leaves them to what it runs in the background, need not become pending. */
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
    signal(SIGXCPU, SIG_DFL);
    pthread_sigmask(SIG_BLOCK, &held, NULL);
    sem_init(&began, 0, 0);
    if (pthread_create(&watcher, NULL, watch, &began) == 0) {
        pthread_detach(watcher);
        /* A fork while a thread is starting copies the locks that it holds then (AddressSanitizer takes
         * some), and nobody in the child will ever open them. */
        while (sem_wait(&began) != 0) {
        }
    } else {
        pthread_sigmask(SIG_UNBLOCK, &held, NULL); /* they end the program, as they do by default */
    }
    sem_destroy(&began);
}

void bp_interrupt_catch(void) {
    int before = NOTHING_TO_SAVE;
    atomic_compare_exchange_strong(&interrupted_ms, &before, 0);
}

bool bp_interrupted(void) {
    return interrupted_ms > 0;
}
