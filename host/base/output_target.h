/* output_target.h: resolves the path of an output file.
 *
 * In:    a path that need not exist.   Out: the file, the open descriptor or the place that it refers to.
 * Knows: symbolic links, /dev/stdout, /dev/fd, inodes.   Does not know: how anything is written.
 *
 * Paths are compared by the file they refer to, never by their spelling: "a.png", "./a.png", a symbolic link
 * and a hard link are one file. A file that does not exist yet is identified by the inode of its folder and
 * its name in it. */
#ifndef BP_BASE_OUTPUT_TARGET_H
#define BP_BASE_OUTPUT_TARGET_H

#include "status.h"

#include <sys/stat.h>

typedef struct BpOutputTarget {
    char *path;     /* with the links of its last part followed; heap */
    int descriptor; /* which of this process's open files it is (/dev/stdout, /dev/fd/3); -1: none */
    bool through;   /* a link that only the system can follow (/proc/PID/fd/1): written through */
    bool exists;
    struct stat info; /* of what is there, if it exists */
} BpOutputTarget;

/* Follows `path`. BP_ERR_FILE with the reason, BP_ERR_MEMORY. The caller clears; on failure it is clear. */
BpStatus bp_output_target_find(const char *path, BpOutputTarget *target, BpError *err);
void bp_output_target_clear(BpOutputTarget *target);

/* Whether the file is replaced as a whole; anything else (a device, a pipe, an open descriptor) is written
 * through. */
bool bp_output_target_is_replaced(const BpOutputTarget *target);

/* Length of the folder part of `path`, its slash included; 0 when there is none. */
size_t bp_folder_length(const char *path);
/* That folder, "." when there is none; heap, NULL when out of memory. */
char *bp_folder_of(const char *path);

/* Whether writing to `a` would overwrite `b`: both lead to one regular file, to one place where no file is
 * yet, or to one descriptor. Devices and pipes may be named twice. "-" is standard output as `a`, and as `b`
 * the descriptor `b_stream`. A path that cannot be resolved equals no other. */
bool bp_output_same(const char *a, const char *b, int b_stream);

/* Appends a remedy for that errno, such as "; make room", to an error whose message ends with its reason. */
void bp_output_advise(BpError *err, int error_number);
/* "cannot ACTION PATH: reason; remedy", BP_ERR_FILE; `error_number` is an errno. */
BpStatus bp_output_fail(BpError *err, const char *action, const char *path, int error_number);

#endif
