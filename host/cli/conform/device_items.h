/* device_items.h: a list of items of work on one device, in a process of its own.
 *
 * In:    the work, how many items, a limit of time.   Out: a JSON value or an error for each item.
 * Knows: child processes, time.   Does not know: what the work is.
 *
 * If a driver crashes or hangs, the current item and those after it are lost; earlier results are kept. */
#ifndef BP_CLI_CONFORM_DEVICE_ITEMS_H
#define BP_CLI_CONFORM_DEVICE_ITEMS_H

#include "base/status.h"

#include <jansson.h>
#include <stdio.h>

typedef struct BpDeviceItems {
    /* Processes item `number` in the child, and returns its result. `seconds`: its share of the time left; 0:
     * no limit. It may report its current step by bp_item_doing(). BP_ERR_INTERRUPTED ends the child's work.
     */
    BpStatus (*work)(const struct BpDeviceItems *items, size_t number, double seconds, FILE *out,
                     json_t **result, BpError *err);
    const void *argument; /* for `work` */
    size_t count;
    double seconds; /* for all items; 0: no limit */
    bool quiet;     /* no status line */
} BpDeviceItems;

/* Reports the current step, such as "rendering", for the error of an item during which a driver fails. `out`:
 * that of the work. */
void bp_item_doing(FILE *out, size_t number, const char *doing);

/* Either a result, or an error: BP_ERR_INCONCLUSIVE: no time was left for it; BP_ERR_INTERRUPTED;
 * BP_ERR_BROKEN_DEVICE: the driver crashed or hung; or that of the work. */
typedef struct BpItemOutcome {
    json_t *result; /* owned */
    BpError error;
} BpItemOutcome;

/* Fills `count` outcomes; clear them in any case. BP_ERR_MEMORY, BP_ERR_FILE: no process could be started.
 * Call it before this process uses OpenCL. */
BpStatus bp_device_items_run(const BpDeviceItems *items, BpItemOutcome *outcomes, BpError *err);
void bp_item_outcomes_clear(BpItemOutcome *outcomes, size_t count);

#endif
