/* check_failure.h: the documents of a check that failed before it had results.
 *
 * In:    the error.   Out: the files of --json and --junit, which report it.
 * Knows: errors, both documents.   Does not know: how a check is made.
 *
 * A reader of the files that ignores the exit code would take those of an earlier check for this one's. So
 * they are always written: the XML has a suite with one case, an error; the JSON has the members of any
 * check, without results, and "error": {"kind", "message", "file", "line", "column"}. */
#ifndef BP_CLI_CONFORM_CHECK_FAILURE_H
#define BP_CLI_CONFORM_CHECK_FAILURE_H

#include "cli/line/options.h"

#include <jansson.h>

/* `suite`: Optional; the name of the suite. `broken`: the broken drivers, from the survey; released. `junit`,
 * `json`: which files to write; a failure to write is a warning. `careful`: replaces an existing file only if
 * it looks like such a document, since a scene that could not be read may name it. */
void bp_check_failure_write(const BpCommandLine *line, const char *suite, const BpError *error,
                            json_t *broken, bool junit, bool json, bool careful);

#endif
