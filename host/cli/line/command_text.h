/* command_text.h: formats a command line so that it can be pasted into a shell.
 *
 * In:    the command line.   Out: "ballpark render scene.json --spp 64".
 * Knows: the options, quotes of shells.   Does not know: what the text is for. */
#ifndef BP_CLI_LINE_COMMAND_TEXT_H
#define BP_CLI_LINE_COMMAND_TEXT_H

#include "options.h"

#define BP_COMMAND_TEXT_SIZE 16384

/* The operands, then the options in the order of their list; --resume with `resume`, unless that is NULL;
 * then --no-clobber is left out; --time with `seconds` unless that is 0. "" if `size` is too small. Returns
 * `text`. */
const char *bp_command_text(const BpCommandLine *line, const char *resume, double seconds, char *text,
                            size_t size);

#endif
