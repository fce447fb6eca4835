/* accuracy_runs.c: renders a scene in several ways, seed after seed, and prints for each its error and its
 * time.
 *
 * In:    accuracy_runs SCENE WIDTH REFERENCE_SAMPLES SAMPLES:SEEDS...
 * Out:   one line of JSON a run, on standard output; scripts/accuracy makes figures of them.
 * Knows: libballpark.   Does not know: what the figures are for.
 *
 * All ways take turns within a seed, so that what else the machine does hits them alike. The error is that of
 * luminance, the mean over pixels of (x - r1)(x - r2) with two references of other seeds: free of their
 * noise. */
#include "../host/base/clock.h"
#include "../host/base/color.h"
#include "../tests/support/distributions.h"
#include "render/render.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct Way {
    const char *name;
    BpSampler sampler;
    uint32_t replicates; /* 1: no error bar */
    bool adaptive;
} Way;

static const Way ways[] = {
    {"independent", BP_SAMPLER_INDEPENDENT, 4, false}, {"sobol", BP_SAMPLER_SOBOL, 4, false},
    {"adaptive", BP_SAMPLER_SOBOL, 4, true},           {"sobol K=1", BP_SAMPLER_SOBOL, 1, false},
    {"sobol K=2", BP_SAMPLER_SOBOL, 2, false},         {"sobol K=8", BP_SAMPLER_SOBOL, 8, false},
    {"sobol K=16", BP_SAMPLER_SOBOL, 16, false},
};
enum { WAYS = sizeof ways / sizeof ways[0] };

typedef struct Run {
    double processor, wall, device, accumulate; /* seconds */
    uint64_t samples, rays;
    double *luminance, *error; /* of each pixel: mean, and its standard error */
} Run;

static void must(BpStatus status, const BpError *err) {
    if (status == BP_OK) return;
    fprintf(stderr, "accuracy_runs: %s\n", err->message);
    exit(EXIT_FAILURE);
}

static void read_pixels(const BpFilm *film, bool with_error, Run *run) {
    const size_t pixels = (size_t)film->width * film->height;
    BpPicture picture;
    BpError err = {0};
    must(bp_film_picture(film, &picture, &err), &err);
    run->luminance = calloc(pixels, sizeof *run->luminance);
    run->error = calloc(pixels, sizeof *run->error);
    if (run->luminance == NULL || run->error == NULL) exit(EXIT_FAILURE);
    BpUnseenWeights weights;
    bp_unseen_weigh(film, &weights);
    for (size_t p = 0; p < pixels; ++p) {
        for (size_t c = 0; c < 3; ++c)
            run->luminance[p] += bp_luminance_weights[c] * (double)picture.rgb[3 * p + c];
        run->error[p] = with_error ? sqrt(bp_film_squared_error(film, &weights, p)) : NAN;
    }
    bp_picture_clear(&picture);
}

/* Renders, and reads the sums; with an error bar, the picture's error too, as a stop rule would. */
static Run render(const BpScene *scene, const Way *way, uint64_t seed, uint64_t samples) {
    BpRenderOptions options;
    BpRender *made = NULL;
    BpProgress progress = {0};
    const BpFilm *film = NULL;
    BpRenderReport report;
    BpError err = {0};
    bp_render_defaults(scene, &options);
    options.sampler = way->sampler;
    options.replicates = way->replicates;
    options.adaptive = way->adaptive;
    options.seed = seed;
    options.samples_per_pixel = samples;
    must(bp_render_create(scene, &options, NULL, 0, &made, &err), &err);
    const double wall = bp_clock_seconds(), processor = bp_processor_seconds();
    while (!progress.finished) must(bp_render_step(made, &progress, &err), &err);
    must(bp_render_read_film(made, &film, &err), &err);
    const double nrmse = way->replicates > 1 ? bp_film_nrmse(film) : 0;
    Run run = {.processor = bp_processor_seconds() - processor, .wall = bp_clock_seconds() - wall};
    if (nrmse < 0) exit(EXIT_FAILURE); /* so that it is not left out */
    bp_render_report(made, &report);
    run.device = report.device_seconds;
    run.accumulate = report.accumulate_seconds;
    run.samples = report.samples;
    run.rays = report.segments;
    read_pixels(film, way->replicates > 1, &run);
    bp_render_destroy(&made);
    return run;
}

static void clear(Run *run) {
    free(run->luminance);
    free(run->error);
}

static void print_run(const Run *run, const Run references[2], size_t pixels, const Way *way, uint64_t seed,
                      uint64_t samples) {
    const double t = way->replicates > 1 ? student_upper_quantile(0.025, way->replicates - 1) : NAN;
    double error = 0, claimed = 0, mean = 0;
    size_t held = 0, asked = 0;
    for (size_t p = 0; p < pixels; ++p) {
        const double x = run->luminance[p], r1 = references[0].luminance[p], r2 = references[1].luminance[p];
        const double truth = 0.5 * (r1 + r2);
        error += (x - r1) * (x - r2) / (double)pixels;
        mean += truth / (double)pixels;
        if (way->replicates < 2) continue;
        claimed += run->error[p] * run->error[p] / (double)pixels;
        if (!(run->error[p] > 1e-6 * truth)) continue; /* no noise to speak of */
        ++asked;
        held += fabs(x - truth) <= t * run->error[p];
    }
    printf(
        "{\"way\": \"%s\", \"replicates\": %u, \"samples\": %llu, \"seed\": %llu, \"mean\": %.9g, \"error\": "
        "%.9g, \"claimed\": %.9g, \"held\": %zu, \"asked\": %zu, \"processor\": %.6f, \"wall\": %.6f, "
        "\"device\": %.6f, \"fold\": %.6f, \"drawn\": %llu, \"rays\": %llu}\n",
        way->name, way->replicates, (unsigned long long)samples, (unsigned long long)seed, mean, error,
        claimed, held, asked, run->processor, run->wall, run->device, run->accumulate,
        (unsigned long long)run->samples, (unsigned long long)run->rays);
    fflush(stdout);
}

int main(int argc, char **argv) {
    if (argc < 5) {
        fprintf(stderr, "usage: accuracy_runs SCENE WIDTH REFERENCE_SAMPLES SAMPLES:SEEDS...\n");
        return 2;
    }
    BpScene *scene = NULL;
    BpError err = {0};
    BpSceneInfo info;
    must(bp_scene_load(argv[1], &scene, &err), &err);
    must(bp_scene_set_width(scene, (uint32_t)strtoul(argv[2], NULL, 10), &err), &err);
    bp_scene_info(scene, &info);
    const size_t pixels = (size_t)info.width * info.height;
    const uint64_t reference_samples = strtoull(argv[3], NULL, 10);
    Run references[2];
    for (uint64_t r = 0; r < 2; ++r) references[r] = render(scene, &ways[1], 1000001 + r, reference_samples);
    for (size_t w = 0; w < WAYS; ++w) { /* so that no driver compiles in the runs that count */
        Run run = render(scene, &ways[w], 0, 32);
        clear(&run);
    }
    for (int argument = 4; argument < argc; ++argument) {
        char *colon = NULL;
        const uint64_t samples = strtoull(argv[argument], &colon, 10);
        const uint64_t seeds = *colon == ':' ? strtoull(colon + 1, NULL, 10) : 1;
        for (uint64_t seed = 0; seed < seeds; ++seed)
            for (size_t w = 0; w < WAYS; ++w) {
                /* Every seed begins with another way. */
                const Way *way = &ways[(w + seed) % WAYS];
                Run run = render(scene, way, seed, samples);
                print_run(&run, references, pixels, way, seed, samples);
                clear(&run);
            }
    }
    for (int r = 0; r < 2; ++r) clear(&references[r]);
    bp_scene_destroy(&scene);
    return 0;
}
