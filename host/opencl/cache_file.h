/* cache_file.h: a file of the user's cache, which another process may write, damage or remove at any time.
 *
 * In:    a path, bytes.   Out: the bytes, or none.
 * Knows: files and their owners.   Does not know: what is kept, or whether a file is complete, which its
 * checksum shows. */
#ifndef BP_OPENCL_CACHE_FILE_H
#define BP_OPENCL_CACHE_FILE_H

#include <stddef.h>

#define BP_CACHE_FILE_BYTES_MAX (64u << 20) /* a larger file is not ours */

typedef struct BpCachePart {
    const void *bytes;
    size_t size;
} BpCachePart;

/* Reads a file that belongs to this user and that no other user can write; heap, with a zero byte appended.
 * NULL: there is no such file. Updates the file's time, so that unused files are the oldest. */
char *bp_cache_read(const char *path, size_t *size);

/* Writes the parts one after the other. The file appears whole or not at all, and where it cannot be written
 * nothing happens. Not synced: its checksum exposes a file that was truncated by a power failure. */
void bp_cache_write(const char *path, const BpCachePart *parts, size_t count);

#endif
