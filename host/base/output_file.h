/* output_file.h: a file that appears whole or not at all.
 *
 * Knows: temporary names, rename, permissions.   Does not know: what is written.
 *
 * Opens TARGET.XXXXXX beside the target; commit flushes, syncs and renames it over the target; discard
 * removes it. Symbolic links are followed, permissions of a replaced file are kept. A target that is no
 * regular file (/dev/null, a pipe) is written directly. */
#ifndef BP_BASE_OUTPUT_FILE_H
#define BP_BASE_OUTPUT_FILE_H

#include "status.h"

#include <stdio.h>

typedef struct BpOutputFile {
    FILE *stream;       /* to be written by the caller */
    char *temporary;    /* its path; NULL when written directly */
    char *target;
} BpOutputFile;

BpStatus bp_output_open(const char *path, BpOutputFile *file, BpError *err);
BpStatus bp_output_commit(BpOutputFile *file, BpError *err);
void bp_output_discard(BpOutputFile *file);
/* Whether `path` could be written, found out without leaving anything behind: for use before a long render. */
BpStatus bp_output_check(const char *path, BpError *err);

#endif
