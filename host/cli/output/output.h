/* output.h: the files that a command writes.
 *
 * In:    the command line, a path, what prints the content.   Out: the file, whole or not at all.
 * Knows: "-", --no-clobber, that overwriting is announced.   Does not know: what is printed. */
#ifndef BP_CLI_OUTPUT_OUTPUT_H
#define BP_CLI_OUTPUT_OUTPUT_H

#include "base/output_file.h"
#include "cli/line/options.h"

/* Checks before work begins that `path` can be written; "-" can. With --no-clobber, an existing file is an
 * error. */
BpStatus bp_line_check_output(const BpCommandLine *line, const char *path, BpError *err);

/* The same for a file with a fixed format: another ending than `ending` (".json") is refused, with `what` as
 * the reason. Devices and pipes, such as /dev/stdout, may have any name. */
BpStatus bp_line_check_named(const BpCommandLine *line, const char *path, const char *ending,
                             const char *what, BpError *err);

/* Announces on standard error that the file `path` (NULL: none) will be overwritten, if it exists. To be
 * called when work begins, after all checks, since a refused command overwrites nothing. */
void bp_line_say_overwritten(const BpCommandLine *line, const char *path);

/* Writes `path` by `print`; "-" is standard output. With --no-clobber the name is claimed when the content is
 * complete: a file that was created in the meantime is not replaced. */
BpStatus bp_line_write(const BpCommandLine *line, const char *path, BpPrint *print, const void *what,
                       BpError *err);

/* The end of a BpPrint with long content: flushes; BP_OK if everything was `written`, else BP_ERR_FILE with
 * the reason in errno and its remedy. */
BpStatus bp_print_end(FILE *out, bool written, BpError *err);

#endif
