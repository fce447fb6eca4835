/* cache_folder.h: the folder of the user's cache.
 *
 * In:    the environment.   Out: a path.
 * Knows: the XDG Base Directory Specification, how our text files there are named.
 * Does not know: what is kept. */
#ifndef BP_OPENCL_CACHE_FOLDER_H
#define BP_OPENCL_CACHE_FOLDER_H

#include <stdbool.h>

/* $XDG_CACHE_HOME/ballpark or ~/.cache/ballpark, followed by `below` ("" or "/name"); heap. NULL: the
 * environment names neither as an absolute path, or out of memory. `make`: creates the folder, accessible to
 * this user alone; a failure shows when a file is written there. */
char *bp_cache_folder(const char *below, bool make);

/* The path of the file "<kind>-<hash of identity>.txt" in that folder, heap; NULL: as above. */
char *bp_cache_file_path(const char *kind, const char *identity, bool make);

#endif
