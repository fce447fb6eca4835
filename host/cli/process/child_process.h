/* child_process.h: runs a function in a child process, so that a driver that crashes or hangs does not take
 * the program down.
 *
 * In:    a function and its argument, a time limit.   Out: the bytes that it wrote, and how its process
 * ended.
 * Knows: processes, pipes, PoCL's need of a linker (for the message).   Does not know: what the
 * function does.
 *
 * Drivers start threads, which do not survive a fork: call this only before this process has used OpenCL. */
#ifndef BP_CLI_PROCESS_CHILD_PROCESS_H
#define BP_CLI_PROCESS_CHILD_PROCESS_H

#include "base/status.h"

#include <stdio.h>

typedef enum BpChildEnd {
    BP_CHILD_DONE,
    BP_CHILD_FAILED, /* the function failed, or a driver ended the process */
    BP_CHILD_CRASHED,
    BP_CHILD_HUNG /* it was killed at the time limit */
} BpChildEnd;

typedef struct BpChildReport {
    char *bytes; /* the output, followed by a 0, also of a child that failed; free() */
    size_t size;
    BpChildEnd end;
    char failure[256]; /* one line about how it ended ("crashed: Segmentation fault"); "": done */
} BpChildReport;

/* Runs `work(argument, out)` in a child process and collects what it wrote to `out`. `work` returns false if
 * it failed, after writing the reason to `out`. `seconds`: the child is killed after this time; 0: never.
 * BP_OK also if the child failed, crashed or hung. BP_ERR_MEMORY or BP_ERR_FILE if no process or pipe could
 * be created. */
BpStatus bp_run_in_child(bool (*work)(void *argument, FILE *out), void *argument, double seconds,
                         BpChildReport *report, BpError *err);

#endif
