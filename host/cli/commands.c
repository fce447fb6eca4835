/* commands.c: the table of commands; see commands.h. */
#include "commands.h"

#include "base/message_text.h"

#include <stdint.h>
#include <string.h>

#define TAKES(name) ((uint64_t)1 << BP_OPTION_##name)

/* What decides which radiance a pixel gets. */
#define TAKES_DRAWING                                                                                        \
    (TAKES(WIDTH) | TAKES(DEPTH) | TAKES(SEED) | TAKES(DEVICE) | TAKES(PRECISION) | TAKES(MATH) |            \
     TAKES(NUMERICS) | TAKES(KERNEL) | TAKES(EFFECTS))

const BpCommand bp_commands[] = {
    {
        .name = "render",
        .operands = "SCENE",
        .operands_min = 1,
        .operands_max = 1,
        .summary = "render a scene to a picture",
        .description =
            "Renders SCENE, a JSON document (scenes/README.md says how to write one; \"-\" is standard "
            "input, for every command that takes a scene). The picture is named "
            "like the scene and stands in the current folder, unless --output says otherwise; its ending "
            "picks the "
            "format: .png .ppm .pfm .exr (with layers for error, samples, depth, normal and albedo), or "
            ".bpa, "
            "which keeps the samples' sums for ballpark merge.\n"
            "\n"
            "The last line tells the error of the picture: the size of its noise beside its mean brightness "
            "(NRMSE). Half the error takes four times as long. --error and --time replace the scene's number "
            "of "
            "samples as the rule to stop by; --spp may stand beside them, and the first rule reached "
            "counts. --adaptive gives more samples to the pixels where the error is, and less to the others; "
            "--spp is then their mean.\n"
            "\n"
            "Ctrl-C stops, and keeps what has been rendered. The same scene, seed and samples give the same "
            "picture bit for bit on one device.",
        .examples =
            "  ballpark render scenes/cover.json                        cover.png, as the scene says\n"
            "  ballpark render scenes/cover.json --width 300 --spp 20   a quick look\n"
            "  ballpark render scenes/cover.json --error 1              until the noise is 1 %\n"
            "  ballpark render scenes/cover.json --error 1 --adaptive   sooner, on most scenes\n"
            "  ballpark render scenes/cover.json --time 30 -o half.exr  as good as 30 seconds allow\n"
            "  ballpark render scenes/cover.json -o - | display         to another program\n"
            "  ballpark generate cover | ballpark render - -o cover.png from another program\n",
        .options = TAKES_DRAWING | TAKES(OUTPUT) | TAKES(SPP) | TAKES(ERROR) | TAKES(TIME) |
                   TAKES(FIRST_SAMPLE) | TAKES(SAMPLER) | TAKES(ADAPTIVE) | TAKES(TRANSFER) | TAKES(FORMAT) |
                   TAKES(ERROR_MAP) | TAKES(STATS) | TAKES(FORCE) | TAKES(QUIET),
        .run = bp_command_render,
    },
    {
        .name = "check",
        .operands = "SCENE",
        .operands_min = 1,
        .operands_max = 1,
        .summary = "test a device: kernel against reference",
        .description =
            "Renders the scene on the device, and again with a tracer in plain C that shares no code "
            "with the kernel, with as many samples and other random numbers, and compares the two by "
            "statistics. Says whether they agree, within what interval the ratio of brightness lies, and "
            "how small an error would have been found. Unless told otherwise it draws 64 pixels across "
            "with 1024 samples each. A right kernel is rejected once in 10,000 checks.\n\n"
            "--device all checks every device, each in a process of its own, so that a driver that "
            "crashes is one line of the table. Exit code: 0 agree, 3 disagree, 1 a device broke.",
        .examples = "  ballpark check cover.json\n"
                    "  ballpark check cover.json --device all --json report.json\n"
                    "  ballpark check cover.json --spp 16384 --map map.png     deeper, with a picture\n",
        .options = TAKES_DRAWING | TAKES(SPP) | TAKES(JSON) | TAKES(MAP) | TAKES(QUIET),
        .run = bp_command_check,
    },
    {
        .name = "explain",
        .operands = "SCENE...",
        .operands_min = 1,
        .operands_max = SIZE_MAX,
        .summary = "which effects a scene calls for, why, and what each costs",
        .description =
            "For each SCENE, lists the effects that the kernel can simulate: which are in its kernel, which "
            "are left out, and why. With --measure, times the scene's kernel against kernels that simulate "
            "one effect more, and against one that simulates everything: all trace the same samples in turn, "
            "and the table gives the ratio of their times, with the range of the middle half of the rounds.\n"
            "\n"
            "With --pixel, follows one path of that pixel, step by step; --first-sample says which one.",
        .examples = "  ballpark explain scenes/cover.json\n"
                    "  ballpark explain scenes/*.json --json effects.json\n"
                    "  ballpark explain scenes/v4-13-metal.json --measure\n"
                    "  ballpark explain scenes/cover.json --pixel 600,300\n",
        .options = (TAKES_DRAWING & ~TAKES(EFFECTS)) | TAKES(PIXEL) | TAKES(FIRST_SAMPLE) | TAKES(MEASURE) |
                   TAKES(JSON) | TAKES(SAMPLER) | TAKES(FORCE) | TAKES(QUIET),
        .run = bp_command_explain,
    },
    {
        .name = "cost",
        .operands = "SCENE",
        .operands_min = 1,
        .operands_max = 1,
        .summary = "show what accuracy costs in time",
        .description =
            "Renders SCENE, unless told otherwise 240 pixels across, in every way that trades time for "
            "accuracy: more samples, the other sampler, adaptive samples, less depth, double precision, fast "
            "math, plain "
            "numerics, the other Fresnel, and some of these together. Each is compared with a truth that is "
            "rendered in double precision with exact Fresnel and depth 1000 (on a device without double, by "
            "the reference tracer). The table says what each way costs and what it changes; the last lines "
            "say what to use for an error of 5 %, 1 % and 0.2 %, and what that costs at the scene's own "
            "size. With -o it is all drawn on one page, with pictures, that needs nothing beside itself.\n\n"
            "--time is the budget (60 seconds); a short one tells less. --depth, --sampler, --precision, "
            "--math and --numerics choose the way that the others are compared with. Ctrl-C stops early, "
            "with the figures there are.",
        .examples = "  ballpark cost cover.json\n"
                    "  ballpark cost cover.json -o cost.html --time 300     a deeper look, as a page\n"
                    "  ballpark cost cover.json --csv - --width 300\n",
        .options = (TAKES_DRAWING & ~TAKES(EFFECTS)) | TAKES(OUTPUT) | TAKES(JSON) | TAKES(CSV) |
                   TAKES(TIME) | TAKES(SAMPLER) | TAKES(FORCE) | TAKES(QUIET),
        .run = bp_command_cost,
    },
    {
        .name = "merge",
        .operands = "FILE.bpa...",
        .operands_min = 1,
        .operands_max = SIZE_MAX,
        .summary = "make one picture of renders of different samples",
        .description =
            "Adds up films (.bpa) of the same scene, seed and settings whose sample numbers do "
            "not overlap, and writes the picture, or another .bpa. The result is that of one run over "
            "all samples, bit for bit: a long render can be shared among machines of one kind, or "
            "carried on later.",
        .examples = "  ballpark render cover.json --spp 500 -o a.bpa\n"
                    "  ballpark render cover.json --spp 500 --first-sample 500 -o b.bpa\n"
                    "  ballpark merge a.bpa b.bpa -o cover.png\n",
        .options = TAKES(OUTPUT) | TAKES(FORMAT) | TAKES(TRANSFER) | TAKES(ERROR_MAP) | TAKES(QUIET),
        .run = bp_command_merge,
    },
    {
        .name = "bench",
        .operands = "[SCENE...]",
        .operands_max = SIZE_MAX,
        .summary = "measure throughput",
        .description =
            "Measures how fast scenes load, build and render: samples and ray segments a second, "
            "nanoseconds a segment, bytes a sphere. A SCENE is a file, or one of the fixed scenes: "
            "cover, diffuse (the same spheres, all matte), glass (all glass), field-1e4, field-1e6 "
            "or any other number (random spheres in a cube); without any, these five. Scenes take "
            "turns, round after round; the table shows medians. --time is what each scene is traced for, "
            "all rounds together. With -o, the fixed scenes are written into that folder and nothing "
            "is measured.",
        .examples = "  ballpark bench\n"
                    "  ballpark bench cover field-1e7 --kernel sample --json figures.json\n"
                    "  ballpark bench -o scenes        write the fixed scenes, for other programs\n",
        .options = TAKES_DRAWING | TAKES(SAMPLER) | TAKES(TIME) | TAKES(ROUNDS) | TAKES(JSON) |
                   TAKES(OUTPUT) | TAKES(QUIET),
        .run = bp_command_bench,
    },
    {
        .name = "devices",
        .operands = "",
        .summary = "list the OpenCL devices",
        .description =
            "Lists every device of every OpenCL platform, and which one is used when --device says "
            "nothing: a GPU if there is one, else a CPU.",
        .examples = "  ballpark devices\n"
                    "  ballpark devices --json -       the same for programs\n",
        .options = TAKES(JSON),
        .run = bp_command_devices,
    },
    {
        .name = "generate",
        .operands = "cover|field",
        .operands_min = 1,
        .operands_max = 1,
        .summary = "make a scene: the book's cover, or a field of spheres",
        .description =
            "cover: the cover of the book as a scene file; the same seed gives the same spheres "
            "everywhere. field: spheres of random place, size and colour as a PLY file, to be named "
            "in the \"clouds\" of a scene.",
        .examples = "  ballpark generate cover -o cover.json\n"
                    "  ballpark generate cover --grid 50 --seed 7 -o wide.json     10,000 spheres\n"
                    "  ballpark generate field --count 10000000 -o field.ply\n",
        .options = TAKES(OUTPUT) | TAKES(GRID) | TAKES(COUNT) | TAKES(SEED) | TAKES(EDITION) | TAKES(QUIET),
        .run = bp_command_generate,
    },
    {
        .name = "help",
        .operands = "[COMMAND]",
        .operands_max = 1,
        .summary = "explain a command",
        .description = "Explains the program, or one command with its options and examples.",
        .examples = "  ballpark help render\n",
        .run = bp_command_help,
    },
};
const size_t bp_command_count = sizeof bp_commands / sizeof bp_commands[0];

BpStatus bp_command_find(const char *name, const BpCommand **command, BpError *err) {
    const char *names[sizeof bp_commands / sizeof bp_commands[0]];
    for (size_t c = 0; c < bp_command_count; ++c) {
        if (strcmp(name, bp_commands[c].name) == 0) {
            *command = &bp_commands[c];
            return BP_OK;
        }
        names[c] = bp_commands[c].name;
    }
    const char *nearest = bp_nearest_name(name, names, bp_command_count);
    char shown[80];
    bp_printable(name, shown, sizeof shown);
    if (nearest != NULL)
        return bp_fail(err, BP_ERR_USAGE, "unknown command \"%s\"; did you mean %s?", shown, nearest);
    return bp_fail(err, BP_ERR_USAGE, "unknown command \"%s\"; ballpark --help shows those there are", shown);
}
