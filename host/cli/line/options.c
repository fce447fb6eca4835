/* options.c: see options.h. */
#include "options.h"

#include "file_conflicts.h"
#include "film/film.h"
#include "option_table.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

_Static_assert(BP_SPP_MAX == (uint64_t)BP_REPLICATE_SAMPLES_MAX * BP_REPLICATES_DEFAULT, "the sums' limit");

/* "render, check" for the commands that take `option`. */
static void list_commands(BpOption option, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (size_t c = 0; c < bp_command_count && used < size; ++c)
        if (bp_option_taken(option, &bp_commands[c]))
            used += (size_t)snprintf(text + used, size - used, "%s%s", used == 0 ? "" : ", ",
                                     bp_commands[c].name);
}

/* Advice for an option of other renderers, or with an earlier name; NULL for others, and if the command does
 * not accept its equivalent. */
static const char *instead_of(const char *name, const BpCommand *command) {
    static const char shape[] =
        "the height follows from --width and the scene's \"aspect_ratio\" or \"image_height\"";
    static const struct {
        const char *name, *instead;
        BpOption option;
    } foreign[] = {{"--height", shape, BP_OPTION_WIDTH},
                   {"--size", shape, BP_OPTION_WIDTH},
                   {"--resolution", shape, BP_OPTION_WIDTH},
                   {"--samples", "--spp sets the samples per pixel", BP_OPTION_SPP},
                   {"--out", "--output names the file", BP_OPTION_OUTPUT},
                   {"--gpu", "--device gpu chooses one", BP_OPTION_DEVICE},
                   {"--cpu", "--device cpu chooses it", BP_OPTION_DEVICE},
                   {"--lamps", "--lamps is now --light-sampling", BP_OPTION_LIGHT_SAMPLING},
                   {"--light", "--light is now --lighting", BP_OPTION_LIGHTING}};
    for (size_t i = 0; i < sizeof foreign / sizeof *foreign && command != NULL; i++)
        if (strcmp(name, foreign[i].name) == 0 && bp_option_taken(foreign[i].option, command))
            return foreign[i].instead;
    return NULL;
}

static BpStatus fail_unknown_option(const BpCommandLine *line, const char *found, BpError *err) {
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(found, "="), found);
    const char *nearest = bp_option_nearest(name, line->command);
    const char *command = line->command != NULL ? line->command->name : NULL;
    const char *blank = command != NULL ? " " : "";
    if (command == NULL) command = "";
    const char *const instead = instead_of(name, line->command);
    if (instead != NULL)
        return bp_fail(err, BP_ERR_USAGE, "unknown option %s; %s (see `ballpark help%s%s`)", name, instead,
                       blank, command);
    if (nearest != NULL)
        return bp_fail(err, BP_ERR_USAGE, "unknown option %s; did you mean --%s? (see `ballpark help%s%s`)",
                       name, nearest, blank, command);
    return bp_fail(err, BP_ERR_USAGE, "unknown option %s; see `ballpark help%s%s`", name, blank, command);
}

static BpStatus check_taken(const BpCommandLine *line, BpOption option, const char *name, BpError *err) {
    if (option == BP_OPTION_HELP) return BP_OK;
    if (line->command == NULL ? option == BP_OPTION_VERSION : bp_option_taken(option, line->command))
        return BP_OK;
    char commands[160];
    list_commands(option, commands, sizeof commands);
    if (line->command == NULL)
        return bp_fail(err, BP_ERR_USAGE, "%s must follow a command: ballpark %.*s ... %s", name,
                       (int)strcspn(commands, ","), commands, name);
    if (commands[0] == '\0')
        return bp_fail(err, BP_ERR_USAGE,
                       "ballpark %s: unsupported option %s; use it without a command: ballpark %s",
                       line->command->name, name, name);
    return bp_fail(err, BP_ERR_USAGE, "ballpark %s: unsupported option %s; it belongs to %s",
                   line->command->name, name, commands);
}

static BpStatus check_operands(const BpCommandLine *line, BpError *err) {
    const BpCommand *command = line->command;
    /* One of "SCENE..." is a SCENE. */
    const char *dots = strstr(command->operands, "...");
    const int length = dots != NULL ? (int)(dots - command->operands) : (int)strlen(command->operands);
    if (line->operand_count < command->operands_min)
        return bp_fail(err, BP_ERR_USAGE, "ballpark %s: missing %.*s; see `ballpark help %s`", command->name,
                       length, command->operands, command->name);
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
            return bp_fail(err, BP_ERR_USAGE, "ballpark %s: expected %.*s, found an empty name",
                           command->name, length, command->operands);
        from_input += strcmp(line->operands[i], "-") == 0;
    }
    if (from_input > 1)
        return bp_fail(err, BP_ERR_USAGE, "ballpark %s: \"-\" (standard input) can be given only once",
                       command->name);
    return BP_OK;
}

BpStatus bp_command_line_parse(int argc, char **argv, BpCommandLine *line, BpError *err) {
    memset(line, 0, sizeof *line);
    /* The command comes first, since it determines the options that may follow. */
    if (argc >= 2 && argv[1][0] != '-') {
        BP_TRY(bp_command_find(argv[1], &line->command, err));
        argv[1] = argv[0];
        ++argv;
        --argc;
    }
    struct option long_options[BP_OPTION_NUMBER + 1];
    char letters[2 + 2 * BP_OPTION_NUMBER + 1] =
        ":"; /* ':': distinguishes a missing value from an unknown option */
    bp_option_getopt_tables(long_options, letters);

    opterr = 0;
    optind = 0; /* glibc: start anew, with all its state */
    for (;;) {
        const int result = getopt_long(argc, argv, letters, long_options, NULL);
        if (result == -1) break;
        /* An unknown letter is in optopt, since it may stand amid others ("-qx"). A faulty long option stands
         * just before optind. */
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
        char name[32], metavar[80];
        snprintf(name, sizeof name, "--%s", bp_option_name(option));
        bp_option_metavar(option, metavar, sizeof metavar);
        BP_TRY(check_taken(line, option, name, err));
        if (result == ':') return bp_fail(err, BP_ERR_USAGE, "%s needs a value: %s %s", name, name, metavar);
        if (optarg != NULL && optarg[0] == '\0')
            return bp_fail(err, BP_ERR_USAGE, "%s needs a value (%s), found an empty one", name, metavar);
        BP_TRY(bp_option_store(option, optarg, line, err));
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
