/* cmd_help.c: `ballpark help`: texts made from the tables of commands and options. */
#include "commands.h"

#include "base/wrap.h"
#include "cli/line/option_table.h"
#include "cli/terminal/terminal.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS_MAX = 80, OPTION_COLUMNS = 28, COMMAND_COLUMNS = 11 }; /* longer lines are hard to read */

static void print_option(BpOption option, const BpCommand *command, FILE *out) {
    char left[128], metavar[80], help[512];
    const char letter = bp_option_letter(option);
    bp_option_metavar(option, metavar, sizeof metavar);
    char short_form[8] = "    ";
    if (letter != 0) snprintf(short_form, sizeof short_form, "-%c, ", letter);
    const int length = snprintf(left, sizeof left, "  %s--%s%s%s", short_form, bp_option_name(option),
                                metavar[0] != '\0' ? " " : "", metavar);
    if (length >= OPTION_COLUMNS)
        fprintf(out, "%s\n%*s", left, OPTION_COLUMNS, "");
    else
        fprintf(out, "%-*s", OPTION_COLUMNS, left);
    fprintf(out, BP_HANG "%s\n", bp_option_help(option, command, help, sizeof help));
}

/* Examples are complete command lines with remarks, already laid out. */
static void print_command_help(const BpCommand *command, FILE *out) {
    fprintf(out, "Usage: ballpark %s%s%s [OPTION]...\n\n", command->name,
            command->operands[0] != '\0' ? " " : "", command->operands);
    for (const char *at = command->description; *at != '\0'; at += *at == '\n') {
        const size_t length = strcspn(at, "\n");
        fprintf(out, BP_HANG "%.*s\n", (int)length, at);
        at += length;
    }
    fprintf(out, "\nOptions:\n");
    for (int o = 0; o < BP_OPTION_NUMBER; ++o)
        if (bp_option_taken((BpOption)o, command)) print_option((BpOption)o, command, out);
    if (command->examples[0] != '\0') fprintf(out, "\nExamples:\n%s", command->examples);
}

static void print_program_help(FILE *out) {
    fprintf(out, "Ballpark renders scenes of spheres on any OpenCL device, and reports how much\n"
                 "noise is left in the picture.\n\n"
                 "Usage: ballpark COMMAND [OPTION]...\n\n"
                 "Commands:\n");
    for (size_t c = 0; c < bp_command_count; ++c) {
        fprintf(out, "  %-*s" BP_HANG "%s\n", COMMAND_COLUMNS, bp_commands[c].name, bp_commands[c].summary);
    }
    fprintf(out, "\n`ballpark help COMMAND` explains a command, with its options and examples.\n"
                 "`ballpark --version` prints version and commit.\n\n"
                 "To begin:\n"
                 "  ballpark devices                        list the devices of this computer\n"
                 "  ballpark generate cover -o cover.json   write the book's cover scene\n"
                 "  ballpark render cover.json              render it to cover.png\n\n"
                 "Exit codes: 0 success; 1 failure at run time (device, memory, file, invalid\n"
                 "samples in a picture); 2 invalid command line or scene; 130 interrupted. Of\n"
                 "check also: 3 disagreement; 4 not enough evidence; 5 no such device; 6 a device\n"
                 "or its driver failed.\n");
}

/* Whole sentences are easiest to read in 80 columns, also on a wide terminal, unless --wide is given. */
static size_t page_columns(const BpCommandLine *line) {
    if (line->wide) return 0;
    const size_t columns = bp_terminal_width(fileno(stdout));
    return columns < COLUMNS_MAX ? columns : COLUMNS_MAX;
}

BpStatus bp_help_print(const BpCommandLine *line, const BpCommand *command, BpError *err) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (out == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the help");
    if (command != NULL)
        print_command_help(command, out);
    else
        print_program_help(out);
    if (fclose(out) == 0) bp_wrap(text, page_columns(line), stdout);
    free(text);
    if (fflush(stdout) != 0 || ferror(stdout))
        return bp_fail(err, BP_ERR_FILE, "cannot write to standard output: %s", strerror(errno));
    return BP_OK;
}

BpStatus bp_command_help(const BpCommandLine *line, BpError *err) {
    const BpCommand *command = NULL;
    if (line->operand_count == 1) BP_TRY(bp_command_find(line->operands[0], &command, err));
    return bp_help_print(line, command, err);
}
