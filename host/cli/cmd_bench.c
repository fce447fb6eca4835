/* cmd_bench.c: `ballpark bench`.
 *
 * In:    scenes, or the names of fixed ones, or nothing.   Out: a table of throughput, and JSON.
 * Knows: rounds, medians, tables.   Does not know: how a run is timed (bench_measure.h).
 *
 * Scenes take turns, round after round, so that what else the machine does spreads over all of them. */
#include "commands.h"

#include "base/format.h"
#include "base/json_text.h"
#include "base/names.h"
#include "base/plural.h"
#include "base/shown.h"
#include "bench_measure.h"
#include "bench_scenes.h"
#include "interrupt.h"
#include "json_file.h"
#include "setup.h"
#include "temporary_folder.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define ROUNDS_DEFAULT 5u
#define ROUNDS_MAX 1000u    /* --rounds */
#define SECONDS_DEFAULT 5.0 /* of tracing, a scene */

typedef struct Entry {
    const char *name; /* as asked for */
    bool fixed;       /* written by us */
    char path[4096];
    BpBenchRun *runs; /* one a round */
} Entry;

typedef struct Bench {
    Entry *entries;
    size_t count;
    uint32_t rounds;
    const char *folder; /* where fixed scenes stand: --output, or our own */
    BpTemporaryFolder own;
} Bench;

/* ---- figures of the rounds ---- */

typedef double RunValue(const BpBenchRun *run);

static double load_seconds(const BpBenchRun *run) {
    return run->load_seconds;
}
static double tree_seconds(const BpBenchRun *run) {
    return run->tree_seconds;
}
static double kernel_seconds(const BpBenchRun *run) {
    return run->kernel_build_seconds;
}
static double samples_rate(const BpBenchRun *run) {
    return (double)run->samples / run->seconds;
}
static double segments_rate(const BpBenchRun *run) {
    return (double)run->segments / run->seconds;
}
static double segment_nanoseconds(const BpBenchRun *run) {
    return 1e9 * run->seconds / (double)run->segments;
}
static double segment_cpu_nanoseconds(const BpBenchRun *run) {
    return 1e9 * run->cpu_seconds / (double)run->segments;
}
static double segment_device_nanoseconds(const BpBenchRun *run) {
    return 1e9 * run->device_seconds / (double)run->segments;
}

static BpBenchFigure figure(const Bench *bench, const Entry *entry, RunValue *value) {
    double values[ROUNDS_MAX];
    for (size_t r = 0; r < bench->rounds; ++r) values[r] = value(&entry->runs[r]);
    return bp_bench_figure(values, bench->rounds);
}

static double bytes_per_sphere(const Entry *entry) {
    return entry->runs[0].spheres > 0
               ? (double)entry->runs[0].report.scene_bytes / (double)entry->runs[0].spheres
               : 0.0;
}

/* ---- the table ---- */

/* "1.23 ms": three digits and a unit. */
static const char *short_time(double seconds, char *text, size_t size) {
    const char *unit = seconds < 1.0 ? "ms" : "s";
    const double value = seconds < 1.0 ? 1e3 * seconds : seconds;
    snprintf(text, size, "%.*f %s", value < 9.995 ? 2 : value < 99.95 ? 1 : 0, value, unit);
    return text;
}

static void print_row(const Bench *bench, const Entry *entry) {
    char load[32], tree[32], kernel[32], spheres[32], name[256];
    const BpBenchFigure segments = figure(bench, entry, segments_rate);
    printf("%-12s %11s %9s %9s %9s %10.2f %11.2f %9.1f %9.1f %7.0f %% %8.0f\n",
           bp_shown(entry->name, name, sizeof name),
           bp_format_whole(entry->runs[0].spheres, spheres, sizeof spheres),
           short_time(figure(bench, entry, load_seconds).median, load, sizeof load),
           short_time(figure(bench, entry, tree_seconds).median, tree, sizeof tree),
           short_time(figure(bench, entry, kernel_seconds).median, kernel, sizeof kernel),
           1e-6 * figure(bench, entry, samples_rate).median, 1e-6 * segments.median,
           figure(bench, entry, segment_nanoseconds).median,
           figure(bench, entry, segment_cpu_nanoseconds).median,
           100.0 * (segments.high - segments.low) / segments.median, bytes_per_sphere(entry));
}

static BpStatus print_table(const Bench *bench, BpError *err) {
    const BpRenderReport *report = &bench->entries[0].runs[0].report;
    bp_show(report->device.name, false, stdout);
    fputs(", ", stdout);
    bp_show(report->device.platform, false, stdout);
    printf("; %s kernel, %s, %s numerics, %s math\n", bp_kernel_names[report->kernel],
           bp_precision_names[report->precision], bp_numerics_names[report->numerics],
           bp_math_names[report->math]);
    printf("%-12s %11s %9s %9s %9s %10s %11s %9s %9s %9s %8s\n", "scene", "spheres", "load", "tree", "kernel",
           "Msamples/s", "Msegments/s", "ns/segm.", "CPU ns", "spread", "B/sphere");
    for (size_t i = 0; i < bench->count; ++i) print_row(bench, &bench->entries[i]);
    printf("medians of %u round%s; spread: between the quartiles; CPU ns: processor time a segment, all "
           "threads\n",
           bench->rounds, bp_plural(bench->rounds));
    if (fflush(stdout) != 0 || ferror(stdout))
        return bp_fail(err, BP_ERR_FILE, "cannot write to standard output: %s", strerror(errno));
    return BP_OK;
}

/* ---- JSON ---- */

static json_t *figure_json(const Bench *bench, const Entry *entry, RunValue *value) {
    const BpBenchFigure f = figure(bench, entry, value);
    json_t *values = json_array();
    for (size_t r = 0; r < bench->rounds && values != NULL; ++r)
        json_array_append_new(values, json_real(value(&entry->runs[r])));
    return json_pack("{s:f, s:f, s:f, s:o}", "median", f.median, "low", f.low, "high", f.high, "rounds",
                     values);
}

static json_t *entry_json(const Bench *bench, const Entry *entry) {
    const BpBenchRun *run = &entry->runs[0];
    uint64_t samples = 0, segments = 0;
    for (size_t r = 0; r < bench->rounds; ++r) {
        samples += entry->runs[r].samples;
        segments += entry->runs[r].segments;
    }
    json_t *nrmse = isfinite(run->nrmse) ? json_real(run->nrmse) : json_null();
    return json_pack(
        "{s:o, s:o, s:I, s:I, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:f, s:I, s:f, s:[fff], s:o, "
        "s:I}",
        "name", bp_json_text(entry->name), "path", bp_json_text(entry->path), "spheres",
        (json_int_t)run->spheres, "width", (json_int_t)run->width, "height", (json_int_t)run->height,
        "max_depth", (json_int_t)run->max_depth, "load_seconds", figure_json(bench, entry, load_seconds),
        "tree_seconds", figure_json(bench, entry, tree_seconds), "kernel_build_seconds",
        figure_json(bench, entry, kernel_seconds), "samples_per_second",
        figure_json(bench, entry, samples_rate), "segments_per_second",
        figure_json(bench, entry, segments_rate), "nanoseconds_per_segment",
        figure_json(bench, entry, segment_nanoseconds), "cpu_nanoseconds_per_segment",
        figure_json(bench, entry, segment_cpu_nanoseconds), "device_nanoseconds_per_segment",
        figure_json(bench, entry, segment_device_nanoseconds), "segments_per_sample",
        (double)segments / (double)samples, "scene_bytes", (json_int_t)run->report.scene_bytes,
        "bytes_per_sphere", bytes_per_sphere(entry), "mean_radiance", run->mean[0], run->mean[1],
        run->mean[2], "nrmse", nrmse, "invalid_samples", (json_int_t)run->report.invalid_samples);
}

static BpStatus write_json(const Bench *bench, const char *path, BpError *err) {
    const BpRenderReport *report = &bench->entries[0].runs[0].report;
    json_t *scenes = json_array();
    for (size_t i = 0; i < bench->count; ++i) {
        if (json_array_append_new(scenes, entry_json(bench, &bench->entries[i])) == 0) continue;
        json_decref(scenes);
        return bp_json_write(NULL, path, err);
    }
    return bp_json_write(
        json_pack("{s:s, s:{s:o, s:o, s:o, s:s}, s:s, s:s, s:s, s:s, s:s, s:i, s:o}", "version", bp_version(),
                  "device", "platform", bp_json_text(report->device.platform), "name",
                  bp_json_text(report->device.name), "driver", bp_json_text(report->device.driver), "type",
                  bp_device_type_names[report->device.type], "kernel", bp_kernel_names[report->kernel],
                  "precision", bp_precision_names[report->precision], "numerics",
                  bp_numerics_names[report->numerics], "math", bp_math_names[report->math], "sampler",
                  bp_sampler_names[report->sampler], "rounds", (int)bench->rounds, "scenes", scenes),
        path, err);
}

/* ---- the command ---- */

/* The folder of the fixed scenes: --output, made if it is not there; or one of our own. */
static BpStatus open_folder(const BpCommandLine *line, Bench *bench, BpError *err) {
    bench->folder = line->output != NULL ? line->output : bench->own.path;
    if (line->output == NULL) return bp_temporary_folder_make(&bench->own, err);
    if (mkdir(line->output, 0777) != 0 && errno != EEXIST)
        return bp_fail(err, BP_ERR_FILE, "cannot make the folder %s: %s", line->output, strerror(errno));
    return BP_OK;
}

static BpStatus prepare(const BpCommandLine *line, Bench *bench, BpError *err) {
    size_t fixed_count = 0;
    while (bp_bench_scene_names[fixed_count] != NULL) ++fixed_count;
    bench->count = line->operand_count > 0 ? line->operand_count : fixed_count;
    bench->entries = calloc(bench->count, sizeof *bench->entries);
    if (bench->entries == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the list of scenes");
    bench->rounds = line->rounds != 0 ? line->rounds : ROUNDS_DEFAULT;
    for (size_t i = 0; i < bench->count; ++i) {
        Entry *entry = &bench->entries[i];
        entry->runs = calloc(bench->rounds, sizeof *entry->runs);
        if (entry->runs == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the rounds");
        entry->name = line->operand_count > 0 ? line->operands[i] : bp_bench_scene_names[i];
        entry->fixed = bp_bench_scene_known(entry->name);
        if (strcmp(entry->name, "-") == 0)
            return bp_fail(
                err, BP_ERR_USAGE,
                "ballpark bench reads a scene again in every round, standard input (\"-\") can be read once "
                "only: name a file");
        if (!entry->fixed) {
            snprintf(entry->path, sizeof entry->path, "%s", entry->name);
            continue;
        }
        if (bench->folder == NULL) BP_TRY(open_folder(line, bench, err));
        if (bp_interrupted())
            return bp_fail(err, BP_ERR_INTERRUPTED, "interrupted before a scene was traced");
        BP_TRY(bp_bench_scene_write(entry->name, bench->folder, entry->path, sizeof entry->path, err));
    }
    return BP_OK;
}

static BpStatus run_rounds(const BpCommandLine *line, Bench *bench, BpError *err) {
    const double seconds = bp_option_given(line, BP_OPTION_TIME) ? line->time_seconds : SECONDS_DEFAULT;
    BpDeviceInfo *devices = NULL;
    size_t device_count = 0;
    BpStatus status = bp_setup_devices(line, &devices, &device_count, err);
    for (size_t r = 0; r < bench->rounds && status == BP_OK; ++r) {
        for (size_t i = 0; i < bench->count && status == BP_OK; ++i) {
            Entry *entry = &bench->entries[i];
            char name[256];
            if (!line->quiet)
                fprintf(stderr, "round %zu of %u: %s\n", r + 1, bench->rounds,
                        bp_shown(entry->name, name, sizeof name));
            status = bp_bench_run(line, entry->path, devices, device_count, seconds / bench->rounds,
                                  &entry->runs[r], err);
        }
    }
    free(devices);
    return status;
}

static void clear(Bench *bench) {
    for (size_t i = 0; i < bench->count && bench->entries != NULL; ++i) free(bench->entries[i].runs);
    bp_temporary_folder_remove(&bench->own);
    free(bench->entries);
}

BpStatus bp_command_bench(const BpCommandLine *line, BpError *err) {
    Bench bench = {0};
    BpStatus status = BP_OK;
    if (line->json != NULL) BP_TRY(bp_json_check(line->json, err));
    bp_interrupt_catch();
    BP_TRY_GOTO(status, prepare(line, &bench, err), done);
    if (line->output != NULL) goto done; /* the scenes were wanted, not figures */
    BP_TRY_GOTO(status, run_rounds(line, &bench, err), done);
    if (line->json == NULL || strcmp(line->json, "-") != 0)
        BP_TRY_GOTO(status, print_table(&bench, err), done);
    if (line->json != NULL) status = write_json(&bench, line->json, err);
done:
    clear(&bench);
    return status;
}
