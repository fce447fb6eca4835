/* unseen_truth.c: how noisy pictures of a scene are in truth, from very many samples.
 *
 *     unseen_truth SCENE.json SECONDS [ENLARGED.json FACTOR]     prints one JSON object
 *
 * In:    a scene; about how many seconds its long renders may take; the same scene with lamps and discs that
 *        are FACTOR times as wide, of the same radiance.   Out: the variance of one sample, the mean, and the
 *        noise of pictures of 16, 64, 256 and 1024 samples per pixel.
 * Knows: what the library says of pictures: their radiance.   Does not know: what the library claims of their
 *        noise, since that is what is judged by this.
 *
 * The variance of one sample is that of RUNS renders with different seeds and independent samples, times
 * their samples per pixel, averaged over pixels: it holds light that only one sample in millions finds. The
 * renders double their samples until the variance is known to `wanted`, or time is up; its standard error is
 * a jackknife over the renders.
 *
 * Light that is found by chance alone brings the variance c^2 p, where p is in proportion to the area of the
 * lamp, and c to its radiance. So a lamp that is FACTOR times as wide has FACTOR^2 times as much of it, apart
 * from what changes across the lamp, and is known that many times sooner. What all pictures see, such as the
 * light that rays to lamps find, grows by FACTOR^4; it is subtracted, and must be small.
 *
 * A picture of few samples by Sobol's sequence has less noise from what samples find often, and just as much
 * from what they find by chance. So where SEEDS such pictures hold enough of the rare light, their spread is
 * the truth. Where they do not, it is the variance of one sample over the number of samples, with the part
 * that all pictures see replaced by that of the sequence. This part is taken from the pairs of pictures that
 * differ least, as these hold no rare light. */
#include "support/open_render.h"

#include "base/color.h"
#include "scene/scene.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { RUNS = 128, SEEDS = 48, PLAIN_SEEDS = 24, COUNTS = 4 };
static const uint64_t counts[COUNTS] = {16, 64, 256, 1024};
static const double wanted = 0.04;       /* relative standard error of the variance */
static const double direct_enough = 0.1; /* the same, above which a scene with wider lamps is taken */
static const double enough_finds = 50.0; /* effective finds of rare light that a spread needs */
static const uint64_t samples_first = 256, samples_last = 1u << 22;

static void must(BpStatus status, const BpError *err) {
    if (status == BP_OK) return;
    fprintf(stderr, "unseen_truth: %s\n", err->message);
    exit(1);
}

static double seconds_now(void) {
    struct timespec now;
    timespec_get(&now, TIME_UTC);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void *allocated(size_t count, size_t size) {
    void *memory = calloc(count, size);
    if (memory == NULL) {
        fprintf(stderr, "unseen_truth: out of memory\n");
        exit(1);
    }
    return memory;
}

static BpRender *open_render(const BpScene *scene, BpSampler sampler, uint64_t seed, uint64_t samples) {
    BpRenderOptions options;
    BpRender *render = NULL;
    BpError err = {0};
    bp_render_defaults(scene, &options);
    options.sampler = sampler;
    options.seed = seed;
    options.samples_per_pixel = samples;
    options.caustics = BP_CAUSTICS_OFF;
    must(open_render_on_device(scene, &options, &render, &err), &err);
    return render;
}

/* The luminance of each pixel, after the render has been brought to `samples`. */
static void read_luminance(BpRender *render, uint64_t samples, double *luminance) {
    BpError err = {0};
    BpProgress progress = {0};
    BpPicture picture = {0};
    if (bp_render_samples_done(render) > 0) must(bp_render_extend(render, samples, &err), &err);
    while (!progress.finished) must(bp_render_step(render, &progress, &err), &err);
    must(bp_render_read(render, &picture, &err), &err);
    const size_t pixels = (size_t)picture.width * picture.height;
    for (size_t p = 0; p < pixels; p++) {
        luminance[p] = 0;
        for (size_t c = 0; c < 3; c++)
            luminance[p] += bp_luminance_weights[c] * (double)picture.rgb[3 * p + c];
    }
    bp_picture_clear(&picture);
}

/* Mean over pixels of the variance between pictures, `left_out` not counted. */
static double spread(double *const *pictures, size_t count, size_t pixels, size_t left_out) {
    double sum = 0;
    for (size_t p = 0; p < pixels; p++) {
        double mean = 0, squares = 0, used = 0;
        for (size_t s = 0; s < count; s++) {
            if (s == left_out) continue;
            used++;
            const double apart = pictures[s][p] - mean;
            mean += apart / used;
            squares += apart * (pictures[s][p] - mean);
        }
        sum += squares / (used - 1);
    }
    return sum / (double)pixels;
}

static double jackknife(double *const *pictures, size_t count, size_t pixels) {
    const double all = spread(pictures, count, pixels, count);
    double squares = 0;
    for (size_t s = 0; s < count; s++) {
        const double apart = spread(pictures, count, pixels, s) - all;
        squares += apart * apart;
    }
    return sqrt(squares * (double)(count - 1) / (double)count);
}

/* The square of the relative standard error that spread() would have if pictures were normally distributed:
 * what is more than that comes from finds that are rare. */
static double normal_uncertainty(double *const *pictures, size_t count, size_t pixels) {
    double sum = 0, squares = 0;
    for (size_t p = 0; p < pixels; p++) {
        double mean = 0, apart = 0;
        for (size_t s = 0; s < count; s++) mean += pictures[s][p] / (double)count;
        for (size_t s = 0; s < count; s++) apart += (pictures[s][p] - mean) * (pictures[s][p] - mean);
        sum += apart;
        squares += apart * apart;
    }
    const double freedom = (double)(count - 1);
    return 2 / (freedom + 2) * squares / (sum * sum);
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The variance of what all pictures see: half the mean squared difference of two pictures, which is that much
 * or less for a tenth of the pairs. Even if every picture holds a find of rare light on average, a tenth of
 * the pairs holds none. */
static double common_spread(double *const *pictures, size_t count, size_t pixels) {
    double *halves = allocated(count * (count - 1) / 2, sizeof *halves);
    size_t pairs = 0;
    for (size_t s = 0; s < count; s++)
        for (size_t t = 0; t < s; t++) {
            double sum = 0;
            for (size_t p = 0; p < pixels; p++) {
                const double apart = pictures[s][p] - pictures[t][p];
                sum += 0.5 * apart * apart;
            }
            halves[pairs++] = sum / (double)pixels;
        }
    qsort(halves, pairs, sizeof *halves, ascending);
    const double tenth = halves[pairs / 10];
    free(halves);
    return tenth;
}

static double **pictures_of(size_t count, size_t pixels) {
    double **pictures = allocated(count, sizeof *pictures);
    for (size_t s = 0; s < count; s++) pictures[s] = allocated(pixels, sizeof **pictures);
    return pictures;
}

static void free_pictures(double **pictures, size_t count) {
    for (size_t s = 0; s < count; s++) free(pictures[s]);
    free(pictures);
}

typedef struct Sample {
    double variance, variance_error, mean, mean_error, samples;
    double finds; /* effective number of those that the variance rests on, for each sample */
} Sample;

/* One sample: many long renders with independent samples. `means`: Optional; receives the mean of each pixel.
 */
static Sample measure_sample(const BpScene *scene, size_t pixels, double seconds, double *means) {
    Sample sample = {0};
    BpRender *renders[RUNS];
    double **pictures = pictures_of(RUNS, pixels);
    const double begin = seconds_now();
    double passed = 0;
    uint64_t samples = samples_first;
    for (size_t r = 0; r < RUNS; r++)
        renders[r] = open_render(scene, BP_SAMPLER_INDEPENDENT, 7000 + r, samples);
    for (;; samples *= 2) {
        for (size_t r = 0; r < RUNS; r++) read_luminance(renders[r], samples, pictures[r]);
        sample.variance = (double)samples * spread(pictures, RUNS, pixels, RUNS);
        sample.variance_error = (double)samples * jackknife(pictures, RUNS, pixels);
        passed = seconds_now() - begin;
        if (sample.variance_error <= wanted * sample.variance && samples > samples_first) break;
        if (2 * passed > seconds || samples >= samples_last) break;
    }
    sample.samples = (double)samples * RUNS * (double)pixels;
    const double certain = sample.variance_error / sample.variance;
    const double by_chance = certain * certain - normal_uncertainty(pictures, RUNS, pixels);
    sample.finds = 1 / fmax(by_chance, 0.1 * certain * certain) / sample.samples;
    double squares = 0;
    for (size_t r = 0; r < RUNS; r++) {
        double mean = 0;
        for (size_t p = 0; p < pixels; p++) {
            mean += pictures[r][p] / (double)pixels;
            if (means != NULL) means[p] += pictures[r][p] / RUNS;
        }
        const double apart = mean - sample.mean;
        sample.mean += apart / (double)(r + 1);
        squares += apart * (mean - sample.mean);
        bp_render_destroy(&renders[r]);
    }
    sample.mean_error = sqrt(squares / (RUNS - 1) / RUNS);
    free_pictures(pictures, RUNS);
    return sample;
}

/* Pictures of `count` seeds at each number of samples, [n][seed][pixel], from the first samples of each seed.
 * Where `mean` is given, the truth about each pixel, squares[n][seed] becomes the mean squared error, over
 * all blocks of that many samples in turn of the seed's last number: blocks of a power of two are as evenly
 * spread as the first. */
static void measure_pictures(const BpScene *scene, BpSampler sampler, size_t count, size_t pixels,
                             double **pictures[COUNTS], const double *mean, double *squares[COUNTS]) {
    double *now = allocated(pixels, sizeof *now), *before[COUNTS];
    for (size_t n = 0; n < COUNTS; n++) before[n] = allocated(pixels, sizeof *before[n]);
    for (size_t s = 0; s < count; s++) {
        BpRender *render = open_render(scene, sampler, 500 + s, counts[0]);
        const uint64_t step = mean != NULL ? counts[0] : 1;
        for (uint64_t samples = counts[0]; samples <= counts[COUNTS - 1]; samples += step) {
            bool asked = mean != NULL;
            for (size_t n = 0; n < COUNTS; n++) asked |= samples == counts[n];
            if (!asked) continue;
            read_luminance(render, samples, now);
            for (size_t n = 0; n < COUNTS; n++) {
                if (samples == counts[n]) memcpy(pictures[n][s], now, pixels * sizeof *now);
                if (mean == NULL || samples % counts[n] != 0) continue;
                const double size = (double)counts[n], end = (double)samples;
                const double blocks = (double)(counts[COUNTS - 1] / counts[n]);
                for (size_t p = 0; p < pixels; p++) {
                    const double past = samples == counts[n] ? 0 : before[n][p] * (end - size);
                    const double apart = (now[p] * end - past) / size - mean[p];
                    squares[n][s] += apart * apart / (double)pixels / blocks;
                    before[n][p] = now[p];
                }
            }
        }
        bp_render_destroy(&render);
    }
    for (size_t n = 0; n < COUNTS; n++) free(before[n]);
    free(now);
}

/* Mean and its standard error, of values that differ by chance. */
static double mean_of(const double *values, size_t count, double *error) {
    double mean = 0, squares = 0;
    for (size_t i = 0; i < count; i++) mean += values[i] / (double)count;
    for (size_t i = 0; i < count; i++) squares += (values[i] - mean) * (values[i] - mean);
    *error = sqrt(squares / (double)(count - 1) / (double)count);
    return mean;
}

static BpScene *load(const char *path) {
    BpScene *scene = NULL;
    BpError err = {0};
    must(bp_scene_load(path, &scene, &err), &err);
    return scene;
}

int main(int argc, char **argv) {
    if (argc != 3 && argc != 5) {
        fprintf(stderr, "usage: unseen_truth SCENE.json SECONDS [ENLARGED.json FACTOR]\n");
        return 2;
    }
    BpScene *scene = load(argv[1]);
    BpSceneInfo info;
    bp_scene_info(scene, &info);
    const size_t pixels = (size_t)info.width * info.height;
    double **sobol[COUNTS], **plain[COUNTS];
    double *means = allocated(pixels, sizeof *means), *squares[COUNTS];
    for (size_t n = 0; n < COUNTS; n++) {
        squares[n] = allocated(SEEDS, sizeof *squares[n]);
        sobol[n] = pictures_of(SEEDS, pixels);
        plain[n] = pictures_of(PLAIN_SEEDS, pixels);
    }
    Sample sample = measure_sample(scene, pixels, strtod(argv[2], NULL), means);
    measure_pictures(scene, BP_SAMPLER_SOBOL, SEEDS, pixels, sobol, means, squares);
    measure_pictures(scene, BP_SAMPLER_INDEPENDENT, PLAIN_SEEDS, pixels, plain, NULL, NULL);
    const double means_square =
        sample.variance / (sample.samples / (double)pixels); /* of the truth about a pixel */
    /* Few samples hold the least rare light. */
    const double common_sample = (double)counts[0] * common_spread(plain[0], PLAIN_SEEDS, pixels);
    double subtracted = 0;
    printf("{ \"directly\": [%.5g, %.2g], ", sample.variance, sample.variance_error);
    if (argc == 5 && sample.variance_error > direct_enough * sample.variance) {
        BpScene *enlarged = load(argv[3]);
        const double area = strtod(argv[4], NULL) * strtod(argv[4], NULL);
        const Sample easier = measure_sample(enlarged, pixels, strtod(argv[2], NULL), NULL);
        subtracted = area * area * common_sample / easier.variance;
        sample.variance = (easier.variance - area * area * common_sample) / area + common_sample;
        sample.variance_error = easier.variance_error / area;
        sample.finds = easier.finds / area;
        sample.samples = easier.samples;
        bp_scene_destroy(&enlarged);
    }
    printf("\"variance\": [%.5g, %.2g], \"subtracted\": %.2g, \"mean\": [%.6g, %.2g], "
           "\"traced\": %.3g, \"finds\": %.3g, \"pictures\": [",
           sample.variance, sample.variance_error, subtracted, sample.mean, sample.mean_error, sample.samples,
           sample.finds);
    const bool seen = sample.finds * SEEDS * (double)counts[COUNTS - 1] * (double)pixels >= enough_finds;
    for (size_t n = 0; n < COUNTS; n++) {
        const double count = (double)counts[n];
        const double common = common_spread(sobol[n], SEEDS, pixels);
        double error;
        const double direct = fmax(mean_of(squares[n], SEEDS, &error) - means_square, 0);
        const double rare = fmax(sample.variance - common_sample, 0) / count;
        const double truth = seen ? direct : rare + common;
        if (!seen) error = sample.variance_error / count;
        printf("%s{\"samples\": %.0f, \"noise\": %.4g, \"error\": %.2g, \"common\": %.4g, \"spread\": %.4g}",
               n == 0 ? "" : ", ", count, sqrt(truth) / sample.mean, 0.5 * error / sqrt(truth) / sample.mean,
               sqrt(common) / sample.mean, sqrt(direct) / sample.mean);
    }
    printf("], \"way\": \"%s\" }\n", seen ? "spread" : "rare");
    for (size_t n = 0; n < COUNTS; n++) {
        free(squares[n]);
        free_pictures(sobol[n], SEEDS);
        free_pictures(plain[n], PLAIN_SEEDS);
    }
    free(means);
    bp_scene_destroy(&scene);
    return 0;
}
