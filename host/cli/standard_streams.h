/* standard_streams.h: standard input, output and error as the rest of the program may take them for granted.
 *
 * Knows: descriptors 0 to 2.   Does not know: what is written to them. */
#ifndef BP_CLI_STANDARD_STREAMS_H
#define BP_CLI_STANDARD_STREAMS_H

#include "base/status.h"

/* For main, before anything is opened: a standard stream that is closed is opened on /dev/null, or the next
 * file that is opened would take its place, and what is meant for the stream would be written into it. It is
 * opened the wrong way round, so that what is written to a closed stream fails and is not silently lost. */
void bp_streams_open(void);

/* For main, at the end: whether everything that was to go to standard output went there. BP_ERR_FILE. */
BpStatus bp_streams_finish(BpError *err);

#endif
