/* junit_file.h: writes results in the XML that continuous integration reads (JUnit's).
 *
 * In:    suites of cases, as JSON.   Out: the file.
 * Knows: XML, output files.   Does not know: what is tested.
 *
 * A suite is {"name", "properties": {name: text}, "cases": [{"name", "class", "seconds", "outcome", "type",
 * "reason"}]}. "outcome": "passed"; "failure" or "error", which do not pass, with a type and a reason; or
 * "skipped", with a reason. */
#ifndef BP_CLI_CONFORM_JUNIT_FILE_H
#define BP_CLI_CONFORM_JUNIT_FILE_H

#include "cli/line/options.h"

#include <jansson.h>

/* Writes the array `suites`, and releases it; NULL: out of memory. "-": standard output. */
BpStatus bp_junit_write(const BpCommandLine *line, json_t *suites, const char *path, BpError *err);

#endif
