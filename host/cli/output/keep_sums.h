/* keep_sums.h: saves the sums of a finished render whose picture cannot be written.
 *
 * In:    a film, the path of its picture, the error.   Out: a .bpa file, named in the error.
 * Knows: which folders to try.   Does not know: why the picture failed. */
#ifndef BP_CLI_OUTPUT_KEEP_SUMS_H
#define BP_CLI_OUTPUT_KEEP_SUMS_H

#include "film/film.h"

/* Writes the film to a new file in $TMPDIR or /tmp, else in the current folder, and appends the path and the
 * command that makes a picture of it to the error. Nothing is kept if the result goes to a pipe or a device
 * ("-" is standard output), since whoever closes a pipe has seen enough; nor if the error reports that the
 * result itself was kept. If nothing can be written, the error is unchanged. */
void bp_keep_sums(const BpFilm *film, const char *result, BpError *err);

#endif
