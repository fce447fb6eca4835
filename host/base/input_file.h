/* input_file.h: files that are read.
 *
 * In:    a path.   Out: bytes, or an open stream.
 * Knows: directories, devices and pipes are not regular files.   Does not know: what the bytes mean. */
#ifndef BP_BASE_INPUT_FILE_H
#define BP_BASE_INPUT_FILE_H

#include "status.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* `file` as seen from the folder of `document`, both paths; the caller frees it. NULL: out of memory. */
char *bp_path_beside(const char *document, const char *file);

/* A scene's document of more bytes is refused: the program would need twenty times as much memory for it, and
 * spheres in such numbers belong into a PLY file. It also ends the reading of what has no end. */
#define BP_TEXT_BYTES_MAX ((uint64_t)512 << 20)

/* A file of points of more bytes is refused: reading it would take hours, whatever is in it. */
#define BP_PLY_BYTES_MAX ((uint64_t)1024 * 134217728u)

/* Opens a regular file, or a pipe where accepted; never a directory, device or socket. `expected` says in the
 * error what should have been there. *size is in bytes, 0 for a pipe. The caller closes the stream. */
BpStatus bp_file_open(const char *path, bool accept_pipe, const char *expected, FILE **stream, uint64_t *size,
                      BpError *err);
/* Reads an open stream to its end, BP_TEXT_BYTES_MAX at most; `size`: how much that is, 0 when not known;
 * `path` names it in errors. Free *bytes with free(). */
BpStatus bp_stream_read(FILE *stream, uint64_t size, const char *path, char **bytes, size_t *length,
                        BpError *err);
/* Fails on what an open file holds, or, if the stream has met an error, on reading it. `path` and `line`, 0
 * when unknown, are the place. */
BpStatus bp_stream_fail(FILE *stream, const char *path, int line, BpError *err, const char *format,
                        va_list arguments) BP_PRINTF_LIKE(5, 0);
/* Reads a file or pipe whole. Free *bytes with free(). */
BpStatus bp_file_read(const char *path, const char *expected, char **bytes, size_t *length, BpError *err);

#endif
