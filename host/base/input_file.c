/* input_file.c: see input_file.h. */
#include "input_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
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
    if (errno == ENOMEM) return bp_fail(err, BP_ERR_MEMORY, "out of memory for opening %s", path);
    const BpStatus status = bp_fail(err, BP_ERR_SCENE, "cannot open it: %s; check the path", strerror(errno));
    bp_error_at(err, path, 0, 0);
    return status;
}

static BpStatus fail_kind(const char *path, mode_t mode, const char *expected, BpError *err) {
    const BpStatus status = bp_fail(err, BP_ERR_SCENE, "found %s, expected %s", kind_text(mode), expected);
    bp_error_at(err, path, 0, 0);
    return status;
}

bool bp_path_has_ending(const char *path, const char *ending) {
    size_t length = strlen(path);
    const size_t size = strlen(ending);
    if (length > 3 && strcasecmp(path + length - 3, ".gz") == 0) length -= 3;
    return length > size && strncasecmp(path + length - size, ending, size) == 0;
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

BpStatus bp_file_open(const char *path, bool accept_pipe, const char *expected, FILE **stream, uint64_t *size,
                      BpError *err) {
    struct stat state;
    *stream = NULL;
    /* Checked before it is opened, since opening a device can have effects, and afterwards, since names can
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

BpStatus bp_stream_read(FILE *stream, uint64_t size, const char *path, char **bytes, size_t *length,
                        BpError *err) {
    BpStatus status = BP_OK;
    char *buffer = NULL;
    size_t used = 0, capacity = 0;
    if (size > BP_TEXT_BYTES_MAX) return fail_size(path, err);
    do { /* one byte more than the file's size, so that the first read reaches its end */
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
