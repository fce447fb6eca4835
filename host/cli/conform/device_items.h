/* device_items.h: a list of items of work on one device, in a process of its own.
 *
 * In:    the work, how many items, a limit of time.   Out: a JSON value or an error for each item.
 * Knows: child processes, time.   Does not know: what the work is.
 *
 * A driver that crashes or hangs costs the item that it was at and those after it; what was done before
 * stands. */
#ifndef BP_CLI_CONFORM_DEVICE_ITEMS_H
#define BP_CLI_CONFORM_DEVICE_ITEMS_H

#include "base/status.h"

#include <jansson.h>
#include <stdio.h>

typedef struct BpDeviceItems {
    /* Does item `number` in the child, and gives its result. `seconds`: its share of the time that is left;
     * 0: no limit. It may say what it is at by bp_item_doing(). BP_ERR_INTERRUPTED ends the child's work. */
    BpStatus (*work)(const struct BpDeviceItems *items, size_t number, double seconds, FILE *out,
                     json_t **result, BpError *err);
    const void *argument; /* for `work` */
    size_t count;
    double seconds; /* for all items; 0: no limit */
    bool quiet;     /* no status line */
} BpDeviceItems;

/* "rendering": for the error of an item that a driver ends in the middle of. `out`: of the work. */
void bp_item_doing(FILE *out, size_t number, const char *doing);

/* Either a result, or an error with its code: BP_ERR_INCONCLUSIVE: there was no time for it;
 * BP_ERR_INTERRUPTED; BP_ERR_BROKEN_DEVICE: the driver crashed or hung; or what the work returned. */
typedef struct BpItemOutcome {
    json_t *result; /* owned */
    BpError error;
} BpItemOutcome;

/* Fills `count` outcomes; clear them in any case. BP_ERR_MEMORY, BP_ERR_FILE: there was no process. Call it
 * before this process uses OpenCL. */
BpStatus bp_device_items_run(const BpDeviceItems *items, BpItemOutcome *outcomes, BpError *err);
void bp_item_outcomes_clear(BpItemOutcome *outcomes, size_t count);

#endif
