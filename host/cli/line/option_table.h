/* option_table.h: the properties of each option of the list (option_list.h), and the parsing of its value.
 *
 * In:    an option, the text of its value.   Out: its texts, getopt's tables, the value in BpCommandLine.
 * Knows: how each kind of value is parsed and printed.
 * Does not know: which options there are (option_list.h), what commands do with them. */
#ifndef BP_CLI_LINE_OPTION_TABLE_H
#define BP_CLI_LINE_OPTION_TABLE_H

#include "options.h"

#include <getopt.h>

/* getopt_long returns BP_OPTION_LONG + option for the long name of an option without a letter. */
enum { BP_OPTION_LONG = 256 };

const char *bp_option_name(BpOption option); /* "spp" */
/* Writes the help of the option for `command`, with its default, to `text`; returns `text`. */
const char *bp_option_help(BpOption option, const BpCommand *command, char *text, size_t size);
char bp_option_letter(BpOption option); /* 'o', or 0 */

/* The name of the value in the help, written to `text`, which is returned: "N", "robust|plain"; "" for a
 * flag. */
const char *bp_option_metavar(BpOption option, char *text, size_t size);

/* The words that the option accepts, ending with NULL; NULL: its value is not a word. */
const char *const *bp_option_words(BpOption option);

/* Whether the command accepts the option. No command lists --help and --version. */
bool bp_option_taken(BpOption option, const BpCommand *command);

/* The file that a BP_RESULT option names; NULL: it was not given, or is of another kind. */
const char *bp_option_result(BpOption option, const BpCommandLine *line);

/* Parses `text` (NULL for a flag) into the option's member of `line`, and marks it as given. BP_ERR_USAGE
 * names the option, the text and the expected value. */
BpStatus bp_option_store(BpOption option, const char *text, BpCommandLine *line, BpError *err);

/* Writes the value of a given option in a form that the command line accepts; "" for a flag. */
void bp_option_show(BpOption option, const BpCommandLine *line, char *text, size_t size);

/* Fills getopt's tables: `letters` is appended to. Room: BP_OPTION_NUMBER + 1 options, 2 letters each. */
void bp_option_getopt_tables(struct option *long_options, char *letters);
BpOption bp_option_of_result(int getopt_result);

/* The option nearest to `written` ("--widht") among those that `command` takes (NULL: any command), without
 * dashes; NULL when none is near. Static. */
const char *bp_option_nearest(const char *written, const BpCommand *command);

#endif
