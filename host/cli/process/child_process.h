/* child_process.h: runs a function in a child process, so that a driver that crashes or hangs does not take
 * the program down.
 *
 * In:    a function and its argument, a limit of time.   Out: the bytes that it wrote, and how its process
 * ended.
 * Knows: processes, pipes, PoCL's need of a linker (for the message).   Does not know: what the function
 * does.
 *
 * Drivers start threads, which do not survive a fork: call this only before this process has used OpenCL. */
#ifndef BP_CLI_PROCESS_CHILD_PROCESS_H
#define BP_CLI_PROCESS_CHILD_PROCESS_H

#include "base/status.h"

#include <stdio.h>

typedef enum BpChildEnd {
    BP_CHILD_DONE,
    BP_CHILD_FAILED, /* the function said so, or its driver ended the process */
    BP_CHILD_CRASHED,
    BP_CHILD_HUNG /* it was ended, as its time was up */
} BpChildEnd;

typedef struct BpChildReport {
    char
        *bytes; /* what was written, with a 0 behind it, also by a child that did not end well; with free() */
    size_t size;
    BpChildEnd end;
    char failure[256]; /* one line about how it ended ("crashed: Segmentation fault"); "": done */
} BpChildReport;

/* Runs `work(argument, out)` in a child process and collects what it wrote to `out`. `work` returns false
 * when it failed, having written why to `out`. `seconds`: after so long the child is killed; 0: never. BP_OK
 * also when the child failed, crashed or hung. BP_ERR_MEMORY or BP_ERR_FILE when there was no process or
 * pipe. */
BpStatus bp_run_in_child(bool (*work)(void *argument, FILE *out), void *argument, double seconds,
                         BpChildReport *report, BpError *err);

#endif
