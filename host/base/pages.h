/* pages.h: large pages for large arrays.
 *
 * In:    memory that malloc gave and that is about to be filled, or a size.   Out: that memory.
 * Knows: the system's pages.   Does not know: what the memory is for. */
#ifndef BP_BASE_PAGES_H
#define BP_BASE_PAGES_H

#include <stddef.h>

/* Asks the system to back an array by pages of some megabytes, if it is large and the system has them on
 * request: an array of millions of spheres is then filled without a fault for every 4096 bytes. Contents
 * stay. Returns `memory`, which may be NULL. */
void *bp_large_pages(void *memory, size_t bytes);

/* As calloc(), with such pages. */
void *bp_large_zeroed(size_t count, size_t size);

#endif
