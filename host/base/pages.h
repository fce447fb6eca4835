/* pages.h: large pages for large arrays, and arrays on pages of their own.
 *
 * In:    memory from malloc() that is about to be filled, or a size.   Out: memory.
 * Knows: the system's pages.   Does not know: what the memory is for. */
#ifndef BP_BASE_PAGES_H
#define BP_BASE_PAGES_H

#include <stdbool.h>
#include <stddef.h>

/* Requests pages of some megabytes for a large array, if the system has them: filling an array of millions of
 * spheres then does not cause a page fault for every 4096 bytes. The contents stay. Returns `memory`, which
 * may be NULL. */
void *bp_large_pages(void *memory, size_t bytes);

/* Memory for `count` elements of `size` bytes, not zeroed, on pages of its own: large ones, if it is large.
 * Devices that share the host's memory can use it in place. NULL: out of memory. Free with free(). */
void *bp_own_pages(size_t count, size_t size);

/* Whether `memory` is aligned to a page, as that of bp_own_pages() is. */
bool bp_begins_page(const void *memory);

#endif
