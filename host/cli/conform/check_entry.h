/* check_entry.h: the result of a check of one scene on one device, as a JSON object.
 *
 * In:    a check's result, or the reason why there is none.   Out: the object.
 * Knows: verdicts, JSON.   Does not know: files, the terminal, how checks are run.
 *
 * Every entry has "device", "verdict" ("agree", "disagree", "inconclusive", "failed", "skipped"), "agree"
 * (true for the first alone), and "reason", a sentence, unless it agrees. Table, JUnit file and comparison
 * are all made from these entries. */
#ifndef BP_CLI_CONFORM_CHECK_ENTRY_H
#define BP_CLI_CONFORM_CHECK_ENTRY_H

#include "check/check.h"

#include <jansson.h>

/* Each returns NULL when out of memory. `samples`: per pixel, as asked for. */
json_t *bp_check_entry(const BpCheckResult *result, uint64_t samples);
json_t *bp_check_entry_inconclusive(const BpDeviceInfo *device, const char *reason);
json_t *bp_check_entry_failed(const BpDeviceInfo *device, const char *reason);

/* {"number", "platform", "name", "version", "driver", "type"}. */
json_t *bp_check_device_json(const BpDeviceInfo *device);

/* The texts of an entry; never NULL. */
const char *bp_check_text(const json_t *object, const char *key);
const char *bp_check_device_text(const json_t *entry, const char *key);

/* Members of a scene's object, "on" or "off": whether its lights were sampled, and whether also by way of
 * balls of glass and mirrors. */
#define BP_CHECK_SAMPLING "light_sampling"
#define BP_CHECK_CAUSTICS "caustics"
enum { BP_CHECK_LABEL_SIZE = 4200 };
/* The name of a scene's object in tables and messages: "NAME", "NAME (lights sampled)" or "NAME (caustics
 * sampled)"; returns `text`. */
const char *bp_check_label(const json_t *scene, char *text, size_t size);

/* "NAME (PLATFORM, driver VERSION)", escaped for display, with a 0; returns `text`. */
const char *bp_check_device_title(const json_t *entry, char *text, size_t size);

/* The verdict on several entries: "disagree" before "failed" before "inconclusive" before "agree"; without
 * any, "inconclusive", as nothing passes without evidence. Skipped entries do not count. */
typedef struct BpCheckCounts {
    unsigned agree, disagree, inconclusive, failed, skipped;
} BpCheckCounts;
void bp_check_count(const json_t *entry, BpCheckCounts *counts);
const char *bp_check_overall(const BpCheckCounts *counts);

#endif
