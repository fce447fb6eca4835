/* memory_limit.h: the memory limit of this process, and whether it is reached.
 *
 * In:    the system's limit (ulimit -v).   Out: its value; whether it is reached.
 * Knows: the system's calls.   Does not know: who needs memory. */
#ifndef BP_BASE_MEMORY_LIMIT_H
#define BP_BASE_MEMORY_LIMIT_H

#include <stdbool.h>
#include <stdint.h>

/* The limit in bytes; 0: no limit. */
uint64_t bp_memory_limit(void);

/* Whether another 64 MiB cannot be allocated. May be called in a signal handler. */
bool bp_memory_is_short(void);

#endif
