/* options.c: see options.h. */
#include "commands.h"
#include "file_conflicts.h"

#include "base/names.h"
#include "film/film.h"
#include "image/image.h"
#include "option_table.h"
#include "values.h"

#include <getopt.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define COUNT_OF(array) (sizeof(array) / sizeof(array)[0])

_Static_assert(BP_SPP_MAX == (uint64_t)BP_REPLICATE_SAMPLES_MAX * BP_REPLICATES_DEFAULT, "the sums' limit");

/* One of the words of names.h; *choice: its place in the list. */
static BpStatus store_name(const char *name, const char *text, const char *const *words, unsigned *choice,
                           BpError *err) {
    size_t count = 0;
    while (words[count] != NULL) ++count;
    return bp_value_choice(name, text, words, count, choice, err);
}

/* Stores the value of `option`, whose written name (for messages) is `name`. */
static BpStatus store_value(BpOption option, const char *name, const char *text, BpCommandLine *line,
                            BpError *err) {
    uint64_t whole = 0;
    unsigned choice = 0;
    switch (option) {
    case BP_OPTION_OUTPUT:
        line->output = text;
        break;
    case BP_OPTION_SPP:
        return bp_value_whole(name, text, 1, BP_SPP_MAX, &line->spp, err);
    case BP_OPTION_ERROR:
        return bp_value_real(name, text, 0.0, 100.0, &line->error_percent, err);
    case BP_OPTION_TIME:
        return bp_value_real(name, text, 0.0, 1.0e7, &line->time_seconds, err);
    case BP_OPTION_WIDTH:
        BP_TRY(bp_value_whole(name, text, 1, BP_PICTURE_SIDE_MAX, &whole, err));
        line->width = (uint32_t)whole;
        break;
    case BP_OPTION_DEPTH:
        BP_TRY(bp_value_whole(name, text, 0, BP_DEPTH_MAX, &whole, err));
        line->depth = (uint32_t)whole;
        break;
    case BP_OPTION_SEED:
        return bp_value_whole(name, text, 0, UINT64_MAX, &line->seed, err);
    case BP_OPTION_FIRST_SAMPLE:
        return bp_value_whole(name, text, 0, BP_SAMPLE_NUMBERS - 1, &line->first_sample, err);
    case BP_OPTION_DEVICE:
        line->device = text;
        break;
    case BP_OPTION_PRECISION:
        BP_TRY(store_name(name, text, bp_precision_names, &choice, err));
        line->precision = (BpPrecision)choice;
        break;
    case BP_OPTION_MATH:
        BP_TRY(store_name(name, text, bp_math_names, &choice, err));
        line->math = (BpMath)choice;
        break;
    case BP_OPTION_NUMERICS:
        BP_TRY(store_name(name, text, bp_numerics_names, &choice, err));
        line->numerics = (BpNumerics)choice;
        break;
    case BP_OPTION_SAMPLER:
        BP_TRY(store_name(name, text, bp_sampler_names, &choice, err));
        line->sampler = (BpSampler)choice;
        break;
    case BP_OPTION_ADAPTIVE:
        line->adaptive = true;
        break;
    case BP_OPTION_EFFECTS: {
        static const char *const words[] = {"all"};
        BP_TRY(bp_value_choice(name, text, words, COUNT_OF(words), &choice, err));
        line->all_effects = true;
        break;
    }
    case BP_OPTION_KERNEL:
        BP_TRY(store_name(name, text, bp_kernel_names + BP_KERNEL_SAMPLE, &choice, err));
        line->kernel = (BpKernelForm)(BP_KERNEL_SAMPLE + choice);
        break;
    case BP_OPTION_TRANSFER:
        BP_TRY(store_name(name, text, bp_transfer_names, &choice, err));
        line->transfer = (BpTransfer)choice;
        break;
    case BP_OPTION_FORMAT:
        BP_TRY(store_name(name, text, bp_format_names, &choice, err));
        line->format = (BpFormat)choice;
        break;
    case BP_OPTION_ERROR_MAP:
        line->error_map = text;
        break;
    case BP_OPTION_STATS:
        line->stats = text;
        break;
    case BP_OPTION_MEASURE:
        line->measure = true;
        break;
    case BP_OPTION_PIXEL:
        return bp_value_pair(name, text, BP_PICTURE_SIDE_MAX - 1, &line->pixel_x, &line->pixel_y, err);
    case BP_OPTION_JSON:
        line->json = text;
        break;
    case BP_OPTION_CSV:
        line->csv = text;
        break;
    case BP_OPTION_MAP:
        line->map = text;
        break;
    case BP_OPTION_GRID:
        BP_TRY(bp_value_whole(name, text, 0, 5000, &whole, err));
        line->grid = (unsigned)whole;
        break;
    case BP_OPTION_COUNT:
        return bp_value_whole(name, text, 1, BP_SPHERES_MAX, &line->count, err);
    case BP_OPTION_ROUNDS:
        BP_TRY(bp_value_whole(name, text, 1, 1000, &whole, err));
        line->rounds = (uint32_t)whole;
        break;
    case BP_OPTION_EDITION: {
        static const char *const words[] = {"1", "3", "3rust", "4"};
        BP_TRY(bp_value_choice(name, text, words, COUNT_OF(words), &choice, err));
        line->edition = words[choice];
        break;
    }
    case BP_OPTION_FORCE:
        line->force = true;
        break;
    case BP_OPTION_QUIET:
        line->quiet = true;
        break;
    case BP_OPTION_HELP:
        line->help = true;
        break;
    case BP_OPTION_VERSION:
        line->version = true;
        break;
    case BP_OPTION_NUMBER:
        break;
    }
    return BP_OK;
}

/* "render, check" for the commands that take `option`. */
static void list_takers(BpOption option, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (size_t c = 0; c < bp_command_count && used < size; ++c)
        if ((bp_commands[c].options >> option & 1u) != 0)
            used += (size_t)snprintf(text + used, size - used, "%s%s", used == 0 ? "" : ", ",
                                     bp_commands[c].name);
}

static BpStatus fail_unknown_option(const BpCommandLine *line, const char *found, BpError *err) {
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(found, "="), found);
    const char *nearest = bp_option_nearest(name, line->command);
    const char *command = line->command != NULL ? line->command->name : NULL;
    const char *blank = command != NULL ? " " : "";
    if (command == NULL) command = "";
    if (nearest != NULL)
        return bp_fail(err, BP_ERR_USAGE, "unknown option %s; did you mean --%s? (see `ballpark help%s%s`)",
                       name, nearest, blank, command);
    return bp_fail(err, BP_ERR_USAGE, "unknown option %s; see `ballpark help%s%s`", name, blank, command);
}

static BpStatus check_taken(const BpCommandLine *line, BpOption option, const char *name, BpError *err) {
    const uint64_t common = (uint64_t)1 << BP_OPTION_HELP;
    const uint64_t top = common | (uint64_t)1 << BP_OPTION_VERSION;
    const uint64_t taken = line->command == NULL ? top : line->command->options | common;
    if ((taken >> option & 1u) != 0) return BP_OK;
    char takers[160];
    list_takers(option, takers, sizeof takers);
    if (line->command == NULL)
        return bp_fail(err, BP_ERR_USAGE, "%s must follow a command: ballpark %.*s ... %s", name,
                       (int)strcspn(takers, ","), takers, name);
    if (takers[0] == '\0')
        return bp_fail(err, BP_ERR_USAGE,
                       "ballpark %s: unsupported option %s; use it without a command: ballpark %s",
                       line->command->name, name, name);
    return bp_fail(err, BP_ERR_USAGE, "ballpark %s: unsupported option %s; it belongs to %s",
                   line->command->name, name, takers);
}

static BpStatus check_operands(const BpCommandLine *line, BpError *err) {
    const BpCommand *command = line->command;
    if (line->operand_count < command->operands_min)
        return bp_fail(err, BP_ERR_USAGE, "ballpark %s: missing %s; see `ballpark help %s`", command->name,
                       command->operands, command->name);
    if (line->operand_count > command->operands_max) {
        const char *extra = line->operands[command->operands_max];
        if (command->operands_max == 0)
            return bp_fail(err, BP_ERR_USAGE,
                           "ballpark %s: unexpected argument \"%.200s\"; expected only options",
                           command->name, extra);
        return bp_fail(err, BP_ERR_USAGE, "ballpark %s: unexpected argument \"%.200s\"; expected one %s only",
                       command->name, extra, command->operands);
    }
    size_t from_input = 0;
    for (size_t i = 0; i < line->operand_count; ++i) {
        if (line->operands[i][0] == '\0')
            return bp_fail(err, BP_ERR_USAGE, "ballpark %s: expected %s, found an empty name", command->name,
                           command->operands);
        from_input += strcmp(line->operands[i], "-") == 0;
    }
    if (from_input > 1)
        return bp_fail(err, BP_ERR_USAGE, "ballpark %s: \"-\" (standard input) can be given only once",
                       command->name);
    return BP_OK;
}

BpStatus bp_command_line_parse(int argc, char **argv, BpCommandLine *line, BpError *err) {
    memset(line, 0, sizeof *line);
    /* The command comes first, so that it says which options may follow. */
    if (argc >= 2 && argv[1][0] != '-') {
        BP_TRY(bp_command_find(argv[1], &line->command, err));
        argv[1] = argv[0];
        ++argv;
        --argc;
    }
    struct option long_options[BP_OPTION_NUMBER + 1];
    char letters[2 + 2 * BP_OPTION_NUMBER + 1] =
        ":"; /* ':': a missing value is told from an unknown option */
    bp_option_getopt_tables(long_options, letters);

    opterr = 0;
    optind = 0; /* glibc: start anew, with all its state */
    for (;;) {
        const int result = getopt_long(argc, argv, letters, long_options, NULL);
        if (result == -1) break;
        /* An unknown letter is told by optopt: it may stand amid others ("-qx"). A long option that is at
         * fault stands just before optind. */
        if (result == '?' && optopt > 0 && optopt < BP_OPTION_LONG) {
            const char name[3] = {'-', (char)optopt, '\0'};
            return fail_unknown_option(line, name, err);
        }
        const char *found = argv[optind - 1];
        if (result == '?' && optopt >= BP_OPTION_LONG)
            return bp_fail(err, BP_ERR_USAGE, "--%s takes no value, found \"%.200s\"",
                           bp_option_name((BpOption)(optopt - BP_OPTION_LONG)), found);
        if (result == '?') return fail_unknown_option(line, found, err);
        const BpOption option = bp_option_of_result(result == ':' ? optopt : result);
        char name[32];
        snprintf(name, sizeof name, "--%s", bp_option_name(option));
        BP_TRY(check_taken(line, option, name, err));
        if (result == ':')
            return bp_fail(err, BP_ERR_USAGE, "%s needs a value: %s %s", name, name,
                           bp_option_metavar(option));
        if (optarg != NULL && optarg[0] == '\0')
            return bp_fail(err, BP_ERR_USAGE, "%s needs a value (%s), found an empty one", name,
                           bp_option_metavar(option));
        BP_TRY(store_value(option, name, optarg, line, err));
        line->given |= (uint64_t)1 << option;
    }
    line->operands = argv + optind;
    line->operand_count = (size_t)(argc - optind);
    if (line->help || line->version) return BP_OK;
    if (line->command == NULL)
        return bp_fail(err, BP_ERR_USAGE,
                       "missing command; see `ballpark --help`, or begin with `ballpark render SCENE`");
    BP_TRY(check_operands(line, err));
    return bp_file_conflicts_check(line, NULL, err);
}
