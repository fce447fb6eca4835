/* long_call.h: a call that may never return, made in a thread of its own, so that waiting for it can end.
 *
 * In:    what to call, how long to wait.   Out: whether it has returned.
 * Knows: threads, the clock.   Does not know: what is called.
 *
 * A thread that hangs cannot be ended. It is left behind with what it works on, and should it return after
 * all, it releases that. */
#ifndef BP_BASE_LONG_CALL_H
#define BP_BASE_LONG_CALL_H

#include <stdbool.h>

typedef struct BpLongCall BpLongCall;

/* Begins work(argument). `release`: Optional; called once with the argument, when the work has returned and
 * the caller has left it. `here`: in the caller's own thread, so it is done before this returns; as it is
 * where no thread can be had. NULL: out of memory; nothing was called. */
BpLongCall *bp_long_call_begin(void (*work)(void *argument), void *argument, void (*release)(void *argument),
                               bool here);

/* Waits until the work has returned. False: it has not, `seconds` after it began (0: no limit), or stop()
 * returned true (Optional; called every 2 ms). Several threads may wait for one call. */
bool bp_long_call_wait(BpLongCall *call, double seconds, bool (*stop)(void));

/* The caller is done with the call, whether or not it has returned. */
void bp_long_call_leave(BpLongCall *call);

/* Whether a caller has given up waiting for a call that has not returned by now. Such a thread may hold what
 * the end of a process waits for: a program then ends by _exit(). */
bool bp_long_call_hangs(void);

#endif
