/* output.h: the files that a command writes.
 *
 * In:    the command line, a path, what prints the content.   Out: the file, whole or not at all.
 * Knows: "-", --no-clobber, that overwriting is said.   Does not know: what is printed. */
#ifndef BP_CLI_OUTPUT_OUTPUT_H
#define BP_CLI_OUTPUT_OUTPUT_H

#include "base/output_file.h"
#include "cli/line/options.h"

/* Whether `path` can be written, found out before work begins: "-" can. With --no-clobber, a file that exists
 * is an error. */
BpStatus bp_line_check_output(const BpCommandLine *line, const char *path, BpError *err);

/* The same for what always has one format: a file of another `ending` (".json") is refused; `what` says why.
 * Devices and pipes have names of their own: /dev/stdout. */
BpStatus bp_line_check_named(const BpCommandLine *line, const char *path, const char *ending,
                             const char *what, BpError *err);

/* Says on standard error that the file `path` (NULL: none) will be overwritten, if it exists. To be called
 * when work begins, after everything that can be refused has been checked: a refused command overwrites
 * nothing. */
void bp_line_say_overwritten(const BpCommandLine *line, const char *path);

/* Writes `path` by `print`; "-" is standard output. With --no-clobber the name is claimed when the content is
 * complete: what has come to stand there in the meantime is not replaced. */
BpStatus bp_line_write(const BpCommandLine *line, const char *path, BpPrint *print, const void *what,
                       BpError *err);

/* The end of a BpPrint whose content may be long: BP_OK if all of it was `written` and left the buffer, else
 * BP_ERR_FILE with the reason in errno and its remedy. */
BpStatus bp_print_end(FILE *out, bool written, BpError *err);

#endif
