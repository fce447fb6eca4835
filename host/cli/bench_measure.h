/* bench_measure.h: one timed run of one scene, from file to samples; and what a row of such runs says.
 *
 * In:    a scene's path, the options, how long to trace.   Out: figures.
 * Knows: the library's render loop, clocks.   Does not know: tables, JSON, which scenes there are. */
#ifndef BP_CLI_BENCH_MEASURE_H
#define BP_CLI_BENCH_MEASURE_H

#include "options.h"
#include "render/render.h"

/* Times are wall-clock seconds unless they say otherwise. */
typedef struct BpBenchRun {
    double load_seconds, tree_seconds, kernel_build_seconds;
    /* A stretch of tracing, begun when caches, clocks and the size of chunks had settled: */
    double seconds;
    double
        cpu_seconds; /* of all threads of this process: for a CPU device, what tracing took of the machine */
    double device_seconds;
    uint64_t samples, segments;
    double mean[3], nrmse; /* of the whole run */
    size_t spheres;
    uint32_t width, height, max_depth;
    BpRenderReport report; /* its texts are not valid any more */
} BpBenchRun;

/* Loads, builds, warms up, traces for about `seconds`. */
BpStatus bp_bench_run(const BpCommandLine *line, const char *path, const BpDeviceInfo *devices,
                      size_t device_count, double seconds, BpBenchRun *run, BpError *err);

/* Median and quartiles, by linear interpolation between order statistics (Hyndman and Fan 1996, type 7). */
typedef struct BpBenchFigure {
    double median, low, high;
} BpBenchFigure;

/* `values` are put in order. count >= 1. */
BpBenchFigure bp_bench_figure(double *values, size_t count);

#endif
