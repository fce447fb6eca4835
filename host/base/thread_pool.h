/* thread_pool.h: a small thread pool: a parallel loop over numbered pieces of work.
 *
 * In:    a function, and how many pieces there are.   Out: every piece done, by some thread.
 * Knows: POSIX threads.   Does not know: what the work is. */
#ifndef BP_BASE_THREAD_POOL_H
#define BP_BASE_THREAD_POOL_H

#include <stddef.h>
#include <stdint.h>

typedef struct BpThreadPool BpThreadPool;

/* Does piece `piece`; `thread` < bp_thread_pool_size() is the thread's number, for memory of its own. */
typedef void BpParallelWork(void *context, uint32_t piece, unsigned thread);

/* `threads` in all, the caller's among them; 0: as many as the machine has cores. Where the system grants
 * fewer, and beyond 64, the pool is smaller. NULL: out of memory. */
BpThreadPool *bp_thread_pool_create(unsigned threads);
void bp_thread_pool_destroy(BpThreadPool **pool);
unsigned bp_thread_pool_size(const BpThreadPool *pool);

/* Calls work(context, piece, thread) once for every piece in 0 .. pieces-1, in any order, and returns when
 * all are done. What they wrote is visible to the caller. */
void bp_parallel_for(BpThreadPool *pool, BpParallelWork *work, void *context, uint32_t pieces);

/* Long arrays are processed in blocks of this many elements, one per piece; the last may be shorter. */
#define BP_BLOCK 16384u

static inline uint32_t bp_block_count(size_t elements) {
    return (uint32_t)((elements + BP_BLOCK - 1) / BP_BLOCK);
}
static inline size_t bp_block_begin(uint32_t block) {
    return (size_t)block * BP_BLOCK;
}
static inline size_t bp_block_end(uint32_t block, size_t elements) {
    const size_t end = bp_block_begin(block + 1);
    return end < elements ? end : elements;
}

#endif
