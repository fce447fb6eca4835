/* check_report.h: what `check` found, for people and for programs.
 *
 * Knows: check results, jansson.   Does not know: how checks are run. */
#ifndef BP_CLI_CHECK_REPORT_H
#define BP_CLI_CHECK_REPORT_H

#include "check/check.h"

#include <jansson.h>
#include <stdio.h>

/* One device's result; NULL when out of memory. */
json_t *bp_check_report_json(const BpCheckResult *result);

/* One device that gave no result: `message` says why. */
json_t *bp_check_report_failure(const BpDeviceInfo *device, const char *message);

/* The document: the scene, the settings and the results (an array, which it takes over). */
json_t *bp_check_report_document(const BpScene *scene, const BpCheckOptions *options, json_t *results);

/* A table of all results, a line each. */
void bp_check_report_table(const json_t *results, FILE *out);

#endif
