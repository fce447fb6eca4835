/* driver_care.c: see driver_care.h. */
#ifdef __linux__
#define _GNU_SOURCE /* memfd_create, syscall */
#endif
#include "driver_care.h"

#include "base/memory_limit.h"
#include "base/output_file.h"
#include "cli/terminal/page.h"
#include "interrupt.h"
#include "opencl/driver_start.h"
#include "opencl/pocl.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/syscall.h>
#endif

/* In the environment of a restarted program: the reason. */
#define AGAIN "BALLPARK_DRIVERS_ONE_BY_ONE"

static const struct {
    int number;
    const char *name;
} faults[] = {{SIGSEGV, "Segmentation fault"},
              {SIGABRT, "Aborted"},
              {SIGILL, "Illegal instruction"},
              {SIGBUS, "Bus error"},
              {SIGFPE, "Floating point exception"}};
enum { FAULTS = sizeof faults / sizeof faults[0] };

/* What a handler of signals needs. */
static struct {
    char **argv;
    pid_t process; /* a driver's own children inherit the handlers, and must not be affected */
    struct sigaction before[FAULTS], of_driver[FAULTS]; /* who handled them until this did */
    bool is_watching, has_passed_on;
    bool may_restart, is_input_lost, quiet;
} care;

/* ---- starting again: all of it may be called by a handler of signals ---------------------------------- */

/* By one write, since other ranks may print the same. NULL ends the list of texts. */
static void tell(const char *const *texts) {
    char line[1024] = "";
    for (; *texts != NULL; ++texts) strncat(line, *texts, sizeof line - strlen(line) - 1);
    if (write(STDERR_FILENO, line, strlen(line)) < 0) return; /* a failure cannot be reported */
}

/* Returns where it cannot. */
static void start_again(void) {
    char path[4096];
    if (!care.may_restart) return;
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    if (length <= 0) return;
    path[length] = '\0';
    execv(path, care.argv);
}

/* `how`: "crashed (Aborted)". */
static void end_with_words(const char *how, const char *doing) {
    const bool starts = strcmp(doing, "starting") == 0;
    const char *const again[] = {"an OpenCL driver ",           how, " while ", doing,
                                 ": each is tried by itself\n", NULL};
    const char *const end[] = {
        "ballpark: an OpenCL driver ",
        how,
        " while ",
        doing,
        starts ? "; `ballpark devices` shows which one: remove it, or set OCL_ICD_VENDORS "
                 "to the .icd file of another\n"
               : "; choose another device with --device (`ballpark devices` lists them)\n",
        NULL};
    if (starts && care.may_restart && !care.quiet) tell(again);
    if (starts) start_again();
    tell(end);
    _exit(bp_status_exit_code(BP_ERR_DEVICE));
}

/* A driver that runs out of memory ends the process, as an uncaught C++ exception does. */
static void end_without_memory(void) {
    const char *const text[] = {
        "ballpark: out of memory: an OpenCL driver was refused memory and gave up; give this process more "
        "(`ulimit -v` shows its limit), or another --device\n",
        NULL};
    tell(text);
    bp_output_abandon();
    _exit(bp_status_exit_code(BP_ERR_MEMORY));
}

static void on_fault(int number, siginfo_t *info, void *context) {
    const char *doing = bp_driver_doing();
    size_t f = 0;
    (void)context;
    while (f + 1 < FAULTS && faults[f].number != number) ++f;
    if (number == SIGABRT && getpid() == care.process && bp_memory_is_short()) end_without_memory();
    if (doing == NULL || getpid() != care.process) { /* not our affair */
        /* A driver's handler (LLVM's) may reinstall this one, and must not be called again. */
        sigaction(number, care.has_passed_on ? &care.before[f] : &care.of_driver[f], NULL);
        care.has_passed_on = true;
        if (info->si_code <= 0) raise(number); /* else the same instruction faults again */
        return;
    }
    char how[64] = "crashed (";
    strcat(how, faults[f].name);
    strcat(how, ")");
    end_with_words(how, doing);
}

static void on_exit_by_driver(void) {
    const char *doing = bp_driver_doing();
    if (doing != NULL && getpid() == care.process) end_with_words("ended the program", doing);
}

#ifdef __linux__
/* The program's own code lies between these, which linkers define. */
extern const char code_begin[] __asm__("__executable_start"), code_end[] __asm__("etext");

static _Noreturn void leave(int status, const char *caller) {
    if (caller < code_begin || caller >= code_end) on_exit_by_driver();
    for (;;) syscall(SYS_exit_group, status);
}

/* These end a process at once. Loaded drivers find the program's functions before those of the C library. */
#define VISIBLE __attribute__((visibility("default")))
VISIBLE _Noreturn void _exit(int status) {
    leave(status, __builtin_return_address(0));
}

VISIBLE _Noreturn void _Exit(int status) {
    leave(status, __builtin_return_address(0));
}
#endif

/* ------------------------------------------------------------------------------------------------------- */

/* A driver may install handlers of its own when it starts (LLVM does), after which abort() would end the
 * program without calling this one. So this is repeated while they start, and once more at the end. */
static void watch_for_faults(void) {
    struct sigaction action = {.sa_sigaction = on_fault, .sa_flags = SA_SIGINFO | SA_NODEFER | SA_ONSTACK},
                     found;
    sigemptyset(&action.sa_mask);
    for (size_t f = 0; f < FAULTS; ++f) {
        sigaction(faults[f].number, &action, &found);
        if (!care.is_watching) care.before[f] = found;
        if (!care.is_watching || (found.sa_flags & SA_SIGINFO) == 0 || found.sa_sigaction != on_fault)
            care.of_driver[f] = found;
    }
    care.is_watching = true;
}

static bool stops(void) {
    watch_for_faults();
    return bp_interrupted();
}

void bp_driver_care_begin(int argc, char **argv) {
    care.argv = calloc((size_t)argc + 1, sizeof *care.argv);
    if (care.argv != NULL) memcpy(care.argv, argv, (size_t)argc * sizeof *argv);
}

void bp_driver_care_keep_input(const char *text, size_t length) {
    care.is_input_lost = true;
#ifdef __linux__
    const int copy = memfd_create("standard input", MFD_CLOEXEC);
    if (copy < 0) return;
    size_t written = 0;
    while (written < length) {
        const ssize_t more = write(copy, text + written, length - written);
        if (more <= 0) break;
        written += (size_t)more;
    }
    care.is_input_lost =
        written < length || lseek(copy, 0, SEEK_SET) != 0 || dup2(copy, STDIN_FILENO) != STDIN_FILENO;
    close(copy);
#else
    (void)text, (void)length;
#endif
}

BpStatus bp_driver_care_survey(const BpCommandLine *line, BpDeviceSurvey *survey, BpError *err) {
    double seconds;
    const bool again = getenv(AGAIN) != NULL;
    if (!again && bp_pocl_finds_linker()) return BP_OK;
    BP_TRY(bp_driver_seconds(&seconds, err));
    const BpStatus status = again ? bp_device_survey_each(seconds, line->quiet, survey, err)
                                  : bp_device_survey(seconds, line->quiet, survey, err);
    if (status != BP_ERR_BROKEN_DEVICE) return status;
    if (err != NULL) err->code = BP_ERR_DEVICE; /* as bp_device_find() has it */
    return BP_ERR_DEVICE;
}

BpStatus bp_driver_care_start(const BpCommandLine *line, BpError *err) {
    const bool again = getenv(AGAIN) != NULL;
    double seconds;
    BP_TRY(bp_driver_seconds(&seconds, err));
    /* One of several processes that share a job cannot restart alone. */
    care.may_restart = !again && line->comm == NULL && care.argv != NULL && !care.is_input_lost;
    care.quiet = line->quiet;
    if (care.process == 0) {
        atexit(on_exit_by_driver);
        (void)at_quick_exit(on_exit_by_driver);
    }
    care.process = getpid();
    setenv(AGAIN, "yes", 1);
    watch_for_faults();
    const BpStatus status = bp_drivers_start_until(stops, err);
    watch_for_faults();
    if (status == BP_ERR_BROKEN_DEVICE && care.may_restart) {
        bp_say(line, "the OpenCL drivers have not answered within %.3g s: each is tried by itself", seconds);
        start_again();
    }
    unsetenv(AGAIN);
    if (status != BP_ERR_BROKEN_DEVICE) return status;
    if (err != NULL) err->code = BP_ERR_DEVICE;
    return BP_ERR_DEVICE;
}
