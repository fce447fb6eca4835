/* clock.h: seconds since some fixed moment, for measuring; never set back. */
#ifndef BP_BASE_CLOCK_H
#define BP_BASE_CLOCK_H

#include <time.h>

static inline double bp_clock_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
