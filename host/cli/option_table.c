/* option_table.c: see option_table.h. */
#include "option_table.h"

#include "base/message_text.h"

#include <stdio.h>
#include <string.h>

typedef struct OptionRow {
    const char *name, *metavar, *help;
    char letter;
} OptionRow;

static const OptionRow rows[BP_OPTION_NUMBER] = {
    [BP_OPTION_OUTPUT] = {"output", "FILE", "where the result goes; \"-\" is standard output", 'o'},
    [BP_OPTION_SPP] = {"spp", "N", "samples per pixel (default: render: the scene's number, check: 1024)", 0},
    [BP_OPTION_ERROR] = {"error", "PERCENT", "stop when the noise of the picture (NRMSE) is below PERCENT",
                         0},
    [BP_OPTION_TIME] = {"time", "SECONDS",
                        "time budget: stop after SECONDS (default: cost 60, bench 5 per scene)", 0},
    [BP_OPTION_WIDTH] = {"width", "N", "width of the picture in pixels; the aspect ratio stays", 0},
    [BP_OPTION_DEPTH] = {"depth", "N",
                         "maximum number of ray segments per path; 0: black, 1: only sky and lamps", 0},
    [BP_OPTION_SEED] = {"seed", "N", "random seed, 64 bits, decimal or 0x...", 0},
    [BP_OPTION_FIRST_SAMPLE] =
        {"first-sample", "N",
         "number of the first sample, for renders to be merged; explain: which sample to follow", 0},
    [BP_OPTION_DEVICE] = {"device", "N|NAME|all",
                          "device number, part of its name, gpu, cpu or all (see `ballpark devices`)", 0},
    [BP_OPTION_PRECISION] = {"precision", "single|double",
                             "floating-point precision of the kernel (default: single)", 0},
    [BP_OPTION_MATH] = {"math", "strict|fast", "fast: the compiler may round differently (default: strict)",
                        0},
    [BP_OPTION_NUMERICS] = {"numerics", "robust|plain",
                            "plain: faster, wrong at extreme scales (default: robust)", 0},
    [BP_OPTION_SAMPLER] = {"sampler", "sobol|independent",
                           "sample sequence (default: sobol, less noise; bench: independent)", 0},
    [BP_OPTION_ADAPTIVE] = {"adaptive", "",
                            "give noisy pixels more samples and the others fewer; --spp is then the mean", 0},
    [BP_OPTION_EFFECTS] = {"effects", "all", "compile all effects, even unused ones", 0},
    [BP_OPTION_KERNEL] = {"kernel", "sample|packet", "kernel variant; does not change the picture", 0},
    [BP_OPTION_TRANSFER] = {"transfer", "gamma2|srgb|linear",
                            "tone curve of 8-bit output (default: the scene's)", 0},
    [BP_OPTION_FORMAT] = {"format", "FORMAT",
                          "png, ppm, ppm-ascii, pfm, exr or bpa (default: by the ending of FILE)", 0},
    [BP_OPTION_ERROR_MAP] = {"error-map", "FILE.png", "write a heat map of each pixel's error", 0},
    [BP_OPTION_STATS] = {"stats", "FILE",
                         "write times, counts and noise as JSON; \"-\" is standard output; a seed of 2^63 or "
                         "more is a string",
                         0},
    [BP_OPTION_FORCE] = {"force", "", "render even if the device fails its self-test", 0},
    [BP_OPTION_MEASURE] = {"measure", "", "measure what each effect costs", 0},
    [BP_OPTION_PIXEL] = {"pixel", "X,Y", "follow one path of this pixel, step by step; 0,0 is top left", 0},
    [BP_OPTION_JSON] = {"json", "FILE", "write the result as JSON; \"-\" is standard output", 0},
    [BP_OPTION_CSV] = {"csv", "FILE", "write the points as CSV; \"-\" is standard output", 0},
    [BP_OPTION_MAP] = {"map", "FILE", "write a picture of where kernel and reference differ", 0},
    [BP_OPTION_GRID] = {"grid", "G", "half the side of the square of small spheres (default: 11)", 0},
    [BP_OPTION_COUNT] = {"count", "N", "number of spheres in a field (default: 1000000)", 0},
    [BP_OPTION_EDITION] = {"edition", "1|3|3rust|4", "edition of the book (default: 4)", 0},
    [BP_OPTION_ROUNDS] = {"rounds", "N", "how often each scene is measured (default: 5)", 0},
    [BP_OPTION_QUIET] = {"quiet", "", "print errors only", 'q'},
    [BP_OPTION_HELP] = {"help", "", "print this help", 'h'},
    [BP_OPTION_VERSION] = {"version", "", "print version and commit", 'V'},
};

const char *bp_option_name(BpOption option) {
    return rows[option].name;
}
const char *bp_option_metavar(BpOption option) {
    return rows[option].metavar;
}
const char *bp_option_help(BpOption option) {
    return rows[option].help;
}
char bp_option_letter(BpOption option) {
    return rows[option].letter;
}

void bp_option_getopt_tables(struct option *long_options, char *letters) {
    size_t used = strlen(letters);
    for (int o = 0; o < BP_OPTION_NUMBER; ++o) {
        const bool has_value = rows[o].metavar[0] != '\0';
        long_options[o] = (struct option){rows[o].name, has_value ? required_argument : no_argument, NULL,
                                          BP_OPTION_LONG + o};
        if (rows[o].letter != 0) {
            letters[used++] = rows[o].letter;
            if (has_value) letters[used++] = ':';
        }
    }
    long_options[BP_OPTION_NUMBER] = (struct option){NULL, 0, NULL, 0};
    letters[used] = '\0';
}

BpOption bp_option_of_result(int getopt_result) {
    if (getopt_result >= BP_OPTION_LONG) return (BpOption)(getopt_result - BP_OPTION_LONG);
    int option = 0;
    while (option < BP_OPTION_NUMBER - 1 && rows[option].letter != (char)getopt_result) ++option;
    return (BpOption)option;
}

const char *bp_option_nearest(const char *written, const BpCommand *command) {
    const char *names[BP_OPTION_NUMBER];
    size_t count = 0;
    for (int o = 0; o < BP_OPTION_NUMBER; ++o)
        if (o == BP_OPTION_HELP || command == NULL || (command->options >> o & 1u) != 0)
            names[count++] = rows[o].name;
    return bp_nearest_name(written + strspn(written, "-"), names, count);
}
