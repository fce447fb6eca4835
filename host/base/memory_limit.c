/* memory_limit.c: see memory_limit.h. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "memory_limit.h"

#include <errno.h>
#include <stddef.h>
#include <sys/mman.h>
#include <sys/resource.h>

#define PROBE_BYTES ((size_t)64 << 20)

uint64_t bp_memory_limit(void) {
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return 0;
    return (uint64_t)limit.rlim_cur;
}

bool bp_memory_is_short(void) {
    const int before = errno;
    void *const probe = mmap(NULL, PROBE_BYTES, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (probe != MAP_FAILED) munmap(probe, PROBE_BYTES);
    errno = before;
    return probe == MAP_FAILED;
}
