/* child_process.h: work in a process of its own, so that a driver that crashes takes nothing with it.
 *
 * In:    a function and its argument.   Out: the bytes that it wrote, or how its process ended.
 * Knows: processes, pipes.              Does not know: what is done there.
 *
 * Drivers start threads that do not survive a fork: call this only before the present process has touched
 * OpenCL. */
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
