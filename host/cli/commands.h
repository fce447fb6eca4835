/* commands.h: the commands of the program.
 *
 * In:    a checked command line.   Out: files, text on standard output, messages on standard error.
 * Knows: which commands there are.   Does not know: how the command line was written.
 *
 * A command returns its failure in `err` and prints no error itself: main does, and exits with the code that
 * belongs to the status. Results (a table, a document) go to standard output; progress and notes go to
 * standard error, and --quiet suppresses them. */
#ifndef BP_CLI_COMMANDS_H
#define BP_CLI_COMMANDS_H

#include "options.h"

typedef BpStatus BpCommandRun(const BpCommandLine *line, BpError *err);

typedef struct BpCommand {
    const char *name;
    const char *operands; /* "SCENE", as usage writes it */
    size_t operands_min, operands_max;
    const char *summary;     /* one line */
    const char *description; /* paragraphs, for `ballpark help NAME` */
    const char *examples;    /* complete command lines, each with a remark */
    unsigned bit;            /* of the sets of commands in option_list.h */
    bool is_shared;          /* several processes that a launcher starts carry it out together */
    BpCommandRun *run;
} BpCommand;

/* Every command, in the order of the help, and how many they are. */
extern const BpCommand bp_commands[];
extern const size_t bp_command_count;

/* The command of that name. BP_ERR_USAGE names the nearest. */
BpStatus bp_command_find(const char *name, const BpCommand **command, BpError *err);

BpCommandRun bp_command_render;   /* cmd_render.c */
BpCommandRun bp_command_explain;  /* cmd_explain.c */
BpCommandRun bp_command_check;    /* cmd_check.c */
BpCommandRun bp_command_cost;     /* cmd_cost.c */
BpCommandRun bp_command_merge;    /* cmd_merge.c */
BpCommandRun bp_command_bench;    /* cmd_bench.c */
BpCommandRun bp_command_devices;  /* cmd_devices.c */
BpCommandRun bp_command_generate; /* cmd_generate.c */
BpCommandRun bp_command_scene;    /* cmd_scene.c */
BpCommandRun bp_command_view;     /* cmd_view.c */
BpCommandRun bp_command_help;     /* help.c */

#endif
