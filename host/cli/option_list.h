/* option_list.h: the list of all options.
 *
 * Out:   one row an option. From it come the option's number and its member of BpCommandLine (options.h), the
 *        reading of its value, its line in the help, and the commands that take it (option_table.c).
 * Knows: names, values and help texts of options.   Does not know: what a command does with them.
 *
 * A new option is a row here, and the code that uses its value. Rows stand in the order of the help. */
#ifndef BP_CLI_OPTION_LIST_H
#define BP_CLI_OPTION_LIST_H

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
    /* All that trace paths. */
    BP_TRACERS = BP_RENDER | BP_CHECK | BP_EXPLAIN | BP_COST | BP_BENCH,
    /* All that have something to say beside their result. */
    BP_TALKERS = BP_TRACERS | BP_MERGE | BP_GENERATE | BP_SCENE,
};

/* OPTION(number, name, letter or 0, commands, help, type, member of BpCommandLine, value). RENDER_OPTION is
 * the same for a value that goes to the member of BpRenderOptions with the same name and type (setup.c).
 *
 * Values, each with the name that the help gives it:
 *   BP_FLAG                          bool: the option takes no value
 *   BP_WHOLE(shown, least, most)     uint32_t or uint64_t: a whole number
 *   BP_REAL(shown, above, most)      double: above the one, up to the other
 *   BP_PIXEL(shown, most)            BpPixel: two whole numbers up to `most`
 *   BP_SIGNED(shown)                 int64_t: a whole number that may be negative
 *   BP_SLICE(shown)                  BpSlice: A:B:S
 *   BP_PART(shown)                   BpShare: I/N, one of N shares
 *   BP_CHOICE(shown, names, first)   an enumeration with its names (base/names.h), from its value `first` on
 *   BP_WORD(word, ...)               const char *: one of these words
 *   BP_TEXT(shown)                   const char *: any text that is not empty
 *   BP_RESULT(shown)                 const char *: a file to write, which no other file of the run may be
 * A choice without a name to show ("") and a word are shown as all their words: robust|plain. */
#define BP_OPTION_LIST(OPTION, RENDER_OPTION)                                                                \
    OPTION(OUTPUT, "output", 'o', BP_RENDER | BP_COST | BP_MERGE | BP_BENCH | BP_GENERATE | BP_SCENE,        \
           "where the result goes; \"-\" is standard output", const char *, output, BP_RESULT("FILE"))       \
    RENDER_OPTION(SPP, "spp", 0, BP_RENDER | BP_CHECK,                                                       \
                  "samples per pixel (default: render: the scene's number, check: 1024)", uint64_t,          \
                  samples_per_pixel, BP_WHOLE("N", 1, BP_SPP_MAX))                                           \
    OPTION(ERROR, "error", 0, BP_RENDER, "stop when the noise of the picture (NRMSE) is below PERCENT",      \
           double, error_percent, BP_REAL("PERCENT", 0, 100))                                                \
    OPTION(TIME, "time", 0, BP_RENDER | BP_COST | BP_BENCH,                                                  \
           "time budget: stop after SECONDS (default: cost 60, bench 5 per scene)", double, time_seconds,    \
           BP_REAL("SECONDS", 0, 1e7))                                                                       \
    OPTION(WIDTH, "width", 0, BP_TRACERS, "width of the picture in pixels; the aspect ratio stays",          \
           uint32_t, width, BP_WHOLE("N", 1, BP_PICTURE_SIDE_MAX))                                           \
    OPTION(FRAME, "frame", 0, BP_TRACERS | BP_SCENE,                                                         \
           "which frame of a file of particles; 0: the first (default), -1: the last", int64_t, frame,       \
           BP_SIGNED("N"))                                                                                   \
    OPTION(FRAMES, "frames", 0, BP_RENDER,                                                                   \
           "a numbered picture of each of these frames, by one camera and one range of colours; as in "      \
           "Python, from A up to but without B, every S-th",                                                 \
           BpSlice, frames, BP_SLICE("A:B:S"))                                                               \
    OPTION(TURNTABLE, "turntable", 0, BP_RENDER,                                                             \
           "N numbered pictures on a circle around the axis that is up", uint32_t, turntable,                \
           BP_WHOLE("N", 2, 100000))                                                                         \
    OPTION(FIT, "fit", 0, BP_TRACERS | BP_SCENE,                                                             \
           "move the camera so that particles, or all spheres where there are none, fill the picture", bool, \
           fit, BP_FLAG)                                                                                     \
    RENDER_OPTION(DEPTH, "depth", 0, BP_TRACERS,                                                             \
                  "maximum number of ray segments per path; 0: black, 1: only sky and lamps", uint32_t,      \
                  max_depth, BP_WHOLE("N", 0, BP_DEPTH_MAX))                                                 \
    RENDER_OPTION(SEED, "seed", 0, BP_TRACERS | BP_GENERATE, "random seed, 64 bits, decimal or 0x...",       \
                  uint64_t, seed, BP_WHOLE("N", 0, UINT64_MAX))                                              \
    RENDER_OPTION(FIRST_SAMPLE, "first-sample", 0, BP_RENDER | BP_EXPLAIN,                                   \
                  "number of the first sample, for renders to be merged; explain: which sample to follow",   \
                  uint64_t, first_sample, BP_WHOLE("N", 0, BP_SAMPLE_NUMBERS - 1))                           \
    OPTION(DEVICE, "device", 0, BP_TRACERS,                                                                  \
           "device number, part of its name or driver version, gpu, cpu or all (see `ballpark devices`)",    \
           const char *, device, BP_TEXT("N|NAME|all"))                                                      \
    RENDER_OPTION(PRECISION, "precision", 0, BP_TRACERS,                                                     \
                  "floating-point precision of the kernel (default: single)", BpPrecision, precision,        \
                  BP_CHOICE("", bp_precision_names, 0))                                                      \
    RENDER_OPTION(MATH, "math", 0, BP_TRACERS, "fast: the compiler may round differently (default: strict)", \
                  BpMath, math, BP_CHOICE("", bp_math_names, 0))                                             \
    RENDER_OPTION(NUMERICS, "numerics", 0, BP_TRACERS,                                                       \
                  "plain: faster, wrong at extreme scales (default: robust)", BpNumerics, numerics,          \
                  BP_CHOICE("", bp_numerics_names, 0))                                                       \
    RENDER_OPTION(SAMPLER, "sampler", 0, BP_RENDER | BP_EXPLAIN | BP_COST | BP_BENCH,                        \
                  "sample sequence (default: sobol, less noise; bench: independent)", BpSampler, sampler,    \
                  BP_CHOICE("", bp_sampler_names, 0))                                                        \
    RENDER_OPTION(LAMPS, "lamps", 0, BP_TRACERS,                                                             \
                  "off: paths find lamps by chance only, for comparison (default: on where it helps; "       \
                  "check: off, as in the reference)",                                                        \
                  BpLamps, lamps, BP_CHOICE("", bp_lamps_names, 0))                                          \
    RENDER_OPTION(ADAPTIVE, "adaptive", 0, BP_RENDER,                                                        \
                  "give noisy pixels more samples and the others fewer; --spp is then the mean", bool,       \
                  adaptive, BP_FLAG)                                                                         \
    OPTION(EFFECTS, "effects", 0, BP_RENDER | BP_CHECK | BP_BENCH, "compile all effects, even unused ones",  \
           const char *, effects, BP_WORD("all"))                                                            \
    RENDER_OPTION(KERNEL, "kernel", 0, BP_TRACERS, "kernel variant; does not change the picture",            \
                  BpKernelForm, kernel, BP_CHOICE("", bp_kernel_names, BP_KERNEL_SAMPLE))                    \
    OPTION(TRANSFER, "transfer", 0, BP_RENDER | BP_MERGE,                                                    \
           "tone curve of 8-bit output (default: the scene's)", BpTransfer, transfer,                        \
           BP_CHOICE("", bp_transfer_names, 0))                                                              \
    OPTION(FORMAT, "format", 0, BP_RENDER | BP_MERGE,                                                        \
           "png, ppm, ppm-ascii, pfm, exr or bpa (default: by the ending of FILE)", BpFormat, format,        \
           BP_CHOICE("FORMAT", bp_format_names, 0))                                                          \
    OPTION(ERROR_MAP, "error-map", 0, BP_RENDER | BP_MERGE, "write a heat map of each pixel's error",        \
           const char *, error_map, BP_RESULT("FILE.png"))                                                   \
    OPTION(STATS, "stats", 0, BP_RENDER,                                                                     \
           "write times, counts and noise as JSON; \"-\" is standard output; a seed of 2^63 or more is a "   \
           "string",                                                                                         \
           const char *, stats, BP_RESULT("FILE"))                                                           \
    RENDER_OPTION(FORCE, "force", 0, BP_RENDER | BP_EXPLAIN | BP_COST,                                       \
                  "render even if the device fails its self-test", bool, force, BP_FLAG)                     \
    OPTION(CHECKPOINT, "checkpoint", 0, BP_RENDER,                                                           \
           "keep the sums in a .bpa file every SECONDS, from which --resume goes on", double,                \
           checkpoint_seconds, BP_REAL("SECONDS", 0, 1e7))                                                   \
    OPTION(RESUME, "resume", 0, BP_RENDER,                                                                   \
           "go on from the .bpa file of a render that was stopped, with its options", const char *, resume,  \
           BP_TEXT("FILE"))                                                                                  \
    OPTION(SHARE, "share", 0, BP_RENDER,                                                                     \
           "take part I of N of the samples, from 1/N to N/N, for `ballpark merge`", BpShare, share,         \
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
    OPTION(SUITE, "suite", 0, BP_CHECK,                                                                      \
           "check all agreement scenes, small ones of one effect each, which come with the program", bool,   \
           suite, BP_FLAG)                                                                                   \
    OPTION(BITS, "bits", 0, BP_CHECK, "compare the device's pictures with recorded ones, bit for bit", bool, \
           bits, BP_FLAG)                                                                                    \
    OPTION(MARGIN, "margin", 0, BP_CHECK,                                                                    \
           "agree only if brightness is shown to be equal within PERCENT (default: 0.5, suite 1)", double,   \
           margin_percent, BP_REAL("PERCENT", 0, 100))                                                       \
    OPTION(TIMEOUT, "timeout", 0, BP_CHECK | BP_DEVICES,                                                     \
           "time per device; check judges what there is by then (default: no limit; 20 to list devices)",    \
           double, timeout_seconds, BP_REAL("SECONDS", 0, 1e7))                                              \
    OPTION(AGAINST, "against", 0, BP_CHECK,                                                                  \
           "compare with an earlier check, the FILE of its --json: regressions, other drivers",              \
           const char *, against, BP_TEXT("FILE"))                                                           \
    OPTION(JUNIT, "junit", 0, BP_CHECK,                                                                      \
           "write the results as JUnit's XML, for continuous integration; \"-\" is standard output",         \
           const char *, junit, BP_RESULT("FILE"))                                                           \
    OPTION(GRID, "grid", 0, BP_GENERATE, "half the side of the square of small spheres (default: 11)",       \
           uint32_t, grid, BP_WHOLE("G", 0, 5000))                                                           \
    OPTION(COUNT, "count", 0, BP_GENERATE, "number of spheres in a field (default: 1000000)", uint64_t,      \
           count, BP_WHOLE("N", 1, BP_SPHERES_MAX))                                                          \
    OPTION(EDITION, "edition", 0, BP_GENERATE, "edition of the book (default: 4)", const char *, edition,    \
           BP_WORD("1", "3", "3rust", "4"))                                                                  \
    OPTION(ROUNDS, "rounds", 0, BP_BENCH, "how often each scene is measured (default: 5)", uint32_t, rounds, \
           BP_WHOLE("N", 1, 1000))                                                                           \
    OPTION(QUIET, "quiet", 'q', BP_TALKERS, "print errors only", bool, quiet, BP_FLAG)                       \
    /* Not of commands: bp_command_line_parse() knows where these two may stand. */                          \
    OPTION(HELP, "help", 'h', 0, "print this help", bool, help, BP_FLAG)                                     \
    OPTION(VERSION, "version", 'V', 0, "print version and commit", bool, version, BP_FLAG)

#endif
