/* thread_pool.c: see thread_pool.h. Threads live as long as the pool; a new round of work wakes them. */
#include "thread_pool.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

#define THREADS_MAX 64u /* more would wait for memory and for each other */

typedef struct Member {
    BpThreadPool *pool;
    pthread_t thread;
    unsigned number;
} Member;

struct BpThreadPool {
    unsigned size; /* with the caller, who is number 0 */
    pthread_mutex_t mutex;
    pthread_cond_t wake, idle;
    uint64_t round;   /* counts calls of bp_parallel_for */
    unsigned working; /* members that have not finished the round */
    bool leave;
    BpParallelWork *work;
    void *context;
    uint32_t pieces;
    atomic_uint_fast64_t next;
    Member members[THREADS_MAX];
};

static void work_through(BpThreadPool *pool, unsigned thread) {
    for (;;) {
        const uint64_t piece = atomic_fetch_add_explicit(&pool->next, 1, memory_order_relaxed);
        if (piece >= pool->pieces) return;
        pool->work(pool->context, (uint32_t)piece, thread);
    }
}

static void *member_main(void *argument) {
    Member *member = argument;
    BpThreadPool *pool = member->pool;
    uint64_t seen = 0;
    pthread_mutex_lock(&pool->mutex);
    for (;;) {
        while (pool->round == seen && !pool->leave) pthread_cond_wait(&pool->wake, &pool->mutex);
        if (pool->leave) break;
        seen = pool->round;
        pthread_mutex_unlock(&pool->mutex);
        work_through(pool, member->number);
        pthread_mutex_lock(&pool->mutex);
        if (--pool->working == 0) pthread_cond_signal(&pool->idle);
    }
    pthread_mutex_unlock(&pool->mutex);
    return NULL;
}

BpThreadPool *bp_thread_pool_create(unsigned threads) {
    BpThreadPool *pool = calloc(1, sizeof *pool);
    if (pool == NULL) return NULL;
    pthread_mutex_init(&pool->mutex, NULL);
    pthread_cond_init(&pool->wake, NULL);
    pthread_cond_init(&pool->idle, NULL);
    atomic_init(&pool->next, 0);
    if (threads == 0) {
        const long cores = sysconf(_SC_NPROCESSORS_ONLN);
        threads = cores > 0 ? (unsigned)cores : 1;
    }
    if (threads > THREADS_MAX) threads = THREADS_MAX;
    pool->size = 1;
    while (pool->size < threads) {
        Member *member = &pool->members[pool->size];
        *member = (Member){.pool = pool, .number = pool->size};
        if (pthread_create(&member->thread, NULL, member_main, member) != 0) break;
        ++pool->size;
    }
    return pool;
}

void bp_thread_pool_destroy(BpThreadPool **pool) {
    if (*pool == NULL) return;
    pthread_mutex_lock(&(*pool)->mutex);
    (*pool)->leave = true;
    pthread_cond_broadcast(&(*pool)->wake);
    pthread_mutex_unlock(&(*pool)->mutex);
    for (unsigned i = 1; i < (*pool)->size; ++i) pthread_join((*pool)->members[i].thread, NULL);
    pthread_cond_destroy(&(*pool)->wake);
    pthread_cond_destroy(&(*pool)->idle);
    pthread_mutex_destroy(&(*pool)->mutex);
    free(*pool);
    *pool = NULL;
}

unsigned bp_thread_pool_size(const BpThreadPool *pool) {
    return pool->size;
}

void bp_parallel_for(BpThreadPool *pool, BpParallelWork *work, void *context, uint32_t pieces) {
    if (pool->size == 1 || pieces < 2) {
        for (uint32_t piece = 0; piece < pieces; ++piece) work(context, piece, 0);
        return;
    }
    pthread_mutex_lock(&pool->mutex);
    pool->work = work;
    pool->context = context;
    pool->pieces = pieces;
    atomic_store_explicit(&pool->next, 0, memory_order_relaxed);
    pool->working = pool->size - 1;
    ++pool->round;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->mutex);
    work_through(pool, 0);
    pthread_mutex_lock(&pool->mutex);
    while (pool->working > 0) pthread_cond_wait(&pool->idle, &pool->mutex);
    pthread_mutex_unlock(&pool->mutex);
}
