/* output_file.h: a file that appears whole or not at all, and that is never lost once it is finished.
 *
 * In:    a path.   Out: a stream; on commit, the file at that path.
 * Knows: temporary files, rename, permissions.   Does not know: what is written.
 *
 * How a file is written. The content goes to a temporary file, which commit syncs and puts in the target's
 * place. Where the system supports it, the temporary has no name until it is finished, so that nothing is
 * left when the program is killed; elsewhere it is TARGET.XXXXXX beside the target. An existing target is
 * replaced by a rename, for which the finished file is called TARGET.XXXXXX for a moment.
 *
 * Later failures do not lose the file. If the target cannot be replaced (something is mounted on it, or its
 * folder does not allow renaming), the finished file is copied into it; if that fails too, it stays, and the
 * error names it. If no file can be created beside a writable target, the temporary is in $TMPDIR or /tmp and
 * is copied likewise.
 *
 * The new file inherits the owner and group of the old one, as far as the user may set them, and its
 * permissions, but never set-user-ID and set-group-ID, which were granted to the old content. If the group
 * cannot be kept, the new group gets the rights of others. A new file gets its permissions from the umask. A
 * write-protected file is refused, although a rename could replace it.
 *
 * A target that is not a regular file (a device, a pipe) is written through, and so is an open file of this
 * process (/dev/stdout, /dev/fd/3): from where its other writers left it, and nothing in it is replaced. */
#ifndef BP_BASE_OUTPUT_FILE_H
#define BP_BASE_OUTPUT_FILE_H

#include "output_target.h"

#include <stdio.h>

/* The words of a failed bp_output_commit() before the name of the finished file. */
#define BP_OUTPUT_KEPT_AS "the complete result is in "

/* Zeroed when not open. */
typedef struct BpOutputFile {
    FILE *stream;   /* to be written by the caller */
    int descriptor; /* of the same file, while `stream` is open */
    BpOutputTarget target;
    bool direct;     /* written through, without a temporary */
    bool unnamed;    /* the temporary has no name yet */
    bool new_only;   /* a file that is there by the time of the commit is not replaced */
    char *temporary; /* its name; NULL when it has none */
} BpOutputFile;

/* On failure `file` is zeroed. BP_ERR_FILE or BP_ERR_MEMORY. `file` must stay where it is until it is
 * committed or discarded. */
BpStatus bp_output_open(const char *path, BpOutputFile *file, BpError *err);
/* The same for a file that must not exist when it is committed. The commit claims the name in one step, so if
 * two programs write it, one fails, and its result stays in the file that its error names. Devices, pipes and
 * open files are written through, as always. */
BpStatus bp_output_open_new(const char *path, BpOutputFile *file, BpError *err);

/* Closes in any case. On failure an earlier file at the target is untouched, unless the error reports that
 * it was being copied into; an unfinished result is gone, a finished one stays in the file that the error
 * names. */
BpStatus bp_output_commit(BpOutputFile *file, BpError *err);

/* Removes what was written. Accepts a zeroed or committed file. */
void bp_output_discard(BpOutputFile *file);

/* Prints `what` to `out`, which need not be able to seek. BP_ERR_FILE with the system's reason. */
typedef BpStatus BpPrint(const void *what, FILE *out, BpError *err);
/* Opens `path`, with `new_only` by bp_output_open_new(), prints to it, and commits it, or discards it when
 * `print` fails. An error of BP_ERR_FILE names `path`. */
BpStatus bp_output_write(const char *path, bool new_only, BpPrint *print, const void *what, BpError *err);

/* Checks that `path` can be written, without leaving anything behind: for use before a long render. */
BpStatus bp_output_check(const char *path, BpError *err);
/* The same for bp_output_open_new(); an existing file is refused. */
BpStatus bp_output_check_new(const char *path, BpError *err);
/* Whether bp_output_open() would replace an existing file at `path`. */
bool bp_output_replaces(const char *path);

/* Flushes `out`; BP_ERR_FILE with the system's reason when this or an earlier write failed. */
BpStatus bp_output_finish(FILE *out, const char *what, BpError *err);

/* For ending the program on a signal, from any thread: waits for a commit in progress, removes unfinished
 * temporaries, and prevents other threads from writing further files. */
void bp_output_abandon(void);

#endif
