/* interrupt.c: see interrupt.h. */
#include "interrupt.h"

#include "base/output_file.h"

#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { NOTHING_TO_SAVE = -1, SAME_KEY_MS = 250, EXIT_INTERRUPTED = 130 };
#define PATIENCE_NS 700000000 /* Open MPI's mpirun kills after a second */

/* NOTHING_TO_SAVE; or 0: no signal yet; or the time of the first one, in milliseconds, with bit 0 set. */
static atomic_int interrupted_ms = NOTHING_TO_SAVE;
static pthread_mutex_t explanation_lock = PTHREAD_MUTEX_INITIALIZER;
static char explanation[9000];

/* Whether a second signal of this kind means "end at once". The limit on processor time sends SIGXCPU every
 * second, and a terminal that is closed can send SIGHUP twice: from the shell and from the kernel. */
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
    sigaddset(&set, SIGUSR1);
    sigaddset(&set, SIGUSR2);
    /* Respects nohup: a blocked signal becomes pending even if it is ignored, and sigwait would return it. */
    struct sigaction hangup;
    if (sigaction(SIGHUP, NULL, &hangup) != 0 || hangup.sa_handler != SIG_IGN) sigaddset(&set, SIGHUP);
    return set;
}

static void explain(void) {
    pthread_mutex_lock(&explanation_lock);
    fputs(explanation, stderr);
    pthread_mutex_unlock(&explanation_lock);
}

static void *watch(void *began) {
    const sigset_t set = watched_signals();
    const struct timespec patience = {.tv_nsec = PATIENCE_NS};
    int number;
    sem_post(began);
    for (;;) {
        if (sigwait(&set, &number) != 0) continue;
        note_signal(number);
        while ((number = sigtimedwait(&set, NULL, &patience)) > 0) note_signal(number);
        explain();
    }
    return NULL;
}

/* One thread waits for the signals, and all others block them. Signal handlers would not do: Ctrl-C reaches
 * every process of the terminal, and a driver's linker, which inherits this process's signal mask but not its
 * handlers, would die of it and the driver would end this process; and a driver's compiler (LLVM) installs
 * handlers that run before ours. */
void bp_interrupt_install(void) {
    const sigset_t set = watched_signals();
    sigset_t held = set;
    pthread_t watcher;
    sem_t began;
    /* SIGHUP is blocked even if it is ignored: LLVM would otherwise replace the ignoring by its own handler,
     * which removes the files that it is writing. */
    sigaddset(&held, SIGHUP);
    /* A shell starts background programs with some signals ignored, and ignored signals may never become
     * pending. */
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
    signal(SIGXCPU, SIG_DFL);
    signal(SIGUSR1, SIG_DFL);
    signal(SIGUSR2, SIG_DFL);
    pthread_sigmask(SIG_BLOCK, &held, NULL);
    sem_init(&began, 0, 0);
    if (pthread_create(&watcher, NULL, watch, &began) == 0) {
        pthread_detach(watcher);
        /* Waits until the thread runs: a fork while it starts would copy the locks that it holds
         * (AddressSanitizer takes some), and nothing in the child would ever release them. */
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

void bp_interrupt_explain(const char *text) {
    pthread_mutex_lock(&explanation_lock);
    snprintf(explanation, sizeof explanation, "%s", text);
    pthread_mutex_unlock(&explanation_lock);
}
