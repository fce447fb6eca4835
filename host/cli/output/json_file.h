/* json_file.h: writes a JSON document to a file, completely or not at all, or to standard output.
 *
 * In:    a JSON value, a path.   Out: the file.
 * Knows: jansson, output files.   Does not know: what the document says. */
#ifndef BP_CLI_OUTPUT_JSON_FILE_H
#define BP_CLI_OUTPUT_JSON_FILE_H

#include "output.h"

#include <jansson.h>

/* Writes `root`, indented, and releases it. "-": standard output. A NULL root is memory that ran out
 * (BP_ERR_MEMORY), so that the result of json_pack() can be passed on unchecked. */
BpStatus bp_json_write(const BpCommandLine *line, json_t *root, const char *path, BpError *err);
/* The same in another format, by `print`, which gets the root. */
BpStatus bp_json_write_as(const BpCommandLine *line, json_t *root, const char *path, BpPrint *print,
                          BpError *err);

/* A number of 64 bits, exact: jansson's integers have a sign, so from 2^63 on it is a text of decimal digits.
 */
json_t *bp_json_whole(uint64_t number);

json_t *bp_json_triple(const double v[3]); /* an array of three numbers, which are finite */

/* `root` with the members of `part` behind its own. Takes both over. NULL, when either is or memory ran out.
 */
json_t *bp_json_join(json_t *root, json_t *part);

#endif
