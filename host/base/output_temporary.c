/* output_temporary.c: see output_temporary.h. */
#define _GNU_SOURCE /* O_TMPFILE */
#include "output_temporary.h"

#include "output_target.h"
#include "random.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define BASE_NAME_KEPT_MAX 200 /* so that a long name and its suffix still fit a file system's 255 bytes */
#define SUFFIX_SIZE 8          /* ".XXXXXX" and its end */
#define ATTEMPTS 100

/* ---- the names in use ------------------------------------------------------------------------------------
 *
 * Global, since a signal can arrive at any time, and the thread that then ends the program needs the names to
 * remove. */

static pthread_mutex_t names_lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_once_t forks_heeded = PTHREAD_ONCE_INIT;
static char *names[16]; /* never more at once; any more would stay behind after a signal */

static void lock_names(void) {
    pthread_mutex_lock(&names_lock);
}

static void unlock_names(void) {
    pthread_mutex_unlock(&names_lock);
}

/* A process that is forked while another thread holds the lock would wait for it for ever. */
static void hold_names_over_forks(void) {
    pthread_atfork(lock_names, unlock_names, unlock_names);
}

static void note_name(char *name) {
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (names[i] != NULL) continue;
        names[i] = name;
        return;
    }
}

static void forget_name(const char *name) {
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (names[i] == name) names[i] = NULL;
}

void bp_temporary_abandon(void) {
    lock_names(); /* for good */
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (names[i] != NULL) unlink(names[i]);
}

void bp_temporary_remove(char **name) {
    if (*name == NULL) return;
    lock_names();
    unlink(*name);
    forget_name(*name);
    unlock_names();
    free(*name);
    *name = NULL;
}

char *bp_temporary_keep(char **name) {
    char *kept = *name;
    lock_names();
    forget_name(kept);
    unlock_names();
    *name = NULL;
    return kept;
}

/* ---- making them -------------------------------------------------------------------------------------- */

/* FOLDER/NAME with room for a suffix, NAME being that of `target`; heap, NULL when out of memory. */
static char *stem_in(const char *folder, size_t folder_length, const char *target, size_t *length) {
    const char *base = target + bp_folder_length(target);
    size_t kept = strlen(base);
    if (kept > BASE_NAME_KEPT_MAX) kept = BASE_NAME_KEPT_MAX;
    const size_t slash = folder_length > 0 && folder[folder_length - 1] != '/' ? 1 : 0;
    *length = folder_length + slash + kept;
    char *path = malloc(*length + SUFFIX_SIZE);
    if (path == NULL) return NULL;
    snprintf(path, *length + 1, "%.*s%s%.*s", (int)folder_length, folder, slash == 1 ? "/" : "", (int)kept,
             base);
    return path;
}

/* Writes another ".XXXXXX" to `suffix`. */
static void make_suffix(char *suffix, BpRandom *random) {
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz0123456789";
    *suffix++ = '.';
    for (int i = 0; i < 6; i++) {
        *suffix++ = letters[bp_random_bits(random) % (sizeof letters - 1)];
    }
    *suffix = '\0';
}

static uint64_t first_state(void) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return (uint64_t)now.tv_nsec ^ ((uint64_t)now.tv_sec << 30) ^ ((uint64_t)getpid() << 40);
}

/* Gives the file of `descriptor`, which has no name, the name `path`; 0 or an errno. */
static int link_descriptor(int descriptor, const char *path) {
    char own[64];
    snprintf(own, sizeof own, "/proc/self/fd/%d", descriptor);
    return linkat(AT_FDCWD, own, AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0 ? 0 : errno;
}

/* Creates a file STEM.XXXXXX; if `descriptor` is a file without a name, gives it that name instead. Returns
 * the descriptor, or -1 and errno. mkstemp() would set mode 0600; this way the system itself applies umask
 * and default access lists. The name is recorded before the lock is released, so that cleaning up after a
 * signal removes it. */
static int make_name(const char *folder, size_t folder_length, const char *target, mode_t mode,
                     int descriptor, char **name) {
    size_t length = 0;
    char *path = stem_in(folder, folder_length, target, &length);
    int made = -1, problem = path == NULL ? ENOMEM : EEXIST;
    BpRandom random = {first_state()};
    pthread_once(&forks_heeded, hold_names_over_forks);
    lock_names();
    for (int attempt = 0; attempt < ATTEMPTS && problem == EEXIST; attempt++) {
        make_suffix(path + length, &random);
        if (descriptor >= 0) {
            problem = link_descriptor(descriptor, path);
            made = problem == 0 ? descriptor : -1;
        } else {
            made = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
            problem = made >= 0 ? 0 : errno;
        }
    }
    if (made >= 0) note_name(path);
    unlock_names();
    if (made < 0) {
        free(path);
        errno = problem;
        return -1;
    }
    *name = path;
    return made;
}

/* A file without a name in the folder of `target`; -1 if that is unsupported, or could not be named later. */
static int create_unnamed(const char *target, mode_t mode) {
    int descriptor = -1;
#ifdef O_TMPFILE
    char own[64];
    char *folder = bp_folder_of(target);
    if (folder != NULL) descriptor = open(folder, O_RDWR | O_TMPFILE | O_CLOEXEC, mode);
    free(folder);
    if (descriptor < 0) return -1;
    snprintf(own, sizeof own, "/proc/self/fd/%d", descriptor);
    if (access(own, F_OK) == 0) return descriptor;
    close(descriptor); /* no /proc here */
    descriptor = -1;
#else
    (void)target;
    (void)mode;
#endif
    return descriptor;
}

int bp_temporary_create(const char *target, mode_t mode, bool *unnamed, char **name) {
    const int descriptor = create_unnamed(target, mode);
    *unnamed = descriptor >= 0;
    if (*unnamed) return descriptor;
    return make_name(target, bp_folder_length(target), target, mode, -1, name);
}

int bp_temporary_create_in(const char *folder, const char *target, mode_t mode, char **name) {
    return make_name(folder, strlen(folder), target, mode, -1, name);
}

int bp_temporary_create_elsewhere(const char *target, mode_t mode, char **name) {
    const char *folder = getenv("TMPDIR");
    if (folder == NULL || folder[0] == '\0') folder = "/tmp";
    return bp_temporary_create_in(folder, target, mode, name);
}

/* ---- putting them in place ---------------------------------------------------------------------------- */

static int copy_bytes(int from, int to) {
    char block[1 << 16];
    off_t done = 0;
    for (;;) {
        ssize_t got = pread(from, block, sizeof block, done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return errno;
        if (got == 0) break;
        for (ssize_t put = 0; put < got;) {
            const ssize_t written = pwrite(to, block + put, (size_t)(got - put), done + put);
            if (written < 0 && errno != EINTR) return errno;
            if (written > 0) put += written;
        }
        done += got;
    }
    if (ftruncate(to, done) != 0) return errno;
    return fsync(to) == 0 || errno == EINVAL ? 0 : errno;
}

/* Copies to `to`, which is closed in any case. */
static int copy_and_close(int from, int to) {
    int problem = copy_bytes(from, to);
    if (close(to) != 0 && problem == 0) problem = errno;
    return problem;
}

int bp_temporary_copy(int descriptor, const char *target) {
    const int to = open(target, O_WRONLY | O_CLOEXEC | O_NOCTTY);
    return to < 0 ? errno : copy_and_close(descriptor, to);
}

/* The permissions of the copy are those of the file without a name. */
static int copy_to_name(int from, int to, char **name) {
    struct stat own;
    if (to < 0) return errno;
    if (fstat(from, &own) == 0) (void)!fchmod(to, own.st_mode & 0777);
    const int problem = copy_and_close(from, to);
    if (problem != 0) bp_temporary_remove(name);
    return problem;
}

int bp_temporary_name_elsewhere(int descriptor, const char *target, char **name) {
    return copy_to_name(descriptor, bp_temporary_create_elsewhere(target, 0600, name), name);
}

/* Gives a file without a name one beside `target`: by a link, or by a copy where links are refused. */
static int name_beside(bool *unnamed, char **name, int descriptor, const char *target) {
    const size_t folder = bp_folder_length(target);
    int problem = 0;
    if (make_name(target, folder, target, 0, descriptor, name) < 0)
        problem = copy_to_name(descriptor, make_name(target, folder, target, 0600, -1, name), name);
    *unnamed = problem != 0;
    return problem;
}

/* Claims `target`, which must not be there, for the temporary `name`: 0, or an errno. By a link; where the
 * file system has none, by creating an empty file there, which the rename that follows replaces. */
static int claim(const char *name, const char *target) {
    if (link(name, target) == 0) return 0;
    if (errno == EEXIST) return EEXIST;
    const int made = open(target, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (made < 0) return errno;
    close(made);
    return 0;
}

int bp_temporary_place(bool *unnamed, char **name, int descriptor, const char *target, bool replace) {
    struct stat info;
    if (*unnamed && lstat(target, &info) != 0 && link_descriptor(descriptor, target) == 0) {
        *unnamed = false;
        return 0;
    }
    if (*unnamed) {
        const int problem = name_beside(unnamed, name, descriptor, target);
        if (problem != 0) return problem;
    }
    /* Once the file has a name it is finished, so a signal waits until it is in place. */
    lock_names();
    int problem = replace ? 0 : claim(*name, target);
    if (problem == 0 && rename(*name, target) != 0) problem = errno;
    if (problem == 0) {
        unlink(*name); /* a rename of two links to one file does nothing */
        forget_name(*name);
    }
    unlock_names();
    if (problem != 0) return problem;
    free(*name);
    *name = NULL;
    return 0;
}
