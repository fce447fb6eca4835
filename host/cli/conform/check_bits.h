/* check_bits.h: `ballpark check --bits`: compares a device's pictures with recorded ones, exactly.
 *
 * In:    the recorded pictures (host/check/bits.json), a device.   Out: an entry for each picture and form.
 * Knows: recorded pictures, agreement scenes, items of work (device_items.h).
 * Does not know: the command line, how results are written.
 *
 * A recorded picture is {"scene", "width", "samples_per_pixel", "seed", "precision", "refinement", "hash",
 * "radiance"} (bits.h). Each is rendered in every form that must give the same picture: by packets and one
 * path at a time, through a tree and through a list. The refinement is the arithmetic that hits are computed
 * in: CPUs with double use "double", all others error-free transforms of "float" (render_plan.c), which may
 * differ in the last digits; so a device is compared with what was recorded for its own. BALLPARK_BITS=FILE
 * in the environment reads another file than the embedded one; scripts/record-bits writes it anew. */
#ifndef BP_CLI_CONFORM_CHECK_BITS_H
#define BP_CLI_CONFORM_CHECK_BITS_H

#include "base/status.h"
#include "suite.h"

#include <jansson.h>
#include <stdio.h>

/* The recorded pictures, an array. BP_ERR_FILE. */
BpStatus bp_check_bits_read(json_t **pictures, BpError *err);

typedef struct BpBitsRun {
    const json_t *pictures;
    const BpSuite *suite; /* its scenes get other widths */
    const BpDeviceInfo *device;
    double seconds;      /* 0: no limit */
    BpKernelForm kernel; /* BP_KERNEL_AUTO: every form that the device uses */
    bool one_precision;  /* only `precision` */
    BpPrecision precision;
    bool quiet;
} BpBitsRun;

/* Renders all of them in a process of its own. *entries: an array of entries (check_entry.h), with "scene",
 * "kernel", "acceleration", "precision", "refinement", and "hash"; where it is another hash also
 * "recorded_hash", "radiance" and "difference". BP_ERR_FILE: what is recorded is damaged. */
BpStatus bp_check_bits_run(const BpBitsRun *run, json_t **entries, BpError *err);

/* "bubble, packet, tree, single (refined in float)"; returns `text`. */
const char *bp_check_bits_label(const json_t *entry, char *text, size_t size);

/* Prints a line for each entry that differs, fails or is skipped for a reason, the counts, and advice. */
void bp_check_bits_print(const json_t *entries, bool quiet, FILE *out);

#endif
