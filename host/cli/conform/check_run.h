/* check_run.h: checks scenes on one device, in a process of its own.
 *
 * In:    scenes and options, a device, a limit of time.   Out: an entry (check_entry.h) for each scene.
 * Knows: checks, items of work (device_items.h).   Does not know: how results are reported, exit codes. */
#ifndef BP_CLI_CONFORM_CHECK_RUN_H
#define BP_CLI_CONFORM_CHECK_RUN_H

#include "check/check.h"
#include "cli/line/options.h"
#include "device_items.h"

typedef struct BpCheckItem {
    const char *name; /* in messages */
    const BpScene *scene;
    BpCheckOptions options;
} BpCheckItem;

typedef struct BpCheckRun {
    const BpCheckItem *items;
    size_t count;
    const BpDeviceInfo *device;
    double seconds;  /* for all of them: each gets its share of the time left; 0: no limit */
    const char *map; /* Optional. Picture file; of one item alone. */
    BpFormat map_format;
    bool quiet;
    const BpCommandLine *line; /* determines how the picture is written */
} BpCheckRun;

/* Fills an outcome for each item: its result is {"entry", "text": the verdict as text}. An item without a
 * verdict has an error, and an entry as well. Clear them in any case. */
BpStatus bp_check_run(const BpCheckRun *run, BpItemOutcome *outcomes, BpError *err);

#endif
