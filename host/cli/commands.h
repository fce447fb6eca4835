/* commands.h: the commands of the program.
 *
 * In:    a checked command line.   Out: files, text on standard output, messages on standard error.
 * Knows: which function carries out each command.   Does not know: how the command line was parsed.
 *
 * A command returns its failure in `err` and prints no error itself: main does, and exits with the code that
 * belongs to the status. Results (a table, a document) go to standard output; progress and notes go to
 * standard error, and --quiet suppresses them. */
#ifndef BP_CLI_COMMANDS_H
#define BP_CLI_COMMANDS_H

#include "cli/line/command_table.h"
#include "cli/line/options.h"

typedef BpStatus BpCommandRun(const BpCommandLine *line, BpError *err);

/* Carries out the command of `line`, which has one. */
BpCommandRun bp_command_run;

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
BpCommandRun bp_command_help;     /* cmd_help.c */

/* The help of the whole program (`command` NULL) or of one command, on standard output, in lines that fit
 * unless `line` has --wide. BP_ERR_FILE if that cannot be written. */
BpStatus bp_help_print(const BpCommandLine *line, const BpCommand *command, BpError *err);

#endif
