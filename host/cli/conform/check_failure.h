/* check_failure.h: the documents of a check that has no results, because it ended by an error.
 *
 * In:    the error.   Out: the files of --json and --junit, which report that.
 * Knows: errors, both documents.   Does not know: how a check is made.
 *
 * Whoever reads the files and not the exit code would take those of an earlier check for this one's. So they
 * are written whatever happens: in the XML a suite with one case, which is an error; in JSON the members of
 * any check, without results, and "error": {"kind", "message", "file", "line", "column"}. */
#ifndef BP_CLI_CONFORM_CHECK_FAILURE_H
#define BP_CLI_CONFORM_CHECK_FAILURE_H

#include "cli/line/options.h"

#include <jansson.h>

/* `suite`: Optional; the name of the suite that was to be checked. `broken`: the broken drivers, as the
 * survey has them; released. `junit`, `json`: which of the files are wanted; what cannot be written is told
 * in a warning. A file that the scene may name (which is unknown, since it could not be read) is not
 * overwritten: where `careful`, only nothing, or what looks like such a document, is replaced. */
void bp_check_failure_write(const BpCommandLine *line, const char *suite, const BpError *error,
                            json_t *broken, bool junit, bool json, bool careful);

#endif
