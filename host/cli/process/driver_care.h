/* driver_care.h: starts the OpenCL drivers, even if one of them hangs or crashes.
 *
 * In:    the command line.   Out: drivers that have started, without those that are broken; or an error that
 * names these.
 * Knows: fault signals, how a program restarts itself.   Does not know: what devices are used for.
 *
 * Drivers start in this process, which costs nothing as long as they work. When one hangs, crashes or ends
 * the process, the process is unusable, since the loader was interrupted. So the program restarts itself by
 * exec with the same arguments. This time it first tries the drivers one by one in child processes
 * (device_survey.h) and excludes the broken ones. Nothing has been rendered or written by then. */
#ifndef BP_CLI_PROCESS_DRIVER_CARE_H
#define BP_CLI_PROCESS_DRIVER_CARE_H

#include "cli/line/options.h"
#include "device_survey.h"

/* Called by main, before the command line is parsed: the arguments for a restart. */
void bp_driver_care_begin(int argc, char **argv);

/* Puts back the text that was read from standard input, so that it can be read again after a restart. If that
 * is impossible, the program will not restart. */
void bp_driver_care_keep_input(const char *text, size_t length);

/* Tries the drivers in child processes if necessary: one is known to be broken, or PoCL finds no linker and
 * may end the process. Otherwise the survey stays empty. Call it before this process uses OpenCL.
 * BP_ERR_DEVICE: no list, although no single driver fails. Clear the survey in any case, once the drivers
 * have started. */
BpStatus bp_driver_care_survey(const BpCommandLine *line, BpDeviceSurvey *survey, BpError *err);

/* Starts the drivers in this process; may restart the program. From then on, a driver that crashes while it
 * opens a device is reported, and the exit code is 1. BP_ERR_DEVICE: a driver hangs and the program cannot
 * restart; BP_ERR_INTERRUPTED. */
BpStatus bp_driver_care_start(const BpCommandLine *line, BpError *err);

#endif
