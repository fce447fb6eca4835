/* child_process.c: see child_process.h. */
#include "child_process.h"

#include "base/clock.h"
#include "base/memory_limit.h"
#include "interrupt.h"
#include "opencl/pocl.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

/* Exit codes of the child: the work succeeded; it failed and wrote the reason. No others are ours, least of
 * all 0: a driver may have ended the process. */
enum { CHILD_DONE = 113, CHILD_FAILED = 114 };

/* How often the parent polls for an interruption, and after how many polls it signals the child again. */
enum { LOOK_MS = 100, LOOKS_PER_SIGNAL = 10 };

/* Ends the child with the parent, even if a signal that cannot be caught ends that. */
static void end_with_parent(pid_t parent) {
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(CHILD_FAILED); /* it was gone before */
#else
    (void)parent;
#endif
}

static _Noreturn void be_child(bool (*work)(void *argument, FILE *out), void *argument, int descriptor,
                               pid_t parent) {
    end_with_parent(parent);
    bp_interrupt_install(); /* fork does not copy the thread that waits for signals */
    FILE *out = fdopen(descriptor, "w");
    if (out == NULL) _exit(CHILD_FAILED);
    const bool good = work(argument, out);
    const bool written = fclose(out) == 0;
    /* Without the parent's atexit handlers and buffers. */
    _exit(good && written ? CHILD_DONE : CHILD_FAILED);
}

/* Waits until the child has written something or ended. A signal that reached the parent alone is forwarded.
 * A child that does not react to the first, during a driver's long call, is ended by the second. False: the
 * time limit was reached. */
static bool wait_for_child(int descriptor, pid_t child, double deadline) {
    struct pollfd end = {.fd = descriptor, .events = POLLIN};
    for (unsigned looks = 0; poll(&end, 1, LOOK_MS) <= 0;) {
        if (bp_clock_seconds() > deadline) return false;
        if (!bp_interrupted()) continue;
        if (looks % LOOKS_PER_SIGNAL == 0) kill(child, SIGTERM);
        ++looks;
    }
    return true;
}

/* *hung: the child was killed. */
static BpStatus read_all(int descriptor, pid_t child, double deadline, BpChildReport *report, bool *hung,
                         BpError *err) {
    size_t room = 4096, used = 0;
    char *text = malloc(room);
    while (text != NULL) {
        if (!wait_for_child(descriptor, child, deadline)) {
            *hung = true;
            kill(child, SIGKILL);
            break;
        }
        const ssize_t got = read(descriptor, text + used, room - used - 1);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        used += (size_t)got;
        if (room - used > 1) continue;
        char *larger = realloc(text, room *= 2);
        if (larger == NULL) free(text);
        text = larger;
    }
    if (text == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the output of a child process");
    text[used] = '\0';
    report->bytes = text;
    report->size = used;
    return BP_OK;
}

static void describe_end(int ended, bool hung, double seconds, BpChildReport *report) {
    char *failure = report->failure;
    const size_t size = sizeof report->failure;
    report->end = BP_CHILD_DONE;
    failure[0] = '\0';
    if (hung) {
        report->end = BP_CHILD_HUNG;
        snprintf(failure, size, "hung: there was no answer within %.3g s", seconds);
    } else if (WIFSIGNALED(ended)) {
        report->end = BP_CHILD_CRASHED;
        snprintf(failure, size, "crashed: %s", strsignal(WTERMSIG(ended)));
        if (WTERMSIG(ended) == SIGABRT && bp_memory_limit() > 0)
            snprintf(failure, size,
                     "crashed: %s, perhaps for lack of memory, of which this process may have %.0f MiB "
                     "(ulimit -v)",
                     strsignal(SIGABRT), (double)bp_memory_limit() / 1048576);
        if (WTERMSIG(ended) == SIGABRT && !bp_pocl_finds_linker())
            snprintf(failure, size,
                     "crashed: %s; PoCL, the driver for CPUs, needs the linker `ld`, which is not in PATH: "
                     "install binutils, or add the folder of `ld` to PATH",
                     strsignal(SIGABRT));
    } else if (WEXITSTATUS(ended) == CHILD_FAILED) {
        report->end = BP_CHILD_FAILED;
        snprintf(failure, size, "%s", report->size > 0 ? report->bytes : "failed without a message");
    } else if (WEXITSTATUS(ended) != CHILD_DONE) {
        report->end = BP_CHILD_FAILED;
        snprintf(failure, size, "ended the process with exit code %d", WEXITSTATUS(ended));
    }
}

BpStatus bp_run_in_child(bool (*work)(void *argument, FILE *out), void *argument, double seconds,
                         BpChildReport *report, BpError *err) {
    int ends[2];
    *report = (BpChildReport){.end = BP_CHILD_FAILED};
    if (pipe(ends) != 0) return bp_fail(err, BP_ERR_FILE, "cannot open a pipe: %s", strerror(errno));
    fflush(NULL); /* or the child would write it again */
    const pid_t parent = getpid(), child = fork();
    if (child == 0) {
        close(ends[0]);
        be_child(work, argument, ends[1], parent);
    }
    close(ends[1]);
    if (child < 0) {
        close(ends[0]);
        return bp_fail(err, BP_ERR_MEMORY, "cannot start a process: %s", strerror(errno));
    }
    bool hung = false;
    const double deadline = seconds > 0 ? bp_clock_seconds() + seconds : INFINITY;
    const BpStatus status = read_all(ends[0], child, deadline, report, &hung, err);
    close(ends[0]);
    int ended = 0;
    while (waitpid(child, &ended, 0) < 0 && errno == EINTR) {
    }
    describe_end(ended, hung, seconds, report);
    return status;
}
