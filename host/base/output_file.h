/* output_file.h: a file that appears whole or not at all.
 *
 * In:    a path.   Out: a stream; on commit, the file at that path.
 * Knows: temporary names, rename, permissions, symbolic links.   Does not know: what is written.
 *
 * Opens TARGET.XXXXXX beside the target; commit flushes, syncs and renames it over the target; discard
 * removes it. Symbolic links are followed (also one whose target does not exist yet), permissions of a
 * replaced file are kept, a new file gets those of the umask. A write-protected file is refused, although a
 * rename could replace it. A target that is no regular file (/dev/null, a pipe) is written directly. */
#ifndef BP_BASE_OUTPUT_FILE_H
#define BP_BASE_OUTPUT_FILE_H

#include "status.h"

#include <stdio.h>

/* Zeroed when not open. */
typedef struct BpOutputFile {
    FILE *stream;    /* to be written by the caller */
    char *temporary; /* its path; NULL when written directly */
    char *target;    /* what `path` means once links are followed */
} BpOutputFile;

/* On failure `file` is zeroed. BP_ERR_FILE or BP_ERR_MEMORY. */
BpStatus bp_output_open(const char *path, BpOutputFile *file, BpError *err);

/* Closes in any case; on failure nothing is left behind and an earlier file at the target is untouched. */
BpStatus bp_output_commit(BpOutputFile *file, BpError *err);

/* Removes what was written. Accepts a zeroed or committed file. */
void bp_output_discard(BpOutputFile *file);

/* Whether `path` could be written, found out without leaving anything behind: for use before a long render.
 */
BpStatus bp_output_check(const char *path, BpError *err);

/* "cannot ACTION PATH: reason; remedy", BP_ERR_FILE; `error_number` is an errno. */
BpStatus bp_output_fail(BpError *err, const char *action, const char *path, int error_number);

#endif
