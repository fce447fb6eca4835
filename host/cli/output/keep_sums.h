/* keep_sums.h: the sums of a finished render, when its picture cannot be written.
 *
 * In:    a film, where its picture was to go, why it could not.   Out: a .bpa file, named in the error.
 * Knows: which folders are left.   Does not know: why the picture failed. */
#ifndef BP_CLI_OUTPUT_KEEP_SUMS_H
#define BP_CLI_OUTPUT_KEEP_SUMS_H

#include "film/film.h"

/* Writes the film to a new file in $TMPDIR or /tmp, else in the current folder, and adds to the error, which
 * stays what it is, where it lies and how a picture is made of it. Nothing is kept when the result goes to a
 * pipe or a device ("-" is standard output): who closes a pipe wants no more of it. Nor when the error says
 * that the result itself was kept. Where nothing can be written, the error stays as it is. */
void bp_keep_sums(const BpFilm *film, const char *result, BpError *err);

#endif
