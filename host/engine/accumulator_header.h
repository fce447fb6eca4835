/* accumulator_header.h: the line of JSON that a .bpa file begins with.
 *
 * In:    an accumulator, or a parsed header.   Out: the header's text, or the accumulator's settings.
 * Knows: the header's members and their limits.   Does not know: files, sums and counts (accumulator_file.h).
 */
#ifndef BP_ENGINE_ACCUMULATOR_HEADER_H
#define BP_ENGINE_ACCUMULATOR_HEADER_H

#include "accumulator.h"

#include <jansson.h>

#define BP_ACCUMULATOR_VERSION 2 /* of the files that are written */

/* The header line without its newline; the caller frees it. NULL when out of memory. */
char *bp_accumulator_header_make(const BpAccumulator *accumulator);

/* Checks version and byte order, and reads what decides how long the file has to be: width, height,
 * replicates and whether the version is 1 (`unverified`) into `sizes`, and whether there are fine sums.
 * `name` is the file's, for messages; BP_ERR_FILE names the member that is wrong. */
BpStatus bp_accumulator_header_sizes(const json_t *header, const char *name, BpAccumulator *sizes,
                                     bool *fine_sums, BpError *err);

/* Reads everything else into `accumulator`, which has its sizes. BP_ERR_FILE or BP_ERR_MEMORY. */
BpStatus bp_accumulator_header_settings(const json_t *header, const char *name, BpAccumulator *accumulator,
                                        BpError *err);

#endif
