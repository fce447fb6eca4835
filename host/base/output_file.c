/* output_file.c: see output_file.h. */
#include "output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define LINKS_MAX 40           /* as the kernel's own limit on chains of symbolic links */
#define BASE_NAME_KEPT_MAX 200 /* so that a long name and its suffix still fit a file system's 255 bytes */

static const char *remedy(int error_number) {
    switch (error_number) {
    case ENOENT:
        return "; create the folder first, or choose another with -o";
    case ENOTDIR:
        return "; a part of the path is a file where a folder should be";
    case EACCES:
    case EPERM:
        return "; change the permissions, or choose another place with -o";
    case EROFS:
        return "; choose a place that can be written with -o";
    case ENOSPC:
    case EDQUOT:
        return "; make room, or choose another place with -o";
    case EISDIR:
        return "; name a file in it";
    case ENAMETOOLONG:
        return "; choose a shorter name";
    default:
        return "";
    }
}

BpStatus bp_output_fail(BpError *err, const char *action, const char *path, int error_number) {
    char reason[128];
    if (strerror_r(error_number, reason, sizeof reason) != 0)
        snprintf(reason, sizeof reason, "error %d", error_number);
    bp_fail(err, BP_ERR_FILE, "cannot %s %s: %s%s", action, path, reason, remedy(error_number));
    bp_error_at(err, path, 0, 0);
    return BP_ERR_FILE;
}

/* Length of the folder part of `path`, its slash included; 0 when there is none. */
static size_t folder_length(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash == NULL ? 0 : (size_t)(slash - path) + 1;
}

/* The path that `path` stands for when the symbolic links in its last part are followed; NULL and errno on
 * failure. realpath() would not do: it needs the target to exist. */
static char *follow_links(const char *path) {
    char *current = strdup(path);
    for (int links = 0; current != NULL; links++) {
        struct stat info;
        if (lstat(current, &info) != 0 || !S_ISLNK(info.st_mode)) return current;
        char text[4096];
        const ssize_t length = readlink(current, text, sizeof text - 1);
        if (length < 0 || links == LINKS_MAX) {
            const int error_number = length < 0 ? errno : ELOOP;
            free(current);
            errno = error_number;
            return NULL;
        }
        text[length] = '\0';
        const size_t folder = text[0] == '/' ? 0 : folder_length(current);
        char *next = malloc(folder + (size_t)length + 1);
        if (next != NULL) {
            memcpy(next, current, folder);
            memcpy(next + folder, text, (size_t)length + 1);
        }
        free(current);
        current = next;
    }
    errno = ENOMEM;
    return NULL;
}

/* Creates TARGET.XXXXXX; its path goes to *temporary. Not mkstemp(), which would set mode 0600: this way the
 * system itself applies umask and default access lists. Returns the descriptor, or -1 and errno. */
static int create_beside(const char *target, char **temporary) {
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz0123456789";
    const size_t folder = folder_length(target);
    size_t kept = strlen(target + folder);
    if (kept > BASE_NAME_KEPT_MAX) kept = BASE_NAME_KEPT_MAX;
    char *path = malloc(folder + kept + 8);
    if (path == NULL) {
        errno = ENOMEM;
        return -1;
    }
    memcpy(path, target, folder + kept);
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    uint64_t state = (uint64_t)now.tv_nsec ^ ((uint64_t)now.tv_sec << 30) ^ ((uint64_t)getpid() << 40);
    int descriptor = -1;
    for (int attempt = 0; attempt < 100; attempt++) {
        char *suffix = path + folder + kept;
        *suffix++ = '.';
        for (int i = 0; i < 6; i++) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            *suffix++ = letters[(state >> 33) % (sizeof letters - 1)];
        }
        *suffix = '\0';
        descriptor = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0 || errno != EEXIST) break;
    }
    if (descriptor < 0) {
        const int error_number = errno;
        free(path);
        errno = error_number;
        return -1;
    }
    *temporary = path;
    return descriptor;
}

/* Gives the new file the owner and the permissions of the one it replaces. A different owner can only be kept
 * by root, so a failure of that is none. */
static int copy_permissions(int descriptor, const struct stat *replaced) {
    if (fchown(descriptor, replaced->st_uid, replaced->st_gid) != 0 && errno != EPERM && errno != EINVAL)
        return -1;
    return fchmod(descriptor, replaced->st_mode & 07777);
}

/* What can be told of `path` without opening anything: the target once links are followed, and whether
 * there is a file already. */
static BpStatus find_target(const char *path, char **target, struct stat *info, bool *exists, BpError *err) {
    if (path[0] == '\0') return bp_fail(err, BP_ERR_FILE, "the name of the output file is empty");
    *target = follow_links(path);
    if (*target == NULL && errno == ENOMEM) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    if (*target == NULL) return bp_output_fail(err, "write", path, errno);
    *exists = stat(*target, info) == 0;
    int problem = 0;
    if (!*exists && errno != ENOENT)
        problem = errno;
    else if (*exists && S_ISDIR(info->st_mode))
        problem = EISDIR;
    else if (*exists && access(*target, W_OK) != 0)
        problem = errno;
    else if (!*exists && (*target)[folder_length(*target)] == '\0')
        problem = EISDIR; /* "folder/" */
    if (problem == 0) return BP_OK;
    free(*target);
    *target = NULL;
    return bp_output_fail(err, "write", path, problem);
}

BpStatus bp_output_open(const char *path, BpOutputFile *file, BpError *err) {
    memset(file, 0, sizeof *file);
    struct stat info;
    bool exists = false;
    int descriptor = -1;
    BpStatus status = find_target(path, &file->target, &info, &exists, err);
    if (status != BP_OK) return status;
    const bool direct = exists && !S_ISREG(info.st_mode);
    if (direct)
        descriptor = open(file->target, O_WRONLY | O_CLOEXEC | O_NOCTTY);
    else
        descriptor = create_beside(file->target, &file->temporary);
    if (descriptor < 0) goto fail;
    if (!direct && exists && copy_permissions(descriptor, &info) != 0) goto fail;
    file->stream = fdopen(descriptor, "wb");
    if (file->stream == NULL) goto fail;
    return BP_OK;
fail:
    status = bp_output_fail(err, "write", path, errno);
    if (descriptor >= 0) close(descriptor);
    bp_output_discard(file);
    return status;
}

/* Makes the rename itself last through a power cut. Not every file system can, so nothing is said if not. */
static void sync_folder(const char *target) {
    const size_t length = folder_length(target);
    char *folder = length == 0 ? strdup(".") : strndup(target, length);
    if (folder == NULL) return;
    const int descriptor = open(folder, O_RDONLY | O_CLOEXEC);
    if (descriptor >= 0) {
        fsync(descriptor);
        close(descriptor);
    }
    free(folder);
}

BpStatus bp_output_commit(BpOutputFile *file, BpError *err) {
    BpStatus status = BP_OK;
    int problem = 0;
    /* A failed write that the caller did not notice leaves its mark on the stream, but no errno. */
    if (ferror(file->stream)) problem = EIO;
    if (fflush(file->stream) != 0) problem = errno;
    if (problem == 0 && file->temporary != NULL && fsync(fileno(file->stream)) != 0 && errno != EINVAL)
        problem = errno;
    if (fclose(file->stream) != 0 && problem == 0) problem = errno;
    file->stream = NULL;
    if (problem == 0 && file->temporary != NULL) {
        if (rename(file->temporary, file->target) == 0) {
            free(file->temporary);
            file->temporary = NULL;
            sync_folder(file->target);
        } else {
            problem = errno;
        }
    }
    if (problem != 0) status = bp_output_fail(err, "write", file->target, problem);
    bp_output_discard(file);
    return status;
}

void bp_output_discard(BpOutputFile *file) {
    if (file->stream != NULL) fclose(file->stream);
    if (file->temporary != NULL) unlink(file->temporary);
    free(file->temporary);
    free(file->target);
    memset(file, 0, sizeof *file);
}

BpStatus bp_output_check(const char *path, BpError *err) {
    char *target = NULL;
    struct stat info;
    bool exists = false;
    BP_TRY(find_target(path, &target, &info, &exists, err));
    free(target);
    /* A pipe is not opened: that would wait for its reader. */
    if (exists && !S_ISREG(info.st_mode)) return BP_OK;
    BpOutputFile file;
    BP_TRY(bp_output_open(path, &file, err));
    bp_output_discard(&file);
    return BP_OK;
}
