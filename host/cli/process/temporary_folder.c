/* temporary_folder.c: see temporary_folder.h. */
#include "temporary_folder.h"

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
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

/* The keeper's answer: the folder, or the reason why there is none. */
typedef struct Answer {
    int failed; /* errno, 0: made */
    char path[sizeof((BpTemporaryFolder *)0)->path];
} Answer;

/* Creates the folder, reports its path, waits until the other end of the socket closes for any reason, and
 * cleans up. The keeper creates the folder, not its parent: a parent that is killed in between leaves nothing
 * behind. */
static _Noreturn void keep(Answer *answer, int other) {
    char nothing;
    /* Ctrl-C reaches every process of the terminal; this one has to outlive it. */
    signal(SIGINT, SIG_IGN);
    signal(SIGTERM, SIG_IGN);
    signal(SIGHUP, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
    close(STDIN_FILENO);
    close(STDOUT_FILENO);
    close(STDERR_FILENO);
    answer->failed = mkdtemp(answer->path) == NULL ? errno : 0;
    if (write(other, answer, sizeof *answer) == (ssize_t)sizeof *answer)
        while (read(other, &nothing, 1) < 0 && errno == EINTR) {
        }
    if (answer->failed == 0) remove_files(answer->path);
    _exit(0);
}

/* Starts the keeper and waits for its answer. False: there is none, see errno. */
static bool start_keeper(BpTemporaryFolder *folder, Answer *answer) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return false;
    fflush(NULL);
    folder->keeper = fork();
    if (folder->keeper == 0) {
        close(ends[0]);
        keep(answer, ends[1]);
    }
    const int failed = errno;
    close(ends[1]);
    folder->alive = ends[0];
    if (folder->keeper > 0) {
        ssize_t got;
        while ((got = recv(ends[0], answer, sizeof *answer, MSG_WAITALL)) < 0 && errno == EINTR) {
        }
        if (got == (ssize_t)sizeof *answer) return true;
        errno = ECHILD;
    } else {
        errno = failed;
    }
    close(ends[0]);
    return false;
}

static void end_keeper(BpTemporaryFolder *folder) {
    close(folder->alive);
    while (waitpid(folder->keeper, NULL, 0) < 0 && errno == EINTR) {
    }
}

BpStatus bp_temporary_folder_make(BpTemporaryFolder *folder, BpError *err) {
    const char *above = getenv("TMPDIR");
    Answer answer = {0};
    const int length = snprintf(answer.path, sizeof answer.path, "%s/ballpark-XXXXXX",
                                above != NULL && above[0] != '\0' ? above : "/tmp");
    folder->path[0] = '\0';
    if (length < 0 || (size_t)length >= sizeof answer.path)
        return bp_fail(err, BP_ERR_FILE, "the path in TMPDIR is too long");
    if (!start_keeper(folder, &answer))
        return bp_fail(err, BP_ERR_MEMORY, "cannot start a process: %s", strerror(errno));
    if (answer.failed != 0) {
        end_keeper(folder);
        return bp_fail(err, BP_ERR_FILE, "cannot create the folder %s: %s; set TMPDIR to a writable folder",
                       answer.path, strerror(answer.failed));
    }
    memcpy(folder->path, answer.path, sizeof folder->path);
    return BP_OK;
}

void bp_temporary_folder_remove(BpTemporaryFolder *folder) {
    if (folder->path[0] == '\0') return;
    end_keeper(folder);
    folder->path[0] = '\0';
}
