/* check_against.h: compares the results of a check with those of an earlier one.
 *
 * In:    the document of the earlier check, the scenes of this one.   Out: the changes.
 * Knows: documents (check_report.h).   Does not know: how they came about, exit codes.
 *
 * Devices are identified by platform and name, and by their order where both are equal, since numbers and
 * driver versions change. */
#ifndef BP_CLI_CONFORM_CHECK_AGAINST_H
#define BP_CLI_CONFORM_CHECK_AGAINST_H

#include "base/status.h"

#include <jansson.h>
#include <stdio.h>

/* Reads the document of an earlier check. BP_ERR_FILE: it cannot be read; BP_ERR_USAGE: it is not such a
 * document. The caller releases *document with json_decref(). */
BpStatus bp_check_against_read(const char *path, json_t **document, BpError *err);

/* {"file", "ballpark", "regressions": how many, "changes": [{"kind", "scene", "device", "was", "now"}]}.
 * Kinds:
 *   "regression"   agreed, and does no longer; "recovered": the other way round; "verdict": another change
 *   "driver"       the device has another driver version, once per device
 *   "gone"         a device of the earlier check is missing; only if `all` devices were checked
 *   "new"          a device or a scene that the earlier check did not have
 *   "settings"     the scene was checked with another size, number of samples, depth, seed or kernel
 * A device that is gone is a regression if it agreed anywhere. NULL: out of memory. */
json_t *bp_check_against(const json_t *scenes, const json_t *earlier, const char *path, bool all);

/* The number of devices that are missing. */
size_t bp_check_against_gone(const json_t *against);

/* Prints a line for each change, and the number of regressions. */
void bp_check_against_print(const json_t *against, FILE *out);

#endif
