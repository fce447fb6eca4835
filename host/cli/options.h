/* options.h: the command line, parsed and checked.
 *
 * In:    argc, argv.   Out: BpCommandLine; or an error that names the option and what it takes.
 * Knows: the values that each option takes.
 * Does not know: scenes, devices, what a command does with its options (commands.h), names and help texts of
 * options (option_table.h). */
#ifndef BP_CLI_OPTIONS_H
#define BP_CLI_OPTIONS_H

#include "base/status.h"

typedef enum BpOption {
    BP_OPTION_OUTPUT,
    BP_OPTION_SPP,
    BP_OPTION_ERROR,
    BP_OPTION_TIME,
    BP_OPTION_WIDTH,
    BP_OPTION_DEPTH,
    BP_OPTION_SEED,
    BP_OPTION_FIRST_SAMPLE,
    BP_OPTION_DEVICE,
    BP_OPTION_PRECISION,
    BP_OPTION_MATH,
    BP_OPTION_NUMERICS,
    BP_OPTION_SAMPLER,
    BP_OPTION_ADAPTIVE,
    BP_OPTION_EFFECTS,
    BP_OPTION_KERNEL,
    BP_OPTION_TRANSFER,
    BP_OPTION_FORMAT,
    BP_OPTION_ERROR_MAP,
    BP_OPTION_STATS,
    BP_OPTION_FORCE,
    BP_OPTION_MEASURE,
    BP_OPTION_PIXEL,
    BP_OPTION_JSON,
    BP_OPTION_CSV,
    BP_OPTION_MAP,
    BP_OPTION_GRID,
    BP_OPTION_COUNT,
    BP_OPTION_EDITION,
    BP_OPTION_ROUNDS,
    BP_OPTION_QUIET,
    BP_OPTION_HELP,
    BP_OPTION_VERSION,
    BP_OPTION_NUMBER /* how many there are */
} BpOption;

#define BP_SAMPLE_NUMBERS ((uint64_t)1 << 32) /* sample numbers go from 0 to one below */
#define BP_SPP_MAX                                                                                           \
    ((uint64_t)1 << 26) /* BP_REPLICATE_SAMPLES_MAX in each replicate: then sums may overflow */

/* What the command line says. Every member is checked; a member whose option was not given is 0, NULL or the
 * enum's first value, and bp_option_given() tells. Texts point into argv. */
typedef struct BpCommandLine {
    const struct BpCommand *command; /* NULL: `ballpark`, `ballpark --help`, `ballpark --version` */
    char **operands;                 /* the arguments that are not options: scenes, files, names */
    size_t operand_count;
    uint64_t given;       /* bit o: option o was given */
    const char *output;   /* -o; "-": standard output */
    uint64_t spp;         /* samples per pixel, 1 .. BP_SPP_MAX */
    double error_percent; /* (0, 100] */
    double time_seconds;  /* (0, 1e7] */
    uint32_t width;       /* pixels, 1 .. BP_PICTURE_SIDE_MAX */
    uint32_t depth;       /* ray segments, 0 .. BP_DEPTH_MAX */
    uint64_t seed;
    uint64_t first_sample; /* 0 .. 2^32 - 1 */
    const char *device;    /* as written: a number, a name, "all" */
    BpPrecision precision;
    BpMath math;
    BpNumerics numerics;
    BpSampler sampler;
    bool all_effects, adaptive;
    BpKernelForm kernel;
    BpTransfer transfer;
    BpFormat format;
    const char *error_map; /* file for --error-map */
    const char *stats;     /* file for --stats */
    bool measure;
    uint32_t pixel_x, pixel_y; /* --pixel, from the picture's top left corner, from 0 */
    const char *json;          /* file; "-": standard output */
    const char *csv;           /* file; "-": standard output */
    const char *map;           /* picture file */
    unsigned grid;
    uint64_t count;
    uint32_t rounds;     /* of bench, 1 .. 1000 */
    const char *edition; /* "1", "3", "3rust" or "4" */
    bool force, quiet, help, version;
} BpCommandLine;

static inline bool bp_option_given(const BpCommandLine *line, BpOption option) {
    return (line->given >> option & 1u) != 0;
}

/* Parses and checks. BP_ERR_USAGE names the option at fault, what was found, what is expected; a command or
 * an option that does not exist comes with the most similar one; a file used for two things names both uses.
 * Nothing to release. `argv` is reordered: operands come last, and the result points into it. */
BpStatus bp_command_line_parse(int argc, char **argv, BpCommandLine *line, BpError *err);

/* The help of the whole program (`command` NULL) or of one command, on standard output. BP_ERR_FILE if that
 * cannot be written. */
BpStatus bp_help_print(const struct BpCommand *command, BpError *err);

#endif
