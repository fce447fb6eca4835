/* options.h: the command line, parsed and checked.
 *
 * In:    argc, argv.   Out: BpCommandLine; or an error that names the option and what it takes.
 * Knows: where options and operands may stand.
 * Does not know: scenes, devices, what a command does with its options (cli/commands.h), which options there
 * are (option_list.h). */
#ifndef BP_CLI_LINE_OPTIONS_H
#define BP_CLI_LINE_OPTIONS_H

#include "command_table.h"
#include "option_list.h"

typedef enum BpOption {
#define BP_OPTION_ENUM(number, ...) BP_OPTION_##number,
    BP_OPTION_LIST(BP_OPTION_ENUM, BP_OPTION_ENUM)
#undef BP_OPTION_ENUM
        BP_OPTION_NUMBER /* how many there are */
} BpOption;

#define BP_SAMPLE_NUMBERS ((uint64_t)1 << 32) /* sample numbers go from 0 to one below */
#define BP_SPP_MAX                                                                                           \
    ((uint64_t)1 << 26) /* BP_REPLICATE_SAMPLES_MAX in each replicate: then sums may overflow */

/* A pixel, counted from 0 at the picture's top left corner. */
typedef struct BpPixel {
    uint32_t x, y;
} BpPixel;

/* A range of frames as Python writes it: from `first` up to but without `last`, every `step`-th; below 0:
 * counted from the end. */
typedef struct BpSlice {
    int64_t first, last; /* last INT64_MAX: to the end */
    uint64_t step;
} BpSlice;

/* The first of `count` shares is number 1. */
typedef struct BpShare {
    uint32_t number, count;
} BpShare;

/* The values of an option that may be repeated, in order. */
enum { BP_TEXTS_MAX = 256 };
typedef struct BpTexts {
    const char *list[BP_TEXTS_MAX];
    size_t count;
} BpTexts;

/* The command line as parsed: a member for each option, as option_list.h declares it. Every member is
 * checked; one whose option was not given is 0, NULL or the enumeration's first value, and bp_option_given()
 * tells. Texts point into argv, or are static. */
typedef struct BpCommandLine {
    const BpCommand *command; /* NULL: `ballpark`, `ballpark --help`, `ballpark --version` */
    char **operands;          /* the arguments that are not options: scenes, files, names */
    size_t operand_count;
    struct BpComm *comm; /* the processes that carry out the command together; NULL: this one alone */
    bool given[BP_OPTION_NUMBER];
#define BP_OPTION_MEMBER(number, name, letter, commands, help, type, member, ...) type member;
    BP_OPTION_LIST(BP_OPTION_MEMBER, BP_OPTION_MEMBER)
#undef BP_OPTION_MEMBER
} BpCommandLine;

static inline bool bp_option_given(const BpCommandLine *line, BpOption option) {
    return line->given[option];
}

/* Parses and checks. BP_ERR_USAGE names the option at fault, what was found, what is expected; a command or
 * an option that does not exist comes with the most similar one; a file used for two things names both uses.
 * Nothing to release. `argv` is reordered: operands come last, and the result points into it. */
BpStatus bp_command_line_parse(int argc, char **argv, BpCommandLine *line, BpError *err);

#endif
