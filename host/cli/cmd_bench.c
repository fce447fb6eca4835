/* cmd_bench.c: `ballpark bench`.
 *
 * In:    scenes, or names of fixed ones.   Out: a table of throughput, JSON; or the fixed scenes as files.
 * Knows: the fixed scenes, rounds, medians, tables.   Does not know: how a picture is traced.
 *
 * The scenes take turns, round after round, so that disturbances on the machine affect all of them alike. */
#include "commands.h"

#include "base/clock.h"
#include "base/escape.h"
#include "base/format.h"
#include "base/json_text.h"
#include "base/names.h"
#include "base/plural.h"
#include "base/quantile.h"
#include "base/status.h"
#include "cli/job/setup.h"
#include "cli/line/options.h"
#include "cli/output/content.h"
#include "cli/output/json_file.h"
#include "cli/output/output.h"
#include "cli/output/report_json.h"
#include "cli/process/interrupt.h"
#include "cli/process/temporary_folder.h"
#include "cli/terminal/page.h"
#include "cli/terminal/table.h"
#include "film/film.h"
#include "formats/bumpy_ball.h"
#include "formats/field.h"
#include "render/render.h"
#include "scene/scene.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- the fixed scenes -------------------------------------------------------------------------------- */

/* cover      the fourth edition's cover: every material, a lens
 * diffuse    the same spheres with metal and glass made matte: short paths, one kind of material
 * glass      the same spheres, all glass except the ground: long paths that diverge
 * field-N    N matte spheres of random colours in a cube, seen from outside; similar at any N, so that the
 *            figures show the cost of the number of spheres
 * ball-N     a matte, bumpy ball of N triangles */
enum { GRID = 11, SEED = 1, WIDTH = 400, SAMPLES = 64 };

static const char field_document[] =
    "{\n"
    "  \"format\": 1,\n"
    "  \"title\": \"bench: %s\",\n"
    "  \"camera\": { \"image_width\": 400, \"aspect_ratio\": [16, 9], \"samples_per_pixel\": 64,\n"
    "              \"max_depth\": 50, \"vfov\": 26, \"lookfrom\": [30, 18, 26] },\n"
    "  \"materials\": { \"clay\": { \"type\": \"lambertian\", \"albedo\": [0.7, 0.6, 0.5] } },\n"
    "  \"clouds\": [ { \"file\": \"%s.ply\", \"material\": \"clay\" } ]\n"
    "}\n";

static const char ball_document[] =
    "{\n"
    "  \"format\": 1,\n"
    "  \"title\": \"bench: %s\",\n"
    "  \"camera\": { \"image_width\": 400, \"aspect_ratio\": [16, 9], \"samples_per_pixel\": 64,\n"
    "              \"max_depth\": 50, \"vfov\": 30, \"lookfrom\": [2.4, 1.5, 2.6], \"lookat\": [0, 0, 0] },\n"
    "  \"materials\": { \"clay\": { \"type\": \"lambertian\", \"albedo\": [0.7, 0.6, 0.5] } },\n"
    "  \"triangles\": [\n";

/* The names that are measured when none is given, ended by NULL. */
static const char *const fixed_scene_names[] = {"cover", "diffuse", "glass", "field-1e4", "field-1e6", NULL};

/* The number of spheres of a field; 0: not a field. */
static uint64_t field_count(const char *name) {
    if (strncmp(name, "field-", 6) != 0 || name[6] < '1' || name[6] > '9') return 0;
    char *end = NULL;
    const double count = strtod(name + 6, &end);
    return *end == '\0' && count >= 1 && count <= BP_SPHERES_MAX ? (uint64_t)count : 0;
}

/* The number of triangles of a ball; 0: not a ball. */
static uint64_t ball_count(const char *name) {
    if (strncmp(name, "ball-", 5) != 0 || name[5] < '1' || name[5] > '9') return 0;
    char *end = NULL;
    const uint64_t count = strtoull(name + 5, &end, 10);
    return *end == '\0' && bp_ball_has(count) ? count : 0;
}

/* "cover", "diffuse", "glass", "field-" and a number of spheres ("field-1e6"), or "ball-" and one of
 * triangles. */
static bool is_fixed_scene(const char *name) {
    return strcmp(name, "cover") == 0 || strcmp(name, "diffuse") == 0 || strcmp(name, "glass") == 0 ||
           field_count(name) != 0 || ball_count(name) != 0;
}

static BpStatus join(const char *folder, const char *name, const char *ending, char *path, size_t size,
                     BpError *err) {
    const int length = snprintf(path, size, "%s/%s%s", folder, name, ending);
    if (length > 0 && (size_t)length < size) return BP_OK;
    return bp_fail(err, BP_ERR_FILE, "the name of the folder %.80s... is too long", folder);
}

static void make_matte(BpMaterial *material) {
    if (material->kind == BP_MATERIAL_DIELECTRIC)
        for (int k = 0; k < 3; ++k) material->albedo[k] = 0.9;
    material->kind = BP_MATERIAL_LAMBERTIAN;
    material->scatter = BP_SCATTER_LAMBERTIAN;
}

static void make_glass(BpMaterial *material) {
    material->kind = BP_MATERIAL_DIELECTRIC;
    material->refraction_index = 1.5;
    material->fresnel = BP_FRESNEL_SCHLICK;
    material->total_reflection = BP_TOTAL_REFLECT;
}

static BpStatus write_cover(const BpCommandLine *line, const char *name, const char *path, BpError *err) {
    BpScene *scene = NULL;
    BP_TRY(bp_line_check_output(line, path, err));
    BP_TRY(bp_scene_generate_cover("4", GRID, SEED, &scene, err));
    BpStatus status = bp_scene_set_width(scene, WIDTH, err);
    if (status != BP_OK) goto done;
    scene->camera.samples_per_pixel = SAMPLES;
    const uint32_t ground = scene->spheres[0].material;
    for (uint32_t m = 0; m < scene->material_count; ++m) {
        if (strcmp(name, "diffuse") == 0) make_matte(&scene->materials[m]);
        if (strcmp(name, "glass") == 0 && m != ground) make_glass(&scene->materials[m]);
    }
    bp_line_say_overwritten(line, path);
    status = bp_line_write_scene(line, path, scene, err);
done:
    bp_scene_destroy(&scene);
    return status;
}

static BpStatus print_field(const void *name, FILE *out, BpError *err) {
    return bp_field_print_ply(field_count(name), SEED, out, err);
}

static BpStatus print_field_document(const void *name, FILE *out, BpError *err) {
    if (fprintf(out, field_document, (const char *)name, (const char *)name) > 0) return BP_OK;
    return bp_fail(err, BP_ERR_FILE, "%s", strerror(errno));
}

static BpStatus write_field(const BpCommandLine *line, const char *name, const char *folder, const char *path,
                            BpError *err) {
    char cloud[4096];
    BP_TRY(join(folder, name, ".ply", cloud, sizeof cloud, err));
    if (access(cloud, R_OK) == 0 && access(path, R_OK) == 0) return BP_OK;
    BP_TRY(bp_line_check_output(line, cloud, err));
    BP_TRY(bp_line_check_output(line, path, err));
    bp_line_say_overwritten(line, cloud);
    bp_line_say_overwritten(line, path);
    BP_TRY(bp_line_write(line, cloud, print_field, name, err));
    return bp_line_write(line, path, print_field_document, name, err);
}

static BpStatus print_ball_document(const void *name, FILE *out, BpError *err) {
    fprintf(out, ball_document, (const char *)name);
    BP_TRY(bp_ball_print(ball_count(name), "clay", out, err));
    if (fputs("  ]\n}\n", out) >= 0) return BP_OK;
    return bp_fail(err, BP_ERR_FILE, "%s", strerror(errno));
}

static BpStatus write_ball(const BpCommandLine *line, const char *name, const char *path, BpError *err) {
    if (access(path, R_OK) == 0) return BP_OK;
    BP_TRY(bp_line_check_output(line, path, err));
    bp_line_say_overwritten(line, path);
    return bp_line_write(line, path, print_ball_document, name, err);
}

/* Writes the scene called `name` into `folder`, as NAME.json (a field: NAME.ply as well), and its path to
 * `path`. A field or a ball whose files are already there is left as it is, since it takes long. */
static BpStatus write_fixed_scene(const BpCommandLine *line, const char *name, const char *folder, char *path,
                                  size_t path_size, BpError *err) {
    BP_TRY(join(folder, name, ".json", path, path_size, err));
    if (ball_count(name) != 0) return write_ball(line, name, path, err);
    return field_count(name) != 0 ? write_field(line, name, folder, path, err)
                                  : write_cover(line, name, path, err);
}

/* ---- one timed run ----------------------------------------------------------------------------------- */

/* The measurements of each round, and their names in the document. Times are wall-clock seconds unless stated
 * otherwise. They are of a stretch of tracing that began when caches, clocks and the size of chunks had
 * settled. CPU: of all threads of this process; device: for a CPU device, the processor time that tracing
 * took. */
#define MEASURE_LIST(X)                                                                                      \
    X(LOAD, "load_seconds")                                                                                  \
    X(TREE, "tree_seconds")                                                                                  \
    X(KERNEL, "kernel_build_seconds")                                                                        \
    X(SAMPLES, "samples_per_second")                                                                         \
    X(SEGMENTS, "segments_per_second")                                                                       \
    X(SEGMENT, "nanoseconds_per_segment")                                                                    \
    X(SEGMENT_CPU, "cpu_nanoseconds_per_segment")                                                            \
    X(SEGMENT_DEVICE, "device_nanoseconds_per_segment")

enum {
#define MEASURE_ENUM(name, member) MEASURE_##name,
    MEASURE_LIST(MEASURE_ENUM)
#undef MEASURE_ENUM
        MEASURES
};
static const char *const measure_names[MEASURES] = {
#define MEASURE_NAME(name, member) member,
    MEASURE_LIST(MEASURE_NAME)
#undef MEASURE_NAME
};

/* One timed run of one scene, from file to samples. */
typedef struct Run {
    double values[MEASURES];
    uint64_t samples, segments;
    double mean[3], nrmse; /* of the whole run */
    size_t spheres, triangles;
    uint32_t width, height, max_depth;
    BpRenderReport report; /* its texts are not valid any more */
} Run;

/* Median and quartiles, by linear interpolation between order statistics (Hyndman and Fan 1996, type 7). */
typedef struct Figure {
    double median, low, high;
} Figure;

#define WARM_UP_SECONDS 0.2

/* Traces until every pixel has `samples`; all work is done when it returns. */
static BpStatus trace_to(BpRender *render, uint64_t samples, BpError *err) {
    BpProgress progress = {0};
    BP_TRY(bp_render_extend(render, samples, err));
    do {
        BP_TRY(bp_render_step(render, &progress, err));
        if (bp_interrupted())
            return bp_fail(err, BP_ERR_INTERRUPTED, "interrupted; incomplete measurements were discarded");
    } while (!progress.finished);
    return BP_OK;
}

/* The counts of a render are complete only after its film has been read. */
static BpStatus read_report(BpRender *render, BpRenderReport *report, const BpFilm **film, BpError *err) {
    BP_TRY(bp_render_read_film(render, film, err));
    bp_render_report(render, report);
    return BP_OK;
}

/* Seconds that tracing would take on an otherwise idle machine: for a CPU, the processor time divided by its
 * cores, so that other work on the machine does not shorten the measurement. */
static double own_seconds(const BpRenderReport *report, double wall, double cpu) {
    const double spread = cpu / fmax(1.0, report->device.compute_units);
    return report->device.type == BP_DEVICE_CPU ? fmin(wall, spread) : wall;
}

/* Only whole passes are timed, since the rows of a picture differ in cost. */
static BpStatus trace(BpRender *render, double seconds, Run *run, BpError *err) {
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
    BP_TRY(bp_film_check_valid(film, err)); /* broken paths have another speed */

    /* The last pass of the warm-up was samples / 2 + 1. */
    const double more = seconds / taken * (double)(samples / 2 + 1);
    const double start = bp_clock_seconds(), cpu_start = bp_processor_seconds();
    BP_TRY(trace_to(render, samples + (more > 1 ? (uint64_t)more : 1), err));
    const double spent = bp_clock_seconds() - start, cpu_spent = bp_processor_seconds() - cpu_start;
    BP_TRY(read_report(render, &run->report, &film, err));
    run->samples = run->report.samples - before.samples;
    run->segments = run->report.segments - before.segments;
    bp_film_mean(film, run->mean);
    run->nrmse = bp_film_nrmse(film);
    if (run->segments == 0)
        return bp_fail(err, BP_ERR_USAGE, "no rays to measure; use a --depth of at least 1");
    const double segments = (double)run->segments;
    run->values[MEASURE_TREE] = run->report.tree_seconds + run->report.pack_seconds;
    run->values[MEASURE_KERNEL] = run->report.kernel_build_seconds + run->report.first_launch_seconds;
    run->values[MEASURE_SAMPLES] = (double)run->samples / spent;
    run->values[MEASURE_SEGMENTS] = segments / spent;
    run->values[MEASURE_SEGMENT] = 1e9 * spent / segments;
    run->values[MEASURE_SEGMENT_CPU] = 1e9 * cpu_spent / segments;
    run->values[MEASURE_SEGMENT_DEVICE] =
        1e9 * (run->report.device_seconds - before.device_seconds) / segments;
    return BP_OK;
}

/* Loads, builds, warms up, traces for about `seconds`. */
static BpStatus run_once(const BpCommandLine *line, const char *path, const BpDeviceInfo *devices,
                         size_t device_count, double seconds, Run *run, BpError *err) {
    BpScene *scene = NULL;
    BpRender *render = NULL;
    BpRenderOptions options;
    *run = (Run){0};

    const double start = bp_clock_seconds();
    BpStatus status = bp_setup_scene(line, path, &scene, err);
    if (status != BP_OK) goto done;
    run->values[MEASURE_LOAD] = bp_clock_seconds() - start;
    run->spheres = scene->sphere_count;
    run->triangles = scene->triangle_count;
    run->width = scene->camera.width;
    run->height = scene->camera.height;

    BP_TRY_GOTO(status, bp_setup_options(line, scene, &options, err), done);
    options.samples_per_pixel = 1; /* more follow */
    run->max_depth = options.max_depth;
    BP_TRY_GOTO(status, bp_render_create(scene, &options, devices, device_count, &render, err), done);
    status = trace(render, seconds, run, err);
done:
    bp_render_destroy(&render);
    bp_scene_destroy(&scene);
    return status;
}

/* ---- all scenes, round after round ------------------------------------------------------------------- */

#define ROUNDS_DEFAULT 5u
#define ROUNDS_MAX 1000u    /* --rounds */
#define SECONDS_DEFAULT 5.0 /* of tracing, a scene */

typedef struct Entry {
    const char *name; /* as asked for */
    bool fixed;       /* written by us */
    char path[4096];
    Run *runs; /* one a round */
} Entry;

typedef struct Bench {
    Entry *entries;
    size_t count;
    uint32_t rounds;
    const char *folder; /* where fixed scenes stand: --output, or our own */
    BpTemporaryFolder own;
} Bench;

/* ---- figures of the rounds ---- */

static Figure figure(const Bench *bench, const Entry *entry, int measure) {
    double values[ROUNDS_MAX];
    const size_t count = bench->rounds;
    for (size_t r = 0; r < count; ++r) values[r] = entry->runs[r].values[measure];
    bp_sort_doubles(values, count);
    return (Figure){bp_quantile(values, count, 0.5), bp_quantile(values, count, 0.25),
                    bp_quantile(values, count, 0.75)};
}

static size_t shapes(const Entry *entry) {
    return entry->runs[0].spheres + entry->runs[0].triangles;
}

/* Or of a triangle. */
static double bytes_per_sphere(const Entry *entry) {
    return shapes(entry) > 0 ? (double)entry->runs[0].report.scene_bytes / (double)shapes(entry) : 0.0;
}

/* ---- the table ---- */

/* "1.23 ms": three digits and a unit. */
static const char *short_time(double seconds, char *text, size_t size) {
    const char *unit = seconds < 1.0 ? "ms" : "s";
    const double value = seconds < 1.0 ? 1e3 * seconds : seconds;
    snprintf(text, size, "%.*f %s", value < 9.995 ? 2 : value < 99.95 ? 1 : 0, value, unit);
    return text;
}

enum { COLUMNS = 11 };

static void fill_row(const Bench *bench, const Entry *entry, const BpTable *table, size_t row) {
    const Figure segments = figure(bench, entry, MEASURE_SEGMENTS);
    const size_t size = BP_CELL_SIZE;
    bp_escape(entry->name, bp_table_cell(table, row, 0), size);
    bp_format_whole(shapes(entry), bp_table_cell(table, row, 1), size);
    short_time(figure(bench, entry, MEASURE_LOAD).median, bp_table_cell(table, row, 2), size);
    short_time(figure(bench, entry, MEASURE_TREE).median, bp_table_cell(table, row, 3), size);
    short_time(figure(bench, entry, MEASURE_KERNEL).median, bp_table_cell(table, row, 4), size);
    snprintf(bp_table_cell(table, row, 5), size, "%.2f", 1e-6 * figure(bench, entry, MEASURE_SAMPLES).median);
    snprintf(bp_table_cell(table, row, 6), size, "%.2f", 1e-6 * segments.median);
    snprintf(bp_table_cell(table, row, 7), size, "%.1f", figure(bench, entry, MEASURE_SEGMENT).median);
    snprintf(bp_table_cell(table, row, 8), size, "%.1f", figure(bench, entry, MEASURE_SEGMENT_CPU).median);
    snprintf(bp_table_cell(table, row, 9), size, "%.0f %%",
             100.0 * (segments.high - segments.low) / segments.median);
    snprintf(bp_table_cell(table, row, 10), size, "%.0f", bytes_per_sphere(entry));
}

static BpStatus print_table(const BpCommandLine *line, const Bench *bench, BpError *err) {
    static const char *const head[COLUMNS] = {"scene",  "shapes",     "load",        "tree",
                                              "kernel", "Msamples/s", "Msegments/s", "ns/segm.",
                                              "CPU ns", "spread",     "B/sphere"};
    static const bool right[COLUMNS] = {false, true, true, true, true, true, true, true, true, true, true};
    const BpRenderReport *report = &bench->entries[0].runs[0].report;
    BpTable table;
    BpPage page;
    if (!bp_table_make(&table, COLUMNS, bench->count + 1, right))
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a table of %zu scenes", bench->count);
    for (size_t c = 0; c < COLUMNS; ++c) snprintf(bp_table_cell(&table, 0, c), BP_CELL_SIZE, "%s", head[c]);
    for (size_t i = 0; i < bench->count; ++i) fill_row(bench, &bench->entries[i], &table, i + 1);
    bp_page_begin(&page, stdout);
    bp_print_escaped(report->device.name, false, page.text);
    fputs(", ", page.text);
    bp_print_escaped(report->device.platform, false, page.text);
    fprintf(page.text, "; %s kernel, %s, %s numerics, %s math\n", bp_kernel_names[report->kernel],
            bp_precision_names[report->precision], bp_numerics_names[report->numerics],
            bp_math_names[report->math]);
    bp_table_print(&table, bp_page_columns(line, stdout), page.text);
    fprintf(page.text,
            "medians of %u round%s; spread: between the quartiles; CPU ns: processor time per segment, all "
            "threads\n",
            bench->rounds, bp_plural(bench->rounds));
    bp_page_end(&page, line, stdout);
    free(table.cells);
    if (fflush(stdout) != 0 || ferror(stdout))
        return bp_fail(err, BP_ERR_FILE, "cannot write to standard output: %s", strerror(errno));
    return BP_OK;
}

/* ---- JSON ---- */

static json_t *figure_json(const Bench *bench, const Entry *entry, int measure) {
    const Figure f = figure(bench, entry, measure);
    json_t *values = json_array();
    for (size_t r = 0; r < bench->rounds && values != NULL; ++r)
        json_array_append_new(values, json_real(entry->runs[r].values[measure]));
    return json_pack("{s:f, s:f, s:f, s:o}", "median", f.median, "low", f.low, "high", f.high, "rounds",
                     values);
}

static json_t *entry_json(const Bench *bench, const Entry *entry) {
    const Run *run = &entry->runs[0];
    uint64_t samples = 0, segments = 0;
    for (size_t r = 0; r < bench->rounds; ++r) {
        samples += entry->runs[r].samples;
        segments += entry->runs[r].segments;
    }
    json_t *nrmse = isfinite(run->nrmse) ? json_real(run->nrmse) : json_null();
    json_t *json = json_pack("{s:o, s:o, s:I, s:I, s:I, s:I, s:I}", "name", bp_json_text(entry->name), "path",
                             bp_json_text(entry->path), "spheres", (json_int_t)run->spheres, "triangles",
                             (json_int_t)run->triangles, "width", (json_int_t)run->width, "height",
                             (json_int_t)run->height, "max_depth", (json_int_t)run->max_depth);
    for (int m = 0; m < MEASURES; ++m)
        json = bp_json_join(json, json_pack("{s:o}", measure_names[m], figure_json(bench, entry, m)));
    return bp_json_join(json, json_pack("{s:f, s:I, s:f, s:[fff], s:o, s:I}", "segments_per_sample",
                                        (double)segments / (double)samples, "scene_bytes",
                                        (json_int_t)run->report.scene_bytes, "bytes_per_sphere",
                                        bytes_per_sphere(entry), "mean_radiance", run->mean[0], run->mean[1],
                                        run->mean[2], "nrmse", nrmse, "invalid_samples",
                                        (json_int_t)run->report.invalid_samples));
}

static BpStatus write_json(const BpCommandLine *line, const Bench *bench, BpError *err) {
    const BpRenderReport *report = &bench->entries[0].runs[0].report;
    json_t *scenes = json_array();
    for (size_t i = 0; i < bench->count; ++i) {
        if (json_array_append_new(scenes, entry_json(bench, &bench->entries[i])) == 0) continue;
        json_decref(scenes);
        return bp_json_write(line, NULL, line->json, err);
    }
    json_t *root =
        json_pack("{s:s, s:{s:o, s:o, s:o, s:s}}", "version", bp_version(), "device", "platform",
                  bp_json_text(report->device.platform), "name", bp_json_text(report->device.name), "driver",
                  bp_json_text(report->device.driver), "type", bp_device_type_names[report->device.type]);
    root = bp_json_join(root, bp_report_settings(report));
    root = bp_json_join(root, json_pack("{s:i, s:o}", "rounds", (int)bench->rounds, "scenes", scenes));
    return bp_json_write(line, root, line->json, err);
}

/* ---- the command ---- */

/* The folder of the fixed scenes: --output, made if it is not there; or one of our own. */
static BpStatus open_folder(const BpCommandLine *line, Bench *bench, BpError *err) {
    bench->folder = line->output != NULL ? line->output : bench->own.path;
    if (line->output == NULL) return bp_temporary_folder_make(&bench->own, err);
    if (mkdir(line->output, 0777) != 0 && errno != EEXIST)
        return bp_fail(err, BP_ERR_FILE, "cannot create the folder %s: %s", line->output, strerror(errno));
    return BP_OK;
}

static BpStatus prepare(const BpCommandLine *line, Bench *bench, BpError *err) {
    size_t fixed_count = 0;
    while (fixed_scene_names[fixed_count] != NULL) ++fixed_count;
    bench->count = line->operand_count > 0 ? line->operand_count : fixed_count;
    bench->entries = calloc(bench->count, sizeof *bench->entries);
    if (bench->entries == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the list of scenes");
    bench->rounds = line->rounds != 0 ? line->rounds : ROUNDS_DEFAULT;
    for (size_t i = 0; i < bench->count; ++i) {
        Entry *entry = &bench->entries[i];
        entry->runs = calloc(bench->rounds, sizeof *entry->runs);
        if (entry->runs == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the rounds");
        entry->name = line->operand_count > 0 ? line->operands[i] : fixed_scene_names[i];
        entry->fixed = is_fixed_scene(entry->name);
        if (strcmp(entry->name, "-") == 0)
            return bp_fail(err, BP_ERR_USAGE,
                           "ballpark bench: expected a file, found \"-\" (standard input), which cannot be "
                           "read again in every round");
        if (!entry->fixed) {
            if (access(entry->name, F_OK) != 0 && errno == ENOENT)
                return bp_fail(
                    err, BP_ERR_USAGE,
                    "%.400s: no such file, and no fixed scene has this name; those are cover, diffuse, "
                    "glass and field-N, such as field-1e6; and ball-N, such as ball-81920",
                    entry->name);
            snprintf(entry->path, sizeof entry->path, "%s", entry->name);
            continue;
        }
        if (bench->folder == NULL) BP_TRY(open_folder(line, bench, err));
        BP_TRY(write_fixed_scene(line, entry->name, bench->folder, entry->path, sizeof entry->path, err));
        if (line->output != NULL) bp_say(line, "%s: the scene %s", entry->path, entry->name);
    }
    return BP_OK;
}

static BpStatus run_rounds(const BpCommandLine *line, Bench *bench, BpError *err) {
    const double seconds = bp_option_given(line, BP_OPTION_TIME) ? line->time_seconds : SECONDS_DEFAULT;
    BpDeviceInfo *devices = NULL;
    size_t device_count = 0;
    BpStatus status = bp_setup_devices(line, &devices, &device_count, err);
    bp_interrupt_catch();
    for (size_t r = 0; r < bench->rounds && status == BP_OK; ++r) {
        for (size_t i = 0; i < bench->count && status == BP_OK; ++i) {
            Entry *entry = &bench->entries[i];
            bp_say(line, "round %zu of %u: %s", r + 1, bench->rounds, entry->name);
            status = run_once(line, entry->path, devices, device_count, seconds / bench->rounds,
                              &entry->runs[r], err);
        }
        if (r == 0 && status == BP_OK) bp_line_say_overwritten(line, line->json); /* all can be measured */
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
    if (line->json != NULL) BP_TRY(bp_line_check_output(line, line->json, err));
    BP_TRY_GOTO(status, prepare(line, &bench, err), done);
    if (line->output != NULL) goto done; /* the scenes were wanted, not figures */
    BP_TRY_GOTO(status, run_rounds(line, &bench, err), done);
    if (line->json != NULL) status = write_json(line, &bench, err);
    /* The figures are not lost with the document. */
    if (line->json == NULL || strcmp(line->json, "-") != 0) {
        const BpStatus printed = print_table(line, &bench, status == BP_OK ? err : NULL);
        if (status == BP_OK) status = printed;
    }
done:
    clear(&bench);
    return status;
}
