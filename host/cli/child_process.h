/* child_process.h: runs a function in a child process, so that a driver that crashes does not end the
 * program.
 *
 * In:    a function and its argument.   Out: the bytes that it wrote, or how its process ended.
 * Knows: processes, pipes, PoCL's need of a linker (for the message).   Does not know: what the function
 * does.
 *
 * Drivers start threads, which do not survive a fork: call this only before this process has used OpenCL. */
#ifndef BP_CLI_CHILD_PROCESS_H
#define BP_CLI_CHILD_PROCESS_H

#include "base/status.h"

#include <stdio.h>

/* Runs `work(argument, out)` in a child process and collects what it wrote to `out`, with a 0 behind it; the
 * caller frees *bytes. `work` returns false when it failed, having written why to `out`. BP_OK also when the
 * child failed or crashed: then *failure holds one line that says how ("crashed: Segmentation fault"), else
 * it is "". BP_ERR_MEMORY or BP_ERR_FILE when there was no process or pipe. */
BpStatus bp_run_in_child(bool (*work)(void *argument, FILE *out), void *argument, char **bytes, size_t *size,
                         char failure[256], BpError *err);

#endif
