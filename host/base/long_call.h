/* long_call.h: runs a call that may hang in a thread of its own, so that the caller can stop waiting.
 *
 * In:    what to call, how long to wait.   Out: whether it has returned.
 * Knows: threads, the clock.   Does not know: what is called.
 *
 * A hung thread cannot be ended. It is abandoned together with its data, which it releases if it ever
 * returns. */
#ifndef BP_BASE_LONG_CALL_H
#define BP_BASE_LONG_CALL_H

#include <stdbool.h>

typedef struct BpLongCall BpLongCall;

/* Starts work(argument). `release`: Optional; called once with the argument, when the work has returned and
 * the caller has left the call. `here`: runs the work in the caller's thread, before this returns; so it does
 * if no thread can be created. NULL: out of memory; nothing was called. */
BpLongCall *bp_long_call_begin(void (*work)(void *argument), void *argument, void (*release)(void *argument),
                               bool here);

/* Waits until the work has returned. False: it has not, `seconds` after it began (0: no limit), or stop()
 * returned true (Optional; called every 2 ms). Several threads may wait for one call. */
bool bp_long_call_wait(BpLongCall *call, double seconds, bool (*stop)(void));

/* The caller is done with the call, whether or not it has returned. */
void bp_long_call_leave(BpLongCall *call);

/* Whether a caller has given up waiting for a call that still has not returned. Such a thread may hold locks
 * that exit() needs, so the program then ends by _exit(). */
bool bp_long_call_hangs(void);

#endif
