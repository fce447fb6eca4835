/* json_file.h: writes a JSON document to a file, completely or not at all, or to standard output.
 *
 * In:    a JSON value, a path.   Out: the file.
 * Knows: jansson, output files.   Does not know: what the document means. */
#ifndef BP_CLI_OUTPUT_JSON_FILE_H
#define BP_CLI_OUTPUT_JSON_FILE_H

#include "output.h"

#include <jansson.h>

/* Writes `root`, indented, and releases it. "-": standard output. A NULL root means out of memory
 * (BP_ERR_MEMORY), so the result of json_pack() can be passed unchecked. */
BpStatus bp_json_write(const BpCommandLine *line, json_t *root, const char *path, BpError *err);
/* The same in another format, by `print`, which gets the root. */
BpStatus bp_json_write_as(const BpCommandLine *line, json_t *root, const char *path, BpPrint *print,
                          BpError *err);

/* An exact 64-bit number: since jansson's integers are signed, a string of decimal digits from 2^63 on. */
json_t *bp_json_whole(uint64_t number);

json_t *bp_json_triple(const double v[3]); /* an array of three numbers, which are finite */

/* Appends the members of `part` to `root`. Takes ownership of both. NULL: either was NULL, or out of memory.
 */
json_t *bp_json_join(json_t *root, json_t *part);

#endif
