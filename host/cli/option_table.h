/* option_table.h: the table of all options: name, value, help text.
 *
 * In:    an option.   Out: its texts, getopt's tables.
 * Knows: names, letters and help texts.   Does not know: what values are allowed (options.h), the commands'
 * work. */
#ifndef BP_CLI_OPTION_TABLE_H
#define BP_CLI_OPTION_TABLE_H

#include "commands.h"

#include <getopt.h>

/* getopt_long returns BP_OPTION_LONG + option for the long name of an option without a letter. */
enum { BP_OPTION_LONG = 256 };

const char *bp_option_name(BpOption option);    /* "spp" */
const char *bp_option_metavar(BpOption option); /* "N"; "" for a switch */
const char *bp_option_help(BpOption option);    /* a line or two */
char bp_option_letter(BpOption option);         /* 'o', or 0 */

/* Fills getopt's tables: `letters` is appended to. Room: BP_OPTION_NUMBER + 1 options, 2 letters each. */
void bp_option_getopt_tables(struct option *long_options, char *letters);
BpOption bp_option_of_result(int getopt_result);

/* The option nearest to `written` ("--widht") among those that `command` takes (NULL: any command), without
 * dashes; NULL when none is near. Static. */
const char *bp_option_nearest(const char *written, const BpCommand *command);

#endif
