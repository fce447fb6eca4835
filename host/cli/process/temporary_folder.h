/* temporary_folder.h: a folder that is removed when the program ends, however it ends.
 *
 * In:    nothing.   Out: an empty folder.
 * Knows: processes, $TMPDIR.   Does not know: what is put there.
 *
 * A small child process creates the folder, waits for this process to end (even by a crash or by Ctrl-C
 * pressed twice), and removes the folder with its files. Create it before anything uses OpenCL, whose threads
 * do not survive a fork. */
#ifndef BP_CLI_PROCESS_TEMPORARY_FOLDER_H
#define BP_CLI_PROCESS_TEMPORARY_FOLDER_H

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
