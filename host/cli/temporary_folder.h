/* temporary_folder.h: a folder that is gone when the program is, however it ends.
 *
 * In:    nothing.   Out: an empty folder.
 * Knows: processes, $TMPDIR.   Does not know: what is put there.
 *
 * A small process of its own makes it, waits for this one to end, by Ctrl-C pressed twice or by a crash, and
 * removes the folder with the files in it. Make it before anything touches OpenCL, whose threads do not
 * survive a fork. */
#ifndef BP_CLI_TEMPORARY_FOLDER_H
#define BP_CLI_TEMPORARY_FOLDER_H

#include "base/status.h"

#include <sys/types.h>

typedef struct BpTemporaryFolder {
    char path[512]; /* "": none */
    pid_t keeper;
    int alive; /* a socket to it, which closes when this process ends */
} BpTemporaryFolder;

/* Makes the folder, below $TMPDIR or /tmp. */
BpStatus bp_temporary_folder_make(BpTemporaryFolder *folder, BpError *err);
/* Removes it with the files in it (folders in it are left). Accepts a zeroed one. */
void bp_temporary_folder_remove(BpTemporaryFolder *folder);

#endif
