/* options.h: the command line, parsed and checked.
 *
 * In:    argc, argv.   Out: BpCommandLine; or an error that names the option and the values it accepts.
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

/* A range of frames as in Python: every `step`-th from `first` up to, but not including, `last`; negative
 * numbers count from the end. */
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
 * checked; one whose option was not given (bp_option_given()) is 0, NULL or the enumeration's first value.
 * Texts point into argv, or are static. */
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

/* Parses and checks. BP_ERR_USAGE names the option at fault, the text and the expected value; for an unknown
 * command or option, the most similar one; for a file with two uses, both. Nothing to release. `argv` is
 * reordered: operands come last, and the result points into it. */
BpStatus bp_command_line_parse(int argc, char **argv, BpCommandLine *line, BpError *err);

#endif
