/* standard_streams.c: see standard_streams.h. */
#include "standard_streams.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

void bp_streams_open(void) {
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
        if (fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
        /* The lowest free number is taken: that of this stream, as those below are open by now. */
        if (open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) (void)!open("/", O_RDONLY);
    }
}

BpStatus bp_streams_finish(BpError *err) {
    /* A write that failed earlier has left its mark, but its reason may be forgotten. */
    const bool failed_before = ferror(stdout) != 0;
    const bool closed = fclose(stdout) == 0;
    if (closed && !failed_before) return BP_OK;
    return bp_fail(err, BP_ERR_FILE, "cannot write to standard output: %s",
                   closed ? "not all of it was taken" : strerror(errno));
}
