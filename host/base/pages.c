/* pages.c: see pages.h. Linux has such pages ("transparent huge pages", set to madvise in many systems). */
#define _DEFAULT_SOURCE /* madvise */
#include "pages.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#define LARGE ((size_t)8 << 20)      /* bytes: a few large pages */
#define LARGE_PAGE ((size_t)2 << 20) /* of most processors */

static size_t page_bytes(void) {
    return (size_t)sysconf(_SC_PAGESIZE);
}

void *bp_large_pages(void *memory, size_t bytes) {
#ifdef MADV_HUGEPAGE
    if (memory == NULL || bytes < LARGE) return memory;
    const int before = errno;
    const uintptr_t page = page_bytes(), first = (uintptr_t)memory;
    /* The whole mapping that malloc made for it, since realloc cannot move a part of one, and would copy. */
    const uintptr_t begin = first / page * page, end = (first + bytes + page - 1) / page * page;
    (void)madvise((void *)begin, end - begin, MADV_HUGEPAGE); /* where it fails, small pages do */
    errno = before;
#else
    (void)bytes;
#endif
    return memory;
}

void *bp_own_pages(size_t count, size_t size) {
    if (size > 0 && count > (SIZE_MAX - LARGE_PAGE) / size) return NULL;
    const size_t bytes = count * size, page = bytes < LARGE ? page_bytes() : LARGE_PAGE;
    return bp_large_pages(aligned_alloc(page, (bytes / page + 1) * page), bytes);
}

bool bp_begins_page(const void *memory) {
    return (uintptr_t)memory % page_bytes() == 0;
}
