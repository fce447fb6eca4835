/* input_file.c: a file's bytes, whole, and from what kinds of files they are taken.
 *
 * In:    a path, or the name of a file that the program holds.   Out: bytes, or an open stream.
 * Knows: directories, devices and pipes are not regular files. Does not know: what the bytes mean. */
#ifdef __linux__
#define _GNU_SOURCE /* memfd_create */
#endif
#include "input_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FIRST_CAPACITY = 1 << 16 };

static const char *kind_text(mode_t mode) {
    if (S_ISDIR(mode)) return "a directory";
    if (S_ISFIFO(mode)) return "a pipe";
    if (S_ISSOCK(mode)) return "a socket";
    return "a device";
}

static BpStatus fail_open(const char *path, BpError *err) {
    const BpStatus status = bp_fail(err, BP_ERR_SCENE, "cannot open it: %s; check the path", strerror(errno));
    bp_error_at(err, path, 0, 0);
    return status;
}

static BpStatus fail_kind(const char *path, mode_t mode, const char *expected, BpError *err) {
    const BpStatus status = bp_fail(err, BP_ERR_SCENE, "found %s, expected %s", kind_text(mode), expected);
    bp_error_at(err, path, 0, 0);
    return status;
}

char *bp_path_beside(const char *document, const char *file) {
    const char *const slash = strrchr(document, '/');
    const size_t folder = file[0] == '/' || slash == NULL ? 0 : (size_t)(slash - document) + 1;
    const size_t file_size = strlen(file) + 1;
    char *path = malloc(folder + file_size);
    if (path == NULL) return NULL;
    memcpy(path, document, folder);
    memcpy(path + folder, file, file_size);
    return path;
}

/* The part of `path` below the folder of `to`, or NULL. */
static const char *path_below(const char *path, const char *to) {
    const char *const slash = strrchr(to, '/');
    const size_t length = slash != NULL ? (size_t)(slash - to) + 1 : 0;
    if (length == 0) return path[0] != '/' ? path : NULL;
    return strncmp(path, to, length) == 0 && path[length] != '/' ? path + length : NULL;
}

char *bp_path_moved(const char *document, const char *to, const char *file, bool *no_memory) {
    char folder[4096] = "/";
    char *const path = bp_path_beside(document, file);
    const char *const below = path != NULL ? path_below(path, to) : NULL;
    char *moved = NULL;
    if (below != NULL) {
        moved = strdup(below);
    } else if (path != NULL && (path[0] == '/' || getcwd(folder, sizeof folder - 2) != NULL)) {
        strcat(folder, folder[1] != '\0' ? "/" : "");
        moved = bp_path_beside(folder, path);
    }
    *no_memory = path == NULL || (below != NULL && moved == NULL);
    free(path);
    return moved;
}

BpStatus bp_file_open(const char *path, bool accept_pipe, const char *expected, FILE **stream, uint64_t *size,
                      BpError *err) {
    struct stat state;
    *stream = NULL;
    /* Looked at before it is opened, since opening a device can have effects; and after, since names can
     * change. */
    if (stat(path, &state) != 0) return fail_open(path, err);
    const bool pipe = accept_pipe && S_ISFIFO(state.st_mode);
    if (!S_ISREG(state.st_mode) && !pipe) return fail_kind(path, state.st_mode, expected, err);
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | (pipe ? 0 : O_NONBLOCK));
    if (descriptor < 0) return fail_open(path, err);
    if (fstat(descriptor, &state) != 0 ||
        !(S_ISREG(state.st_mode) || (accept_pipe && S_ISFIFO(state.st_mode)))) {
        close(descriptor);
        return fail_kind(path, state.st_mode, expected, err);
    }
    *size = S_ISREG(state.st_mode) ? (uint64_t)state.st_size : 0;
    *stream = fdopen(descriptor, "rb");
    if (*stream == NULL) {
        const BpStatus status = fail_open(path, err);
        close(descriptor);
        return status;
    }
    return BP_OK;
}

static BpStatus fail_size(const char *path, BpError *err) {
    const BpStatus status = bp_fail(
        err, BP_ERR_SCENE,
        "found more than %u MiB, expected a smaller document; put the spheres into a PLY file (\"clouds\")",
        (unsigned)(BP_TEXT_BYTES_MAX >> 20));
    bp_error_at(err, path, 0, 0);
    return status;
}

/* A stream that has a descriptor, as readers need. */
static BpStatus open_held(BpHeldFiles *held, const char *wanted, FILE **stream, uint64_t *size,
                          BpError *err) {
    const char *name = NULL, *bytes = NULL;
    size_t length = 0;
    for (size_t i = 0; (bytes = held(i, &name, &length)) != NULL && strcmp(name, wanted) != 0;) i++;
    if (bytes == NULL) return bp_fail(err, BP_ERR_SCENE, "it is not among the files of this program");
    *size = length;
#ifdef __linux__
    const int descriptor = memfd_create(name, MFD_CLOEXEC);
    size_t written = 0;
    for (ssize_t more = 1; descriptor >= 0 && written < length && more > 0;
         written += more > 0 ? (size_t)more : 0)
        more = write(descriptor, bytes + written, length - written);
    const bool whole = descriptor >= 0 && written == length && lseek(descriptor, 0, SEEK_SET) == 0;
    *stream = whole ? fdopen(descriptor, "rb") : NULL;
    if (*stream == NULL && descriptor >= 0) close(descriptor);
    if (*stream != NULL) return BP_OK;
#else
    *stream = tmpfile();
    if (*stream != NULL && fwrite(bytes, 1, length, *stream) == length && fseeko(*stream, 0, SEEK_SET) == 0)
        return BP_OK;
    if (*stream != NULL) fclose(*stream);
#endif
    return bp_fail(err, BP_ERR_MEMORY, "no memory for the file: %s", strerror(errno));
}

BpStatus bp_node_open_file(const BpNode *node, const char *path, const char *expected, FILE **stream,
                           uint64_t *size, BpError *err) {
    BpError inner = {0};
    BpHeldFiles *const held = node->document->held;
    BpStatus status = held != NULL ? open_held(held, path, stream, size, &inner)
                                   : bp_file_open(path, false, expected, stream, size, &inner);
    if (status != BP_OK) { /* the fault lies with the document, so the error stands there */
        char shown[256];
        bp_printable(path, shown, sizeof shown);
        const BpStatus at_node = bp_node_fail(node, BP_PART_VALUE, err, "\"%s\": %s", shown, inner.message);
        if (status != BP_ERR_MEMORY) status = at_node;
        bp_error_clear(&inner);
    }
    return status;
}

BpStatus bp_stream_read(FILE *stream, uint64_t size, const char *path, char **bytes, size_t *length,
                        BpError *err) {
    BpStatus status = BP_OK;
    char *buffer = NULL;
    size_t used = 0, capacity = 0;
    if (size > BP_TEXT_BYTES_MAX) return fail_size(path, err);
    do { /* one byte more than the file's size, so that its end is met in the first round */
        capacity = capacity > 0 ? 2 * capacity : size > 0 ? (size_t)size + 1 : FIRST_CAPACITY;
        char *grown = realloc(buffer, capacity);
        if (grown == NULL) {
            status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a file of %zu bytes", capacity);
            bp_error_at(err, path, 0, 0);
            goto done;
        }
        buffer = grown;
        used += fread(buffer + used, 1, capacity - used, stream);
    } while (used == capacity && used <= BP_TEXT_BYTES_MAX);
    if (used > BP_TEXT_BYTES_MAX) {
        status = fail_size(path, err);
        goto done;
    }
    if (ferror(stream)) {
        status = bp_fail(err, BP_ERR_FILE, "cannot read it: %s", strerror(errno));
        bp_error_at(err, path, 0, 0);
        goto done;
    }
    *bytes = buffer;
    *length = used;
    buffer = NULL;
done:
    free(buffer);
    return status;
}

BpStatus bp_stream_fail(FILE *stream, const char *path, int line, BpError *err, const char *format,
                        va_list arguments) {
    char text[768];
    vsnprintf(text, sizeof text, format, arguments);
    const BpStatus status = ferror(stream) ? bp_fail(err, BP_ERR_FILE, "reading failed: %s", text)
                                           : bp_fail(err, BP_ERR_SCENE, "%s", text);
    bp_error_at(err, path, line, 0);
    return status;
}

BpStatus bp_file_read(const char *path, const char *expected, char **bytes, size_t *length, BpError *err) {
    FILE *stream = NULL;
    uint64_t size = 0;
    BP_TRY(bp_file_open(path, true, expected, &stream, &size, err));
    const BpStatus status = bp_stream_read(stream, size, path, bytes, length, err);
    fclose(stream);
    return status;
}
