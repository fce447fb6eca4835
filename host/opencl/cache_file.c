/* cache_file.c: see cache_file.h. */
#include "cache_file.h"

#include "base/output_temporary.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

char *bp_cache_read(const char *path, size_t *size) {
    struct stat state;
    char *bytes = NULL;
    size_t done = 0;
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK | O_NOFOLLOW);
    if (file < 0) return NULL;
    if (fstat(file, &state) == 0 && S_ISREG(state.st_mode) && state.st_uid == geteuid() &&
        (state.st_mode & (S_IWGRP | S_IWOTH)) == 0 && state.st_size >= 0 &&
        state.st_size <= BP_CACHE_FILE_BYTES_MAX)
        bytes = malloc((size_t)state.st_size + 1);
    while (bytes != NULL && done < (size_t)state.st_size) {
        const ssize_t got = read(file, bytes + done, (size_t)state.st_size - done);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        done += (size_t)got;
    }
    if (bytes != NULL) {
        bytes[done] = '\0';
        futimens(file, NULL);
    }
    close(file);
    *size = done;
    return bytes;
}

static bool write_all(int file, const void *bytes, size_t size) {
    const char *at = bytes;
    while (size > 0) {
        const ssize_t put = write(file, at, size);
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) return false;
        at += put;
        size -= (size_t)put;
    }
    return true;
}

void bp_cache_write(const char *path, const BpCachePart *parts, size_t count) {
    bool unnamed = false;
    char *name = NULL;
    const int file = bp_temporary_create(path, 0600, &unnamed, &name);
    if (file < 0) return;
    bool good = true;
    for (size_t p = 0; p < count && good; ++p) good = write_all(file, parts[p].bytes, parts[p].size);
    if (good) good = bp_temporary_place(&unnamed, &name, file, path, true) == 0;
    if (!good) bp_temporary_remove(&name);
    close(file);
}
