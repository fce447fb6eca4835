/* help.c: the help texts, made from the tables of commands and options. See options.h. */
#include "commands.h"

#include "option_table.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

enum { TEXT_COLUMNS = 80, OPTION_COLUMNS = 28, COMMAND_COLUMNS = 11 };

/* Prints `text` in lines of at most TEXT_COLUMNS from column `indent`, where the cursor already is. */
static void print_wrapped(const char *text, size_t indent) {
    size_t column = indent;
    while (*text != '\0') {
        size_t word = strcspn(text, " \n");
        if (text[word] == ' ' && text[word + 1] == '%')
            word += 1 + strcspn(text + word + 1, " \n"); /* "5 %" */
        if (column > indent && column + 1 + word > TEXT_COLUMNS) {
            printf("\n%*s", (int)indent, "");
            column = indent;
        } else if (column > indent) {
            putchar(' ');
            ++column;
        }
        printf("%.*s", (int)word, text);
        column += word;
        text += word;
        if (*text == '\n') {
            printf("\n%*s", (int)indent, "");
            column = indent;
        }
        if (*text != '\0') ++text;
    }
    putchar('\n');
}

static void print_option(BpOption option) {
    char left[128], metavar[80];
    const char letter = bp_option_letter(option);
    bp_option_metavar(option, metavar, sizeof metavar);
    char short_form[8] = "    ";
    if (letter != 0) snprintf(short_form, sizeof short_form, "-%c, ", letter);
    const int length = snprintf(left, sizeof left, "  %s--%s%s%s", short_form, bp_option_name(option),
                                metavar[0] != '\0' ? " " : "", metavar);
    if (length >= OPTION_COLUMNS)
        printf("%s\n%*s", left, OPTION_COLUMNS, "");
    else
        printf("%-*s", OPTION_COLUMNS, left);
    print_wrapped(bp_option_help(option), OPTION_COLUMNS);
}

static void print_command_help(const BpCommand *command) {
    printf("Usage: ballpark %s%s%s%s\n\n", command->name, command->operands[0] != '\0' ? " " : "",
           command->operands, command->bit != 0 ? " [OPTION]..." : "");
    print_wrapped(command->description, 0);
    if (command->bit != 0) printf("\nOptions:\n");
    for (int o = 0; o < BP_OPTION_NUMBER; ++o)
        if (bp_option_taken((BpOption)o, command)) print_option((BpOption)o);
    if (command->examples[0] != '\0') printf("\nExamples:\n%s", command->examples);
}

static void print_program_help(void) {
    printf("Ballpark renders scenes of spheres on any OpenCL device, and reports how much\n"
           "noise is left in the picture.\n\n"
           "Usage: ballpark COMMAND [OPTION]...\n\n"
           "Commands:\n");
    for (size_t c = 0; c < bp_command_count; ++c) {
        printf("  %-*s", COMMAND_COLUMNS, bp_commands[c].name);
        print_wrapped(bp_commands[c].summary, 2 + COMMAND_COLUMNS);
    }
    printf("\n`ballpark help COMMAND` explains a command, with its options and examples.\n"
           "`ballpark --version` prints version and commit.\n\n"
           "To begin:\n"
           "  ballpark devices                        list the devices of this computer\n"
           "  ballpark generate cover -o cover.json   write the book's cover scene\n"
           "  ballpark render cover.json              render it to cover.png\n\n"
           "Exit codes: 0 success; 1 failure at run time (device, memory, file); 2 invalid\n"
           "command line or scene; 130 interrupted. Of check also: 3 disagreement; 4 not\n"
           "enough evidence; 5 no such device; 6 a device or its driver failed.\n");
}

BpStatus bp_help_print(const BpCommand *command, BpError *err) {
    if (command != NULL)
        print_command_help(command);
    else
        print_program_help();
    if (fflush(stdout) != 0 || ferror(stdout))
        return bp_fail(err, BP_ERR_FILE, "cannot write the help to standard output: %s", strerror(errno));
    return BP_OK;
}

BpStatus bp_command_help(const BpCommandLine *line, BpError *err) {
    const BpCommand *command = NULL;
    if (line->operand_count == 1) BP_TRY(bp_command_find(line->operands[0], &command, err));
    return bp_help_print(command, err);
}
