/* option_list.h: the list of all options.
 *
 * Out:   one row for each option. From it come the option's number and its member of BpCommandLine
 * (options.h), the reading of its value, its line in the help, and the commands that take it
 * (option_table.c).
 * Knows: names, values and help texts of options.   Does not know: what a command does with them.
 *
 * A new option is a row here, and the code that uses its value. Rows stand in the order of the help. */
#ifndef BP_CLI_LINE_OPTION_LIST_H
#define BP_CLI_LINE_OPTION_LIST_H

/* The commands, as sets of bits, for the rows below. */
enum {
    BP_RENDER = 1 << 0,
    BP_CHECK = 1 << 1,
    BP_EXPLAIN = 1 << 2,
    BP_COST = 1 << 3,
    BP_MERGE = 1 << 4,
    BP_BENCH = 1 << 5,
    BP_DEVICES = 1 << 6,
    BP_GENERATE = 1 << 7,
    BP_SCENE = 1 << 8,
    BP_VIEW = 1 << 9,
    BP_HELP = 1 << 10,
    /* All commands that trace paths. */
    BP_TRACERS = BP_RENDER | BP_CHECK | BP_EXPLAIN | BP_COST | BP_BENCH | BP_VIEW,
    BP_COMMANDS = BP_TRACERS | BP_MERGE | BP_DEVICES | BP_GENERATE | BP_SCENE, /* all that do work */
};

/* OPTION(number, name, letter or 0, commands, help, type, member of BpCommandLine, value). RENDER_OPTION is
 * the same for a value that goes to the member of BpRenderOptions with the same name and type
 * (cli/job/setup.c).
 *
 * Values, each with its name in the help:
 *   BP_FLAG                          bool: the option takes no value
 *   BP_WHOLE(shown, least, most)     uint32_t or uint64_t: an integer
 *   BP_REAL(shown, above, most)      double: above the one, up to the other
 *   BP_PERCENT(above, most)          double: the same, in percent; "1" and "1%" are the same
 *   BP_TIME(above, most)             double: seconds; "90", "90s", "1.5m", "1h30m"
 *   BP_PIXEL(shown, most)            BpPixel: two integers up to `most`
 *   BP_SIGNED(shown)                 int64_t: an integer that may be negative
 *   BP_SLICE(shown)                  BpSlice: A:B:S
 *   BP_PART(shown)                   BpShare: I/N, one of N shares
 *   BP_CHOICE(shown, names, first)   an enumeration with its names (base/names.h), from its value `first` on
 *   BP_WORD(word, ...)               const char *: one of these words
 *   BP_TEXT(shown)                   const char *: any text that is not empty
 *   BP_TEXTS(shown)                  BpTexts: the same, and the option may be given several times
 *   BP_RESULT(shown)                 const char *: a file to write, which no other file of the run may be
 * A choice without a name to show ("") and a word are shown as all their words: robust|plain. Texts for
 * single commands and defaults are in BP_OPTION_NOTES, below. */
#define BP_OPTION_LIST(OPTION, RENDER_OPTION)                                                                \
    OPTION(OUTPUT, "output", 'o', BP_RENDER | BP_COST | BP_MERGE | BP_BENCH | BP_GENERATE | BP_SCENE,        \
           "where the result goes; \"-\" is standard output", const char *, output, BP_RESULT("FILE"))       \
    RENDER_OPTION(SPP, "spp", 0, BP_RENDER | BP_CHECK, "samples per pixel", uint64_t, samples_per_pixel,     \
                  BP_WHOLE("N", 1, BP_SPP_MAX))                                                              \
    OPTION(ERROR, "error", 0, BP_RENDER | BP_VIEW,                                                           \
           "stop when the noise of the picture (NRMSE) is below PERCENT", double, error_percent,             \
           BP_PERCENT(0, 100))                                                                               \
    OPTION(TIME, "time", 0, BP_RENDER | BP_COST | BP_BENCH, "time budget, such as 90, 90s, 2m or 1h30m",     \
           double, time_seconds, BP_TIME(0, 1e7))                                                            \
    OPTION(WIDTH, "width", 0, BP_TRACERS, "width of the picture in pixels; the aspect ratio stays",          \
           uint32_t, width, BP_WHOLE("N", 1, BP_PICTURE_SIDE_MAX))                                           \
    OPTION(FRAME, "frame", 0, BP_TRACERS | BP_SCENE,                                                         \
           "frame of a file of particles; 0: the first, -1: the last", int64_t, frame, BP_SIGNED("N"))       \
    OPTION(FRAMES, "frames", 0, BP_RENDER,                                                                   \
           "one numbered picture per frame, with one camera and one range of colours; a slice as in "        \
           "Python: from A up to, but not including, B, every S-th",                                         \
           BpSlice, frames, BP_SLICE("A:B:S"))                                                               \
    OPTION(SELECT, "select", 0, BP_TRACERS | BP_SCENE,                                                       \
           "show only particles for which this holds, such as 'chain == \"A\" and not hydrogen'",            \
           const char *, select, BP_TEXT("EXPRESSION"))                                                      \
    OPTION(TURNTABLE, "turntable", 0, BP_RENDER,                                                             \
           "N numbered pictures from a circle around the vertical axis", uint32_t, turntable,                \
           BP_WHOLE("N", 2, 100000))                                                                         \
    OPTION(FIT, "fit", 0, BP_TRACERS | BP_SCENE,                                                             \
           "place the camera so that the particles, or all spheres if there are none, fill the picture",     \
           bool, fit, BP_FLAG)                                                                               \
    OPTION(PROJECTION, "projection", 0, BP_TRACERS | BP_SCENE,                                               \
           "orthographic: parallel rays, so distant things do not look smaller", const char *, projection,   \
           BP_WORD("perspective", "orthographic"))                                                           \
    OPTION(LIGHTING, "lighting", 0, BP_TRACERS | BP_SCENE,                                                   \
           "light that moves with the camera, instead of the scene's; sky: the scene's background",          \
           const char *, lighting, BP_WORD("soft", "studio", "rembrandt", "overhead", "sky"))                \
    OPTION(DPI, "dpi", 0, BP_RENDER | BP_MERGE, "dots per inch, recorded in PNG, EXR, PDF and SVG", double,  \
           dpi, BP_REAL("N", 0, 100000))                                                                     \
    OPTION(WIDTH_MM, "width-mm", 0, BP_RENDER,                                                               \
           "printed width; together with --dpi, sets the width in pixels", double, width_mm,                 \
           BP_REAL("N", 0, 100000))                                                                          \
    OPTION(BIT_DEPTH, "bit-depth", 0, BP_RENDER | BP_MERGE, "bits per channel of a PNG", const char *,       \
           bit_depth, BP_WORD("8", "16"))                                                                    \
    OPTION(OUTLINES, "outlines", 0, BP_RENDER | BP_MERGE,                                                    \
           "draw lines of this width where the depth jumps; does not affect the reported noise", double,     \
           outlines, BP_REAL("PIXELS", 0, 100))                                                              \
    OPTION(                                                                                                  \
        DEPTH_FOG, "depth-fog", 0, BP_RENDER | BP_MERGE,                                                     \
        "fade distant parts into the backdrop, the farthest by PERCENT; reported noise is that without it",  \
        double, depth_fog, BP_PERCENT(0, 100))                                                               \
    OPTION(METADATA, "metadata", 0, BP_RENDER | BP_MERGE,                                                    \
           "record the command, version, seed and scene hash in PNG and EXR", bool, metadata, BP_FLAG)       \
    RENDER_OPTION(DEPTH, "depth", 0, BP_TRACERS,                                                             \
                  "maximum number of ray segments per path; 0: black, 1: only sky and lamps", uint32_t,      \
                  max_depth, BP_WHOLE("N", 0, BP_DEPTH_MAX))                                                 \
    OPTION(SET, "set", 0, BP_TRACERS | BP_SCENE,                                                             \
           "override a member of the scene, such as camera.vfov=30 or spheres[0].radius=2; the value is "    \
           "JSON or a word, null removes the member; may be repeated",                                       \
           BpTexts, set, BP_TEXTS("MEMBER=VALUE"))                                                           \
    OPTION(FRESNEL, "fresnel", 0, BP_RENDER | BP_CHECK | BP_EXPLAIN | BP_BENCH | BP_VIEW,                    \
           "reflection of glass: the book's approximation, or Fresnel's equations", const char *, fresnel,   \
           BP_WORD("schlick", "exact"))                                                                      \
    RENDER_OPTION(SEED, "seed", 0, BP_TRACERS | BP_GENERATE, "random seed, 64 bits, decimal or 0x...",       \
                  uint64_t, seed, BP_WHOLE("N", 0, UINT64_MAX))                                              \
    RENDER_OPTION(FIRST_SAMPLE, "first-sample", 0, BP_RENDER | BP_EXPLAIN,                                   \
                  "number of the first sample, for renders to be merged", uint64_t, first_sample,            \
                  BP_WHOLE("N", 0, BP_SAMPLE_NUMBERS - 1))                                                   \
    OPTION(DEVICE, "device", 0, BP_TRACERS,                                                                  \
           "device number, part of its name or driver version, gpu, cpu or all (see `ballpark devices`)",    \
           const char *, device, BP_TEXT("N|NAME"))                                                          \
    RENDER_OPTION(THREADS, "threads", 0, BP_TRACERS,                                                         \
                  "largest number of threads to use on a CPU, as far as its driver can divide it", uint32_t, \
                  threads, BP_WHOLE("N", 1, 65536))                                                          \
    RENDER_OPTION(PRECISION, "precision", 0, BP_TRACERS, "floating-point precision of the kernel",           \
                  BpPrecision, precision, BP_CHOICE("", bp_precision_names, 0))                              \
    RENDER_OPTION(MATH, "math", 0, BP_TRACERS, "fast: the compiler may round differently", BpMath, math,     \
                  BP_CHOICE("", bp_math_names, 0))                                                           \
    RENDER_OPTION(NUMERICS, "numerics", 0, BP_TRACERS, "plain: faster, wrong at extreme scales", BpNumerics, \
                  numerics, BP_CHOICE("", bp_numerics_names, 0))                                             \
    RENDER_OPTION(SAMPLER, "sampler", 0, BP_RENDER | BP_EXPLAIN | BP_COST | BP_BENCH | BP_VIEW,              \
                  "sample sequence; sobol has less noise", BpSampler, sampler,                               \
                  BP_CHOICE("", bp_sampler_names, 0))                                                        \
    RENDER_OPTION(LIGHT_SAMPLING, "light-sampling", 0, BP_TRACERS,                                           \
                  "off: paths find lights only by chance, for comparison", BpLightSampling, light_sampling,  \
                  BP_CHOICE("", bp_light_sampling_names, 0))                                                 \
    RENDER_OPTION(CAUSTICS, "caustics", 0, BP_TRACERS,                                                       \
                  "on: rays to lamps go through balls of glass and off mirrors, too; auto: where they take " \
                  "away more noise than their time costs",                                                   \
                  BpCaustics, caustics, BP_CHOICE("", bp_caustics_names, 0))                                 \
    RENDER_OPTION(ROULETTE, "roulette", 0, BP_TRACERS,                                                       \
                  "off: deep paths that carry little are traced on, for comparison", BpRoulette, roulette,   \
                  BP_CHOICE("", bp_roulette_names, 0))                                                       \
    RENDER_OPTION(ADAPTIVE, "adaptive", 0, BP_RENDER,                                                        \
                  "give noisy pixels more samples and the others fewer; --spp is then the mean", bool,       \
                  adaptive, BP_FLAG)                                                                         \
    OPTION(EFFECTS, "effects", 0, BP_RENDER | BP_CHECK | BP_BENCH, "compile all effects, even unused ones",  \
           const char *, effects, BP_WORD("all"))                                                            \
    RENDER_OPTION(KERNEL, "kernel", 0, BP_TRACERS, "kernel variant; does not change the picture",            \
                  BpKernelForm, kernel, BP_CHOICE("", bp_kernel_names, BP_KERNEL_SAMPLE))                    \
    OPTION(TRANSFER, "transfer", 0, BP_RENDER | BP_MERGE | BP_VIEW, "tone curve of 8-bit output",            \
           BpTransfer, transfer, BP_CHOICE("", bp_transfer_names, 0))                                        \
    OPTION(EXPOSURE, "exposure", 0, BP_RENDER | BP_MERGE | BP_VIEW,                                          \
           "make the picture brighter by STOPS, each a factor of two; darker if negative", double, exposure, \
           BP_REAL("STOPS", -100, 100))                                                                      \
    OPTION(FORMAT, "format", 0, BP_RENDER | BP_MERGE, "png, pdf, svg, ppm, ppm-ascii, pfm, exr or bpa",      \
           BpFormat, format, BP_CHOICE("FORMAT", bp_format_names, 0))                                        \
    OPTION(ERROR_MAP, "error-map", 0, BP_RENDER | BP_MERGE, "write a heat map of each pixel's noise",        \
           const char *, error_map, BP_RESULT("FILE.png"))                                                   \
    OPTION(STATS, "stats", 0, BP_RENDER,                                                                     \
           "write times, counts and noise as JSON; \"-\" is standard output; a seed of 2^63 or more is a "   \
           "string",                                                                                         \
           const char *, stats, BP_RESULT("FILE"))                                                           \
    RENDER_OPTION(FORCE, "force", 0, BP_RENDER | BP_EXPLAIN | BP_COST | BP_VIEW,                             \
                  "render even if the device fails its self-test", bool, force, BP_FLAG)                     \
    OPTION(PREVIEW, "preview", 0, BP_RENDER,                                                                 \
           "rewrite the picture with the samples so far every SECONDS while rendering", double,              \
           preview_seconds, BP_REAL("SECONDS", 0, 1e7))                                                      \
    OPTION(SHOW, "show", 0, BP_RENDER,                                                                       \
           "draw the picture in the terminal while rendering, every second or as often as --preview", bool,  \
           show, BP_FLAG)                                                                                    \
    OPTION(CHECKPOINT, "checkpoint", 0, BP_RENDER,                                                           \
           "save the sums to a .bpa file every SECONDS, from which --resume continues", double,              \
           checkpoint_seconds, BP_REAL("SECONDS", 0, 1e7))                                                   \
    OPTION(RESUME, "resume", 0, BP_RENDER, "continue a stopped render from its .bpa file, with its options", \
           const char *, resume, BP_TEXT("FILE"))                                                            \
    OPTION(SHARE, "share", 0, BP_RENDER,                                                                     \
           "render part I of N of the samples, from 1/N to N/N, for `ballpark merge`", BpShare, share,       \
           BP_PART("I/N"))                                                                                   \
    OPTION(MEASURE, "measure", 0, BP_EXPLAIN, "measure what each effect costs", bool, measure, BP_FLAG)      \
    OPTION(PIXEL, "pixel", 0, BP_EXPLAIN, "follow one path of this pixel, step by step; 0,0 is top left",    \
           BpPixel, pixel, BP_PIXEL("X,Y", BP_PICTURE_SIDE_MAX - 1))                                         \
    OPTION(JSON, "json", 0, BP_CHECK | BP_EXPLAIN | BP_COST | BP_BENCH | BP_DEVICES,                         \
           "write the result as JSON; \"-\" is standard output", const char *, json, BP_RESULT("FILE"))      \
    OPTION(CSV, "csv", 0, BP_COST, "write the points as CSV; \"-\" is standard output", const char *, csv,   \
           BP_RESULT("FILE"))                                                                                \
    OPTION(MAP, "map", 0, BP_CHECK, "write a picture of where kernel and reference differ", const char *,    \
           map, BP_RESULT("FILE"))                                                                           \
    OPTION(                                                                                                  \
        SUITE, "suite", 0, BP_CHECK,                                                                         \
        "check all agreement scenes: small scenes, mostly of one effect each, that come with the program",   \
        bool, suite, BP_FLAG)                                                                                \
    OPTION(BITS, "bits", 0, BP_CHECK, "compare the device's pictures with recorded ones, bit for bit", bool, \
           bits, BP_FLAG)                                                                                    \
    OPTION(MARGIN, "margin", 0, BP_CHECK, "agree only if brightness is shown to be equal within PERCENT",    \
           double, margin_percent, BP_PERCENT(0, 100))                                                       \
    OPTION(TIMEOUT, "timeout", 0, BP_CHECK | BP_DEVICES,                                                     \
           "time limit per device, such as 90, 90s or 2m; samples rendered by then are judged", double,      \
           timeout_seconds, BP_TIME(0, 1e7))                                                                 \
    OPTION(AGAINST, "against", 0, BP_CHECK,                                                                  \
           "compare with an earlier check, whose --json wrote FILE: regressions, other drivers",             \
           const char *, against, BP_TEXT("FILE"))                                                           \
    OPTION(JUNIT, "junit", 0, BP_CHECK,                                                                      \
           "write the results as JUnit XML, for continuous integration; \"-\" is standard output",           \
           const char *, junit, BP_RESULT("FILE"))                                                           \
    OPTION(GRID, "grid", 0, BP_GENERATE, "half the side of the square of small spheres", uint32_t, grid,     \
           BP_WHOLE("G", 0, 5000))                                                                           \
    OPTION(COUNT, "count", 0, BP_GENERATE, "number of spheres in a field", uint64_t, count,                  \
           BP_WHOLE("N", 1, BP_SPHERES_MAX))                                                                 \
    OPTION(EDITION, "edition", 0, BP_GENERATE, "edition of the book", const char *, edition,                 \
           BP_WORD("1", "3", "3rust", "4"))                                                                  \
    OPTION(ROUNDS, "rounds", 0, BP_BENCH, "how many times each scene is measured", uint32_t, rounds,         \
           BP_WHOLE("N", 1, 1000))                                                                           \
    OPTION(NO_CLOBBER, "no-clobber", 0, BP_COMMANDS, "refuse to overwrite files", bool, no_clobber, BP_FLAG) \
    OPTION(WIDE, "wide", 0, BP_COMMANDS | BP_HELP, "do not wrap long lines to the width of the terminal",    \
           bool, wide, BP_FLAG)                                                                              \
    OPTION(QUIET, "quiet", 'q', BP_COMMANDS, "print errors only", bool, quiet, BP_FLAG)                      \
    /* These two belong to no command; bp_command_line_parse() handles them. */                              \
    OPTION(HELP, "help", 'h', 0, "print this help", bool, help, BP_FLAG)                                     \
    OPTION(VERSION, "version", 'V', 0, "print version and commit", bool, version, BP_FLAG)

/* Help texts of an option for some commands: NOTE(number, commands, help, default). `help` takes the place of
 * the text above unless it is NULL; `default` is NULL if the option has none. A pair of a command and an
 * option has at most one row. */
#define BP_OPTION_NOTES(NOTE)                                                                                \
    NOTE(OUTPUT, BP_RENDER,                                                                                  \
         "where the picture goes: a file, a folder for pictures named after their scenes, or \"-\" for "     \
         "standard output",                                                                                  \
         "the scene's name, in the current folder")                                                          \
    NOTE(OUTPUT, BP_COST, "write the whole study as an HTML page; \"-\" is standard output", NULL)           \
    NOTE(OUTPUT, BP_BENCH, "write the fixed scenes to this folder, without measuring", NULL)                 \
    NOTE(OUTPUT, BP_GENERATE, NULL, "cover.json or field.ply; standard output if that is a pipe or a file")  \
    NOTE(OUTPUT, BP_SCENE, "where the document goes", "standard output")                                     \
    NOTE(FRAME, BP_TRACERS | BP_SCENE, NULL, "0")                                                            \
    NOTE(LIGHT_SAMPLING, BP_TRACERS & ~BP_CHECK, NULL, "on where it helps")                                  \
    NOTE(LIGHT_SAMPLING, BP_CHECK, NULL, "both are checked")                                                 \
    NOTE(CAUSTICS, BP_TRACERS, NULL, "auto")                                                                 \
    NOTE(CAUSTICS, BP_CHECK, NULL, "both are checked")                                                       \
    NOTE(ROULETTE, BP_TRACERS, NULL, "on where paths may be deep")                                           \
    NOTE(CAUSTICS, BP_VIEW, NULL, "off")                                                                     \
    NOTE(SPP, BP_RENDER, NULL, "the scene's number")                                                         \
    NOTE(SPP, BP_CHECK, NULL, "1024")                                                                        \
    NOTE(ERROR, BP_VIEW, "render until the noise of the picture (NRMSE) is below PERCENT", "1%")             \
    NOTE(ERROR, BP_RENDER, NULL, "no limit")                                                                 \
    NOTE(TIME, BP_RENDER, "stop after this time, such as 90, 90s, 2m or 1h30m", "no limit")                  \
    NOTE(TIME, BP_COST, NULL, "1m")                                                                          \
    NOTE(TIME, BP_BENCH, "tracing time per scene, over all rounds, such as 90, 90s or 2m", "5s")             \
    NOTE(WIDTH, BP_RENDER | BP_BENCH | BP_VIEW, NULL, "the scene's width")                                   \
    NOTE(WIDTH, BP_CHECK, NULL, "64, or the scene's width if that is less")                                  \
    NOTE(WIDTH, BP_COST, NULL, "240, or the scene's width if that is less")                                  \
    NOTE(WIDTH, BP_EXPLAIN, NULL,                                                                            \
         "the scene's width; with --measure 400, or the scene's width if that is less")                      \
    NOTE(DEPTH, BP_TRACERS, NULL, "the scene's depth")                                                       \
    NOTE(FRESNEL, BP_RENDER | BP_CHECK | BP_EXPLAIN | BP_BENCH | BP_SCENE | BP_VIEW, NULL,                   \
         "each material's own")                                                                              \
    NOTE(SEED, BP_TRACERS, NULL, "0")                                                                        \
    NOTE(SEED, BP_GENERATE, NULL, "1")                                                                       \
    NOTE(FIRST_SAMPLE, BP_RENDER, NULL, "0")                                                                 \
    NOTE(FIRST_SAMPLE, BP_EXPLAIN, "which sample to follow", "0")                                            \
    NOTE(DEVICE, BP_RENDER | BP_CHECK | BP_BENCH | BP_VIEW, NULL,                                            \
         "the most capable GPU if there is one, otherwise a CPU")                                            \
    NOTE(DEVICE, BP_EXPLAIN | BP_COST,                                                                       \
         "device number, part of its name or driver version, gpu or cpu (see `ballpark devices`)",           \
         "the most capable GPU if there is one, otherwise a CPU")                                            \
    NOTE(THREADS, BP_TRACERS, NULL, "all")                                                                   \
    NOTE(PRECISION, BP_TRACERS, NULL, "single")                                                              \
    NOTE(MATH, BP_TRACERS, NULL, "strict")                                                                   \
    NOTE(NUMERICS, BP_TRACERS, NULL, "robust")                                                               \
    NOTE(SAMPLER, BP_RENDER | BP_EXPLAIN | BP_COST | BP_VIEW, NULL, "sobol")                                 \
    NOTE(SAMPLER, BP_BENCH, NULL, "independent")                                                             \
    NOTE(KERNEL, BP_TRACERS, NULL,                                                                           \
         "packet on a CPU; on a GPU, the fastest in a trial at its first use; sample elsewhere")             \
    NOTE(TRANSFER, BP_RENDER | BP_VIEW, NULL, "the scene's")                                                 \
    NOTE(TRANSFER, BP_MERGE, NULL, "that of the first file's scene")                                         \
    NOTE(EXPOSURE, BP_RENDER | BP_MERGE | BP_VIEW, NULL, "0")                                                \
    NOTE(BIT_DEPTH, BP_RENDER | BP_MERGE, NULL, "8")                                                         \
    NOTE(PROJECTION, BP_TRACERS | BP_SCENE, NULL, "the scene's")                                             \
    NOTE(LIGHTING, BP_TRACERS | BP_SCENE, NULL,                                                              \
         "the scene's; soft for a file of particles, studio for a mesh")                                     \
    NOTE(FORMAT, BP_RENDER | BP_MERGE, NULL, "by the ending of FILE, otherwise png")                         \
    NOTE(MARGIN, BP_CHECK, NULL, "0.5%, with --suite 1%")                                                    \
    NOTE(TIMEOUT, BP_CHECK, NULL, "no limit; 20s to list devices")                                           \
    NOTE(TIMEOUT, BP_DEVICES, "time limit for the drivers to answer, such as 20 or 20s", "20s")              \
    NOTE(GRID, BP_GENERATE, NULL, "11")                                                                      \
    NOTE(COUNT, BP_GENERATE, NULL, "1000000")                                                                \
    NOTE(EDITION, BP_GENERATE, NULL, "4")                                                                    \
    NOTE(ROUNDS, BP_BENCH, NULL, "5")

#endif
