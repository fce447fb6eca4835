/* long_call.c: see long_call.h. */
#include "long_call.h"

#include "clock.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

/* How often a waiting thread checks the clock and polls stop(). */
#define LOOK_NS 100000000
#define ASK_NS 2000000

struct BpLongCall {
    void (*work)(void *argument), (*release)(void *argument);
    void *argument;
    pthread_mutex_t mutex;
    pthread_cond_t returned;
    double began;
    bool done, given_up;
    unsigned users; /* the caller and the thread; the last one to leave frees this */
};

/* Global, since hung threads belong to the process. */
static atomic_uint hanging;

static void leave(BpLongCall *call, bool done) {
    pthread_mutex_lock(&call->mutex);
    if (done) {
        call->done = true;
        if (call->given_up) --hanging;
        pthread_cond_broadcast(&call->returned);
    }
    const bool last = --call->users == 0;
    pthread_mutex_unlock(&call->mutex);
    if (!last) return;
    if (call->release != NULL) call->release(call->argument);
    pthread_cond_destroy(&call->returned);
    pthread_mutex_destroy(&call->mutex);
    free(call);
}

static void *run(void *argument) {
    BpLongCall *call = argument;
    call->work(call->argument);
    leave(call, true);
    return NULL;
}

BpLongCall *bp_long_call_begin(void (*work)(void *argument), void *argument, void (*release)(void *argument),
                               bool here) {
    pthread_t thread;
    BpLongCall *call = calloc(1, sizeof *call);
    if (call == NULL) return NULL;
    call->work = work;
    call->release = release;
    call->argument = argument;
    call->began = bp_clock_seconds();
    call->users = 2;
    pthread_mutex_init(&call->mutex, NULL);
    pthread_cond_init(&call->returned, NULL);
    if (!here && pthread_create(&thread, NULL, run, call) == 0)
        pthread_detach(thread);
    else
        run(call);
    return call;
}

bool bp_long_call_wait(BpLongCall *call, double seconds, bool (*stop)(void)) {
    pthread_mutex_lock(&call->mutex);
    while (!call->done) {
        if (seconds > 0 && bp_clock_seconds() - call->began > seconds) {
            if (!call->given_up) ++hanging;
            call->given_up = true;
            break;
        }
        if (stop != NULL && stop()) break;
        struct timespec next;
        clock_gettime(CLOCK_REALTIME, &next); /* by which conditions wait */
        next.tv_nsec += stop != NULL ? ASK_NS : LOOK_NS;
        next.tv_sec += next.tv_nsec / 1000000000;
        next.tv_nsec %= 1000000000;
        pthread_cond_timedwait(&call->returned, &call->mutex, &next);
    }
    const bool done = call->done;
    pthread_mutex_unlock(&call->mutex);
    return done;
}

void bp_long_call_leave(BpLongCall *call) {
    leave(call, false);
}

bool bp_long_call_hangs(void) {
    return hanging > 0;
}
