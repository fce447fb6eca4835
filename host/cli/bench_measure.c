/* bench_measure.c: see bench_measure.h. */
#include "bench_measure.h"

#include "base/clock.h"
#include "base/quantile.h"
#include "interrupt.h"
#include "setup.h"

#include <math.h>
#include <stdlib.h>

#define WARM_UP_SECONDS 0.2

/* Traces until every pixel has `samples`; all work is done when it returns. */
static BpStatus trace_to(BpRender *render, uint64_t samples, BpError *err) {
    BpProgress progress = {0};
    BP_TRY(bp_render_extend(render, samples, err));
    do {
        BP_TRY(bp_render_step(render, &progress, err));
        if (bp_interrupted())
            return bp_fail(err, BP_ERR_INTERRUPTED, "interrupted; figures of a part of a run mean nothing");
    } while (!progress.finished);
    return BP_OK;
}

/* The counts of a render are whole once its film was read. */
static BpStatus read_report(BpRender *render, BpRenderReport *report, const BpFilm **film, BpError *err) {
    BP_TRY(bp_render_read_film(render, film, err));
    bp_render_report(render, report);
    return BP_OK;
}

/* Seconds that tracing would take of a machine with nothing else to do: for a CPU, the processor time spread
 * over its cores, so that other work on the machine does not make the stretch short. */
static double own_seconds(const BpRenderReport *report, double wall, double cpu) {
    const double spread = cpu / fmax(1.0, report->device.compute_units);
    return report->device.type == BP_DEVICE_CPU ? fmin(wall, spread) : wall;
}

/* Whole passes only: the rows of a picture cost differently. */
static BpStatus trace(BpRender *render, double seconds, BpBenchRun *run, BpError *err) {
    const BpFilm *film = NULL;
    BpRenderReport before;
    bp_render_report(render, &before);
    uint64_t samples = 0;
    double taken, whole = 0;
    do {
        const double start = bp_clock_seconds(), cpu_start = bp_processor_seconds();
        samples = 2 * samples + 1;
        BP_TRY(trace_to(render, samples, err));
        taken = own_seconds(&before, bp_clock_seconds() - start, bp_processor_seconds() - cpu_start);
        whole += taken;
    } while (whole < WARM_UP_SECONDS);
    BP_TRY(read_report(render, &before, &film, err));

    /* The last pass of the warm-up was samples / 2 + 1. */
    const double more = seconds / taken * (double)(samples / 2 + 1);
    const double start = bp_clock_seconds(), cpu_start = bp_processor_seconds();
    BP_TRY(trace_to(render, samples + (more > 1 ? (uint64_t)more : 1), err));
    run->seconds = bp_clock_seconds() - start;
    run->cpu_seconds = bp_processor_seconds() - cpu_start;
    BP_TRY(read_report(render, &run->report, &film, err));
    run->samples = run->report.samples - before.samples;
    run->segments = run->report.segments - before.segments;
    run->device_seconds = run->report.device_seconds - before.device_seconds;
    bp_film_mean(film, run->mean);
    run->nrmse = bp_film_nrmse(film);
    if (run->segments == 0)
        return bp_fail(err, BP_ERR_USAGE, "no ray was traced; a depth of 0 has nothing to measure");
    return BP_OK;
}

BpStatus bp_bench_run(const BpCommandLine *line, const char *path, const BpDeviceInfo *devices,
                      size_t device_count, double seconds, BpBenchRun *run, BpError *err) {
    BpScene *scene = NULL;
    BpRender *render = NULL;
    BpRenderOptions options;
    *run = (BpBenchRun){0};

    const double start = bp_clock_seconds();
    BpStatus status = bp_setup_scene(line, path, &scene, err);
    if (status != BP_OK) goto done;
    run->load_seconds = bp_clock_seconds() - start;
    run->spheres = scene->sphere_count;
    run->width = scene->camera.width;
    run->height = scene->camera.height;

    BP_TRY_GOTO(status, bp_setup_options(line, scene, &options, err), done);
    options.samples_per_pixel = 1; /* more follow */
    run->max_depth = options.max_depth;
    BP_TRY_GOTO(status, bp_render_create(scene, &options, devices, device_count, &render, err), done);
    status = trace(render, seconds, run, err);
    run->tree_seconds = run->report.tree_seconds + run->report.pack_seconds;
    run->kernel_build_seconds = run->report.kernel_build_seconds + run->report.first_launch_seconds;
done:
    bp_render_destroy(&render);
    bp_scene_destroy(&scene);
    return status;
}

BpBenchFigure bp_bench_figure(double *values, size_t count) {
    bp_sort_doubles(values, count);
    return (BpBenchFigure){bp_quantile(values, count, 0.5), bp_quantile(values, count, 0.25),
                           bp_quantile(values, count, 0.75)};
}
