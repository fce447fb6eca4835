/* temporary_folder.c: see temporary_folder.h. */
#include "temporary_folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static void remove_files(const char *path) {
    DIR *folder = opendir(path);
    if (folder == NULL) return;
    for (const struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder))
        unlinkat(dirfd(folder), entry->d_name, 0);
    closedir(folder);
    rmdir(path);
}

/* Waits for the other end to close, whoever closes it, then cleans up. */
static _Noreturn void keep(const char *path, int alive) {
    char nothing;
    /* Ctrl-C reaches every process of the terminal; this one has to outlive it. */
    signal(SIGINT, SIG_IGN);
    signal(SIGTERM, SIG_IGN);
    signal(SIGHUP, SIG_IGN);
    close(STDIN_FILENO);
    close(STDOUT_FILENO);
    close(STDERR_FILENO);
    while (read(alive, &nothing, 1) < 0 && errno == EINTR) {
    }
    remove_files(path);
    _exit(0);
}

BpStatus bp_temporary_folder_make(BpTemporaryFolder *folder, BpError *err) {
    const char *above = getenv("TMPDIR");
    int ends[2];
    const int length = snprintf(folder->path, sizeof folder->path, "%s/ballpark-XXXXXX",
                                above != NULL && above[0] != '\0' ? above : "/tmp");
    if (length < 0 || (size_t)length >= sizeof folder->path) {
        folder->path[0] = '\0';
        return bp_fail(err, BP_ERR_FILE, "the path in TMPDIR is too long");
    }
    if (mkdtemp(folder->path) == NULL) {
        const int failed = errno;
        bp_fail(err, BP_ERR_FILE, "cannot make the folder %s: %s; set TMPDIR to a folder that can be written",
                folder->path, strerror(failed));
        folder->path[0] = '\0';
        return BP_ERR_FILE;
    }
    if (pipe(ends) != 0) goto failed;
    fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    fflush(NULL);
    folder->keeper = fork();
    if (folder->keeper == 0) {
        close(ends[1]);
        keep(folder->path, ends[0]);
    }
    close(ends[0]);
    folder->alive = ends[1];
    if (folder->keeper > 0) return BP_OK;
    close(ends[1]);
failed:
    rmdir(folder->path);
    folder->path[0] = '\0';
    return bp_fail(err, BP_ERR_MEMORY, "cannot start a process: %s", strerror(errno));
}

void bp_temporary_folder_remove(BpTemporaryFolder *folder) {
    if (folder->path[0] == '\0') return;
    close(folder->alive);
    while (waitpid(folder->keeper, NULL, 0) < 0 && errno == EINTR) {
    }
    folder->path[0] = '\0';
}
