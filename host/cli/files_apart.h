/* files_apart.h: every file that a command names plays one part only.
 *
 * In:    the command line.                Out: whether a result would overwrite the scene, or another result.
 * Knows: which options name files.        Does not know: what is written to them. */
#ifndef BP_CLI_FILES_APART_H
#define BP_CLI_FILES_APART_H

#include "options.h"

/* Whether two names lead to one regular file, or are the same name. A file that is not there yet is told by
 * its name alone; devices and pipes may be named as often as one likes. */
bool bp_same_file(const char *a, const char *b);

/* BP_ERR_USAGE names the two options, or the option and the operand, that lead to one file. `merge` may write
 * its result over one of the accumulators that it has read. */
BpStatus bp_files_check_apart(const BpCommandLine *line, BpError *err);

#endif
