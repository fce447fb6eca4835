/* command_table.h: the table of commands, with what the help and the parser need of each.
 *
 * In:    a name.   Out: a command: its texts, operands and bit.
 * Knows: the texts of all commands.   Does not know: what carries them out (cli/commands.h), which options
 * they take (option_list.h). */
#ifndef BP_CLI_LINE_COMMAND_TABLE_H
#define BP_CLI_LINE_COMMAND_TABLE_H

#include "base/status.h"

#include <stddef.h>

typedef struct BpCommand {
    const char *name;
    const char *operands; /* "SCENE", as usage writes it */
    size_t operands_min, operands_max;
    const char *summary;     /* one line */
    const char *description; /* paragraphs, for `ballpark help NAME` */
    const char *examples;    /* complete command lines, each with a remark */
    unsigned bit;            /* of the sets of commands in option_list.h */
    bool is_shared;          /* several processes that a launcher starts carry it out together */
} BpCommand;

/* Every command, in the order of the help, and their number. */
extern const BpCommand bp_commands[];
extern const size_t bp_command_count;

/* The command of that name. BP_ERR_USAGE names the nearest. */
BpStatus bp_command_find(const char *name, const BpCommand **command, BpError *err);

#endif
