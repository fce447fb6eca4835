/* clock.h: monotonic wall-clock time and processor time, in seconds. */
#ifndef BP_BASE_CLOCK_H
#define BP_BASE_CLOCK_H

#include <time.h>

static inline double bp_clock_read(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Monotonic wall-clock seconds. */
static inline double bp_clock_seconds(void) {
    return bp_clock_read(CLOCK_MONOTONIC);
}

/* CPU time of all threads of this process; other load on the machine hardly affects it. */
static inline double bp_processor_seconds(void) {
    return bp_clock_read(CLOCK_PROCESS_CPUTIME_ID);
}

#endif
