/* check_junit.h: the results of a check as suites of cases, for junit_file.h.
 *
 * In:    the scenes of a document (check_report.h), broken drivers.   Out: an array of suites.
 * Knows: entries.   Does not know: XML, files.
 *
 * A device is a suite, a scene a case. An inconclusive result is a failure: nothing passes without evidence.
 * A driver that cannot list its devices is a suite with one case, an error. */
#ifndef BP_CLI_CONFORM_CHECK_JUNIT_H
#define BP_CLI_CONFORM_CHECK_JUNIT_H

#include <jansson.h>

/* NULL: out of memory. */
json_t *bp_check_junit(const json_t *scenes, const json_t *broken);
/* {"name": the device's title, "properties": {"device", "platform", "driver", "version", "ballpark"},
 * "cases":
 * []}. */
json_t *bp_check_junit_suite(const json_t *entry);

#endif
