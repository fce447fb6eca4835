/* output_target.c: see output_target.h. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "output_target.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define LINKS_MAX 40 /* as the kernel's own limit on chains of symbolic links */

static const struct Advice {
    int error_number;
    const char *text; /* that applies to every interface */
    BpRemedy remedy;
} advice[] = {
    {ENOENT, "; create the folder first", BP_REMEDY_OR_OTHER_PLACE},
    {ENOTDIR, "; part of the path is a file, not a folder", BP_REMEDY_NONE},
    {EACCES, "; change the permissions", BP_REMEDY_OR_OTHER_PLACE},
    {EPERM, "; change the permissions", BP_REMEDY_OR_OTHER_PLACE},
    {EROFS, "", BP_REMEDY_WRITABLE_PLACE},
    {ENOSPC, "; make room", BP_REMEDY_OR_OTHER_PLACE},
    {EDQUOT, "; make room", BP_REMEDY_OR_OTHER_PLACE},
    {EFBIG, "; raise the limit on the size of files (ulimit -f)", BP_REMEDY_OR_OTHER_PLACE},
    {EISDIR, "; name a file in it", BP_REMEDY_NONE},
    {ENAMETOOLONG, "; choose a shorter name", BP_REMEDY_NONE},
    {EEXIST, "", BP_REMEDY_OTHER_NAME},
    {EBADF, "; no file is open for writing there", BP_REMEDY_NONE},
};

void bp_output_advise(BpError *err, int error_number) {
    for (size_t i = 0; i < sizeof advice / sizeof advice[0] && err != NULL; ++i) {
        if (advice[i].error_number != error_number) continue;
        const size_t used = strlen(err->message);
        snprintf(err->message + used, sizeof err->message - used, "%s", advice[i].text);
        bp_error_set_remedy(err, advice[i].remedy, "");
    }
}

BpStatus bp_output_fail(BpError *err, const char *action, const char *path, int error_number) {
    char reason[128];
    if (error_number == ENOMEM) return bp_fail(err, BP_ERR_MEMORY, "out of memory for writing %s", path);
    if (strerror_r(error_number, reason, sizeof reason) != 0)
        snprintf(reason, sizeof reason, "error %d", error_number);
    bp_fail(err, BP_ERR_FILE, "cannot %s %s: %s", action, path, reason);
    bp_output_advise(err, error_number);
    bp_error_at(err, path, 0, 0);
    return BP_ERR_FILE;
}

size_t bp_folder_length(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash == NULL ? 0 : (size_t)(slash - path) + 1;
}

char *bp_folder_of(const char *path) {
    const size_t length = bp_folder_length(path);
    return length == 0 ? strdup(".") : strndup(path, length);
}

/* Whether `folder`, free of links, is where the system shows this process's open files: /dev/fd, or
 * /proc/PID/fd, or /proc/PID/task/TID/fd. */
static bool holds_descriptors(const char *folder) {
    char own[64];
    const int length = snprintf(own, sizeof own, "/proc/%ld/", (long)getpid());
    const size_t end = strlen(folder);
    if (strcmp(folder, "/dev/fd") == 0) return true;
    return strncmp(folder, own, (size_t)length) == 0 && end > 3 && strcmp(folder + end - 3, "/fd") == 0;
}

/* The number of the open file that `path` names, when no link in its last part is left to be followed; -1: it
 * names none. *system: it is another of the links in /proc that only the system can follow. */
static int own_descriptor(const char *path, bool *system) {
    const char *name = path + bp_folder_length(path);
    int descriptor = -1;
    char *folder = bp_folder_of(path), *real = folder != NULL ? realpath(folder, NULL) : NULL;
    *system = real != NULL && strncmp(real, "/proc/", 6) == 0;
    if (real != NULL && holds_descriptors(real) && isdigit((unsigned char)name[0])) {
        char *end = NULL;
        errno = 0;
        const long number = strtol(name, &end, 10);
        if (*end == '\0' && errno == 0 && number <= 0x7fffffff) descriptor = (int)number;
    }
    free(real);
    free(folder);
    return descriptor;
}

/* The path that the link `path` with this text leads to; heap, NULL when out of memory. */
static char *join_link(const char *path, const char *text, size_t length) {
    const size_t folder = text[0] == '/' ? 0 : bp_folder_length(path);
    char *next = malloc(folder + length + 1);
    if (next == NULL) return NULL;
    memcpy(next, path, folder);
    memcpy(next + folder, text, length + 1);
    return next;
}

/* Follows the links in the last part of `path` into target->path and target->descriptor; 0, or an errno.
 * realpath() would not do: it needs the target to exist. Nor would the text of /dev/stdout's link: the name
 * that the system shows for an open file can be gone, or be another file by now. */
static int follow_links(const char *path, BpOutputTarget *target) {
    char *current = strdup(path);
    int problem = 0;
    for (int links = 0; current != NULL && problem == 0; links++) {
        struct stat info;
        bool system = false;
        char text[4096];
        target->descriptor = own_descriptor(current, &system);
        if (target->descriptor >= 0 || lstat(current, &info) != 0 || !S_ISLNK(info.st_mode)) break;
        target->through = system && info.st_size != 0 && strstr(current, "/fd/") != NULL;
        if (target->through) break;
        const ssize_t length = readlink(current, text, sizeof text - 1);
        if (length < 0 || links == LINKS_MAX) {
            problem = length < 0 ? errno : ELOOP;
            break;
        }
        text[length] = '\0';
        char *next = join_link(current, text, (size_t)length);
        free(current);
        current = next;
    }
    target->path = current;
    return current == NULL ? ENOMEM : problem;
}

/* Why the target cannot be written after its links have been followed, as an errno; 0: it can be. */
static int find_problem(BpOutputTarget *target) {
    if (target->descriptor >= 0) {
        const int flags = fcntl(target->descriptor, F_GETFL);
        if (flags < 0 || fstat(target->descriptor, &target->info) != 0) return errno;
        target->exists = true;
        return (flags & O_ACCMODE) == O_RDONLY ? EBADF : 0;
    }
    target->exists = stat(target->path, &target->info) == 0;
    if (!target->exists && errno != ENOENT) return errno;
    if (target->exists && S_ISDIR(target->info.st_mode)) return EISDIR;
    if (target->exists && access(target->path, W_OK) != 0) return errno;
    if (!target->exists && target->path[bp_folder_length(target->path)] == '\0')
        return EISDIR; /* "folder/" */
    return 0;
}

BpStatus bp_output_target_find(const char *path, BpOutputTarget *target, BpError *err) {
    memset(target, 0, sizeof *target);
    target->descriptor = -1;
    if (path[0] == '\0') return bp_fail(err, BP_ERR_FILE, "the name of the output file is empty");
    int problem = follow_links(path, target);
    if (problem == 0) problem = find_problem(target);
    if (problem == 0) return BP_OK;
    bp_output_target_clear(target);
    return bp_output_fail(err, "write", path, problem);
}

void bp_output_target_clear(BpOutputTarget *target) {
    free(target->path);
    memset(target, 0, sizeof *target);
    target->descriptor = -1;
}

bool bp_output_target_is_replaced(const BpOutputTarget *target) {
    return target->descriptor < 0 && !target->through && (!target->exists || S_ISREG(target->info.st_mode));
}

/* The identity of the file that a name refers to. */
typedef struct Identity {
    BpOutputTarget target;
    bool known;
    struct stat folder; /* of a file that is not there yet */
} Identity;

static void identify(const char *path, int stream, Identity *identity) {
    *identity = (Identity){.target = {.descriptor = -1}};
    BpOutputTarget *target = &identity->target;
    if (strcmp(path, "-") == 0) {
        target->descriptor = stream;
        target->exists = fstat(stream, &target->info) == 0;
        identity->known = target->exists;
        return;
    }
    if (path[0] == '\0' || follow_links(path, target) != 0) return;
    target->exists = target->descriptor >= 0 ? fstat(target->descriptor, &target->info) == 0
                                             : stat(target->path, &target->info) == 0;
    identity->known = target->exists;
    if (target->exists || target->descriptor >= 0) return;
    char *folder = bp_folder_of(target->path);
    identity->known = folder != NULL && stat(folder, &identity->folder) == 0;
    free(folder);
}

static bool same_inode(const struct stat *a, const struct stat *b) {
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

static bool same_identity(const Identity *a, const Identity *b) {
    const BpOutputTarget *first = &a->target, *second = &b->target;
    if (!a->known || !b->known || first->exists != second->exists) return false;
    if (first->descriptor >= 0 && first->descriptor == second->descriptor) return true;
    if (first->exists) return S_ISREG(first->info.st_mode) && same_inode(&first->info, &second->info);
    return same_inode(&a->folder, &b->folder) && strcmp(first->path + bp_folder_length(first->path),
                                                        second->path + bp_folder_length(second->path)) == 0;
}

bool bp_output_same(const char *a, const char *b, int b_stream) {
    Identity first, second;
    identify(a, STDOUT_FILENO, &first);
    identify(b, b_stream, &second);
    const bool same = same_identity(&first, &second);
    bp_output_target_clear(&first.target);
    bp_output_target_clear(&second.target);
    return same;
}
