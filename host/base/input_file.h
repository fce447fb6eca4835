/* input_file.h: opens and reads input files.
 *
 * In:    a path.   Out: bytes, or an open stream.
 * Knows: regular files, pipes, directories, devices.   Does not know: what the bytes mean. */
#ifndef BP_BASE_INPUT_FILE_H
#define BP_BASE_INPUT_FILE_H

#include "status.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Resolves the path `file` relative to the folder of `document`; the caller frees it. NULL: out of memory. */
char *bp_path_beside(const char *document, const char *file);
/* Whether a path ends so (".ply"), in any case, also with .gz behind it, and has a name before that. */
bool bp_path_has_ending(const char *path, const char *ending);

/* Larger scene documents are refused: parsing takes twenty times as much memory, and so many spheres belong
 * in a PLY file. The limit also ends reading from an endless stream. */
#define BP_TEXT_BYTES_MAX ((uint64_t)512 << 20)

/* Larger point files are refused, since reading one would take hours. */
#define BP_PLY_BYTES_MAX ((uint64_t)1024 * 134217728u)

/* Opens a regular file, or a pipe where accepted; never a directory, device or socket. `expected` describes
 * in the error what should have been there. *size is in bytes, 0 for a pipe. The caller closes the stream. */
BpStatus bp_file_open(const char *path, bool accept_pipe, const char *expected, FILE **stream, uint64_t *size,
                      BpError *err);
/* Reads an open stream to its end, BP_TEXT_BYTES_MAX at most; `size`: its length, 0 if unknown; `path` names
 * it in errors. Free *bytes with free(). */
BpStatus bp_stream_read(FILE *stream, uint64_t size, const char *path, char **bytes, size_t *length,
                        BpError *err);
/* Reports a fault in the content of an open file or, if the stream is in error, that reading it failed.
 * `path` and `line`, 0 when unknown, are the place. */
BpStatus bp_stream_fail(FILE *stream, const char *path, int line, BpError *err, const char *format,
                        va_list arguments) BP_PRINTF_LIKE(5, 0);
/* Reads a file or pipe whole. Free *bytes with free(). */
BpStatus bp_file_read(const char *path, const char *expected, char **bytes, size_t *length, BpError *err);

#endif
