/* command_text.h: a command line as text that a shell reads back.
 *
 * In:    the command line.   Out: "ballpark render scene.json --spp 64".
 * Knows: the options, quotes of shells.   Does not know: what the text is for. */
#ifndef BP_CLI_LINE_COMMAND_TEXT_H
#define BP_CLI_LINE_COMMAND_TEXT_H

#include "options.h"

#define BP_COMMAND_TEXT_SIZE 16384

/* The operands, then the options in the order of their list; --resume with `resume`, or left out where that
 * is NULL;
 * with `resume` there is no --no-clobber; --time with `seconds` unless that is 0. "" where `size` is too
 * small. Returns `text`. */
const char *bp_command_text(const BpCommandLine *line, const char *resume, double seconds, char *text,
                            size_t size);

#endif
