/* output_file.c: see output_file.h. */
#define _GNU_SOURCE /* O_TMPFILE */
#include "output_file.h"

#include "output_temporary.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Gives the new file the owner, the group and the permissions of the file that it replaces, as far as it may
 * have them. */
static int copy_permissions(int descriptor, const struct stat *replaced) {
    struct stat own;
    mode_t mode = replaced->st_mode & 0777;
    /* Only root can keep another owner; the group can be one of the user's own. It is not a failure if either
     * cannot be kept. */
    if (fchown(descriptor, replaced->st_uid, replaced->st_gid) != 0)
        (void)!fchown(descriptor, (uid_t)-1, replaced->st_gid);
    if (fstat(descriptor, &own) != 0) return -1;
    if (own.st_gid != replaced->st_gid) mode = (mode & ~(mode_t)070) | (mode & 070 & (mode & 07) << 3);
    return fchmod(descriptor, mode);
}

/* Opens a target that is written through. Returns the descriptor, or -1 and errno. It appends, so what
 * another process has written to the file stays there. */
static int open_direct(const BpOutputTarget *target) {
    if (target->descriptor >= 0) return fcntl(target->descriptor, F_DUPFD_CLOEXEC, 3);
    return open(target->path, O_WRONLY | O_CLOEXEC | O_NOCTTY | (target->through ? O_APPEND : 0));
}

/* Whether the bytes can be copied into the target, if no file can be created beside it. */
static bool can_copy_into(const BpOutputTarget *target) {
    const int descriptor = target->exists ? open(target->path, O_WRONLY | O_CLOEXEC | O_NOCTTY) : -1;
    if (descriptor >= 0) close(descriptor);
    return descriptor >= 0;
}

static BpStatus open_file(const char *path, bool new_only, BpOutputFile *file, BpError *err) {
    memset(file, 0, sizeof *file);
    BpStatus status = bp_output_target_find(path, &file->target, err);
    if (status != BP_OK) return status;
    int descriptor, of_stream = -1, problem = 0;
    const bool exists = file->target.exists && !new_only;
    file->direct = !bp_output_target_is_replaced(&file->target);
    file->new_only = new_only;
    if (file->direct) {
        descriptor = open_direct(&file->target);
    } else {
        const mode_t mode = exists ? 0600 : 0666; /* until it gets the permissions of the replaced file */
        descriptor = bp_temporary_create(file->target.path, mode, &file->unnamed, &file->temporary);
        problem = errno;
        if (descriptor < 0 && exists && can_copy_into(&file->target)) {
            descriptor = bp_temporary_create_elsewhere(file->target.path, mode, &file->temporary);
            file->unnamed = false;
        }
        if (descriptor < 0) errno = problem;
    }
    if (descriptor < 0) goto fail;
    if (!file->direct && exists && copy_permissions(descriptor, &file->target.info) != 0) goto fail;
    /* The stream has a descriptor of its own. Some file systems report a failure only when a file is closed,
     * and after that the other descriptor can still be linked and copied. */
    of_stream = fcntl(descriptor, F_DUPFD_CLOEXEC, 3);
    if (of_stream < 0) goto fail;
    file->stream = fdopen(of_stream, "wb");
    if (file->stream == NULL) goto fail;
    file->descriptor = descriptor;
    return BP_OK;
fail:
    status = bp_output_fail(err, "write", path, errno);
    if (of_stream >= 0) close(of_stream);
    if (descriptor >= 0) close(descriptor);
    bp_output_discard(file);
    return status;
}

BpStatus bp_output_open(const char *path, BpOutputFile *file, BpError *err) {
    return open_file(path, false, file, err);
}

BpStatus bp_output_open_new(const char *path, BpOutputFile *file, BpError *err) {
    return open_file(path, true, file, err);
}

/* Makes the new name itself survive a power cut. Not every file system can, so failures are ignored. */
static void sync_folder(const char *target) {
    char *folder = bp_folder_of(target);
    const int descriptor = folder != NULL ? open(folder, O_RDONLY | O_CLOEXEC) : -1;
    if (descriptor >= 0) {
        fsync(descriptor);
        close(descriptor);
    }
    free(folder);
}

/* Puts the finished temporary, open as `descriptor`, in place; 0, or the errno of the first failure. *left:
 * its name, if it now lies beside the target. */
static int put_in_place(BpOutputFile *file, int descriptor, char **left) {
    const char *target = file->target.path;
    int problem = bp_temporary_place(&file->unnamed, &file->temporary, descriptor, target, !file->new_only);
    if (problem == 0) {
        sync_folder(target);
        return 0;
    }
    /* From here on the file is finished but cannot replace the target: it must not be lost. */
    if (file->unnamed && bp_temporary_name_elsewhere(descriptor, target, &file->temporary) == 0)
        file->unnamed = false;
    *left = bp_temporary_keep(&file->temporary);
    struct stat now;
    if (file->new_only) return problem;
    if (stat(target, &now) != 0 || !S_ISREG(now.st_mode)) return problem;
    const int copied = bp_temporary_copy(descriptor, target);
    if (copied != 0) return copied;
    if (*left != NULL) unlink(*left);
    free(*left);
    *left = NULL;
    return 0;
}

BpStatus bp_output_commit(BpOutputFile *file, BpError *err) {
    BpStatus status = BP_OK;
    int problem = 0;
    char *left = NULL;
    /* A failed write that the caller did not notice leaves its mark on the stream, but no errno. */
    if (ferror(file->stream)) problem = EIO;
    const int descriptor = file->descriptor;
    if (fflush(file->stream) != 0) problem = errno;
    if (problem == 0 && !file->direct && fsync(descriptor) != 0 && errno != EINVAL) problem = errno;
    if (fclose(file->stream) != 0 && problem == 0) problem = errno;
    file->stream = NULL;
    if (problem == 0 && !file->direct) problem = put_in_place(file, descriptor, &left);
    close(descriptor);
    if (problem != 0) status = bp_output_fail(err, "write", file->target.path, problem);
    if (left != NULL) {
        const size_t used = err != NULL ? strlen(err->message) : 0;
        if (err != NULL)
            snprintf(err->message + used, sizeof err->message - used, "; " BP_OUTPUT_KEPT_AS "%s", left);
        free(left);
    }
    bp_output_discard(file);
    return status;
}

void bp_output_discard(BpOutputFile *file) {
    if (file->stream != NULL) {
        fclose(file->stream);
        close(file->descriptor);
    }
    bp_temporary_remove(&file->temporary);
    bp_output_target_clear(&file->target);
    memset(file, 0, sizeof *file);
}

BpStatus bp_output_write(const char *path, bool new_only, BpPrint *print, const void *what, BpError *err) {
    BpOutputFile file;
    BpError fault = {0};
    BP_TRY(new_only ? bp_output_open_new(path, &file, err) : bp_output_open(path, &file, err));
    const BpStatus status = print(what, file.stream, &fault);
    if (status == BP_OK) return bp_output_commit(&file, err);
    bp_output_discard(&file);
    if (status == BP_ERR_FILE) {
        bp_fail(err, status, "cannot write %s: %s", path, fault.message);
        bp_error_at(err, path, 0, 0);
    } else {
        bp_fail(err, status, "%s", fault.message);
    }
    bp_error_set_remedy(err, fault.remedy, fault.remedy_value);
    bp_error_clear(&fault);
    return status;
}

static BpStatus check(const char *path, bool new_only, BpError *err) {
    BpOutputTarget target;
    BP_TRY(bp_output_target_find(path, &target, err));
    const bool replaced = bp_output_target_is_replaced(&target), exists = target.exists;
    bp_output_target_clear(&target);
    if (replaced && exists && new_only) return bp_output_fail(err, "write", path, EEXIST);
    if (!replaced) return BP_OK; /* a pipe is not opened: that would wait for its reader */
    BpOutputFile file;
    BP_TRY(open_file(path, new_only, &file, err));
    bp_output_discard(&file);
    return BP_OK;
}

BpStatus bp_output_check(const char *path, BpError *err) {
    return check(path, false, err);
}

BpStatus bp_output_check_new(const char *path, BpError *err) {
    return check(path, true, err);
}

bool bp_output_replaces(const char *path) {
    BpOutputTarget target;
    if (bp_output_target_find(path, &target, NULL) != BP_OK) return false;
    const bool replaces = target.exists && bp_output_target_is_replaced(&target);
    bp_output_target_clear(&target);
    return replaces;
}

void bp_output_abandon(void) {
    bp_temporary_abandon();
}

BpStatus bp_output_finish(FILE *out, const char *what, BpError *err) {
    /* A write can fail when a full buffer goes out in the middle of the file; a flush of the empty buffer
     * would then succeed. */
    const bool failed_before = ferror(out) != 0;
    const int error_before = errno;
    if (fflush(out) == 0 && !failed_before) return BP_OK;
    const int error_number = failed_before ? error_before : errno;
    bp_fail(err, BP_ERR_FILE, "writing the %s failed: %s", what, strerror(error_number));
    bp_output_advise(err, error_number);
    return BP_ERR_FILE;
}
