/* pages.c: see pages.h. Linux has such pages ("transparent huge pages", set to madvise in many systems). */
#define _DEFAULT_SOURCE /* madvise */
#include "pages.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#define LARGE ((size_t)8 << 20) /* bytes: a few pages of two megabytes */

void *bp_large_pages(void *memory, size_t bytes) {
#ifdef MADV_HUGEPAGE
    if (memory == NULL || bytes < LARGE) return memory;
    const int before = errno;
    const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), first = (uintptr_t)memory;
    /* The whole mapping that malloc made for it, since realloc cannot move a part of one, and would copy. */
    const uintptr_t begin = first / page * page, end = (first + bytes + page - 1) / page * page;
    (void)madvise((void *)begin, end - begin, MADV_HUGEPAGE); /* where it fails, small pages do */
    errno = before;
#else
    (void)bytes;
#endif
    return memory;
}

void *bp_large_zeroed(size_t count, size_t size) {
    return bp_large_pages(calloc(count, size), count * size);
}
