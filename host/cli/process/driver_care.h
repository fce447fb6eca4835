/* driver_care.h: starts the OpenCL drivers, also beside one that hangs or crashes.
 *
 * In:    the command line.   Out: drivers that have started, without those that are broken; or an error that
 * names these.
 * Knows: signals of faults, how a program starts itself again.   Does not know: what devices are used for.
 *
 * Drivers start in this process, which costs nothing while all is well. When one hangs, crashes or ends the
 * process, nothing here can be relied on any more: the loader is in the middle of something. So the program
 * starts itself again in the same process, with the same arguments. This time it first asks the drivers one
 * by one in child processes (device_survey.h) and leaves the broken ones out. Nothing has been rendered or
 * written by then. */
#ifndef BP_CLI_PROCESS_DRIVER_CARE_H
#define BP_CLI_PROCESS_DRIVER_CARE_H

#include "cli/line/options.h"
#include "device_survey.h"

/* For main, before the command line is parsed: what to start again with. */
void bp_driver_care_begin(int argc, char **argv);

/* The text that was read from standard input: put back, so that a program that starts again can read it.
 * Where that is impossible it will not start again. */
void bp_driver_care_keep_input(const char *text, size_t length);

/* Asks the drivers in child processes where that is called for: one has been found to be broken, or PoCL
 * finds no linker and may end the process. Otherwise the survey stays empty. Call it before this process uses
 * OpenCL. BP_ERR_DEVICE: no answer, and no single driver is to blame. Clear the survey in any case, once the
 * drivers have started. */
BpStatus bp_driver_care_survey(const BpCommandLine *line, BpDeviceSurvey *survey, BpError *err);

/* Starts the drivers here; may start the program again. From then on, a driver that crashes while it opens a
 * device is told of, and the exit code is 1. BP_ERR_DEVICE: a driver hangs and the program cannot start
 * again; BP_ERR_INTERRUPTED. */
BpStatus bp_driver_care_start(const BpCommandLine *line, BpError *err);

#endif
