/* check.c: see check.h. */
#include "check.h"

#include "base/clock.h"
#include "base/status.h"
#include "film/film.h"
#include "reference/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define STEP_SECONDS 0.3
#define FIRST_ROUND 16u /* samples per pixel, where time is limited */

/* What both sides had at the end of a round. */
typedef struct Round {
    uint64_t samples; /* per pixel; 0: no round is over */
    BpSums kernel, reference;
    uint64_t cut_kernel, cut_reference;
    double picture_off;
} Round;

struct BpCheck {
    const BpScene *scene;
    BpCheckOptions options;
    BpRender *render;
    double begun;
    uint64_t target;            /* samples per pixel at the end of this round */
    Round last;                 /* where time is limited */
    uint64_t reference_samples; /* done */
    uint64_t slice;             /* samples of the next step of the reference */
    bool kernel_done, finished;
    BpCheckResult result;
};

BpStatus bp_check_create(const BpScene *scene, const BpCheckOptions *options, struct BpDevice *device,
                         BpCheck **check_out, BpError *err) {
    *check_out = NULL;
    if (options->render.samples_per_pixel < 2)
        return bp_fail(err, BP_ERR_USAGE, "a check needs at least 2 samples per pixel to measure noise");
    if (options->render.sampler != BP_SAMPLER_INDEPENDENT)
        return bp_fail(err, BP_ERR_USAGE, "a check needs independent samples");
    BpCheck *check = calloc(1, sizeof *check);
    if (check == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a check");
    check->scene = scene;
    check->options = *options;
    check->slice = 1;
    check->begun = bp_clock_seconds();
    check->target = options->render.samples_per_pixel;
    if (options->seconds > 0 && check->target > FIRST_ROUND) check->target = FIRST_ROUND;
    BpRenderOptions first = options->render;
    first.samples_per_pixel = check->target;
    first.samples_only = true;
    const uint32_t width = scene->camera.width, height = scene->camera.height;
    BpStatus status = bp_sums_init(&check->result.kernel, width, height, err);
    if (status == BP_OK) status = bp_sums_init(&check->result.reference, width, height, err);
    if (status == BP_OK && options->seconds > 0)
        status = bp_sums_init(&check->last.kernel, width, height, err);
    if (status == BP_OK && options->seconds > 0)
        status = bp_sums_init(&check->last.reference, width, height, err);
    if (status == BP_OK)
        status = device != NULL ? bp_render_create_on(scene, &first, &device, 1, &check->render, err)
                                : bp_render_create(scene, &first, NULL, 0, &check->render, err);
    check->result.kernel.brightest = check->result.reference.brightest = bp_scene_radiance_bound(
        scene, first.max_depth, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, first.roulette);
    if (status != BP_OK) bp_check_destroy(&check);
    *check_out = check;
    return status;
}

void bp_check_destroy(BpCheck **check) {
    if (check == NULL || *check == NULL) return;
    bp_render_destroy(&(*check)->render);
    bp_sums_clear(&(*check)->result.kernel);
    bp_sums_clear(&(*check)->result.reference);
    bp_sums_clear(&(*check)->last.kernel);
    bp_sums_clear(&(*check)->last.reference);
    free(*check);
    *check = NULL;
}

/* If rays are sent to lamps, the kernel's samples have the same means as the reference's and less spread. */
static bool spreads_less(const BpRender *render) {
    BpRenderReport report;
    bp_render_report(render, &report);
    return report.light_sampling == BP_LIGHT_SAMPLING_ON;
}

/* One chunk of the kernel. */
static BpStatus step_kernel(BpRender *render, BpSums *sums, uint64_t *truncated_paths, bool *finished,
                            BpError *err) {
    BpSampleBlock block = {0};
    BP_TRY(bp_render_step_samples(render, &block, finished, err));
    for (size_t i = 0; i < (size_t)block.pixel_count * block.samples; ++i) {
        const float *value = block.values + 4 * i;
        const double radiance[3] = {(double)value[0], (double)value[1], (double)value[2]};
        const double segments = floor((double)value[3]);
        if ((double)value[3] > segments) *truncated_paths += 1;
        bp_pixel_sums_add(&sums->pixels[block.first_pixel + i / block.samples], radiance, (uint64_t)segments);
    }
    bp_sample_block_clear(&block);
    return BP_OK;
}

BpStatus bp_check_render_kernel(BpRender *render, BpSums *sums, uint64_t *truncated_paths, BpError *err) {
    uint64_t cut = 0;
    sums->means_only = spreads_less(render);
    for (bool finished = false; !finished;) BP_TRY(step_kernel(render, sums, &cut, &finished, err));
    if (truncated_paths != NULL) *truncated_paths += cut;
    return BP_OK;
}

/* A slice of the reference, and how long the next one should be. */
static BpStatus step_reference(BpCheck *check, BpError *err) {
    const BpRenderOptions *render = &check->options.render;
    const uint64_t rest = check->target - check->reference_samples;
    const uint64_t samples = check->slice < rest ? check->slice : rest;
    /* Another generator, and also another seed. */
    const BpReferenceOptions options = {.first_sample = render->first_sample + check->reference_samples,
                                        .samples = samples,
                                        .seed = ~render->seed,
                                        .max_depth = render->max_depth,
                                        .threads = check->options.threads};
    const double start = bp_clock_seconds();
    BP_TRY(bp_reference_render(check->scene, &options, &check->result.reference, &check->result.cut_reference,
                               err));
    const double seconds = bp_clock_seconds() - start;
    check->reference_samples += samples;
    if (seconds < 0.5 * STEP_SECONDS)
        check->slice = samples * 2;
    else if (seconds > 2 * STEP_SECONDS && samples > 1)
        check->slice = samples / 2;
    return BP_OK;
}

/* The difference between the picture and the means of its samples (BpVerdict, picture_off). */
static double picture_off(const BpSums *samples, const BpFilm *picture) {
    const size_t pixels = (size_t)samples->width * samples->height;
    double mean[3] = {0}, off = 0;
    for (size_t p = 0; p < pixels; ++p)
        for (size_t c = 0; c < 3; ++c)
            if (samples->pixels[p].count > 0)
                mean[c] += samples->pixels[p].sum[c] / (double)samples->pixels[p].count / (double)pixels;
    for (size_t p = 0; p < pixels; ++p) {
        const BpPixelSums *pixel = &samples->pixels[p];
        const double n = (double)pixel->count;
        double sum[3] = {0};
        uint64_t count = 0;
        for (size_t cell = p * picture->replicates; cell < (p + 1) * picture->replicates; ++cell) {
            count += picture->counts[cell];
            for (size_t c = 0; c < 3; ++c) sum[c] += bp_film_sum(picture, 3 * cell + c);
        }
        if (count != pixel->count) return INFINITY;
        for (size_t c = 0; c < 3; ++c) {
            const double difference = fabs(sum[c] - pixel->sum[c]) / n;
            if (difference > 0) off = fmax(off, difference / (pixel->sum[c] / n + mean[c]));
        }
    }
    return off;
}

static void copy_sums(BpSums *to, const BpSums *from) {
    memcpy(to->pixels, from->pixels, (size_t)from->width * from->height * sizeof *from->pixels);
}

/* The verdict on the samples of both, and on the picture that the kernel made of its samples. */
static BpStatus judge(BpCheck *check, uint64_t samples, double off, BpError *err) {
    BpCheckResult *result = &check->result;
    BP_TRY(bp_verdict(&result->kernel, &result->reference, check->options.level, check->options.margin,
                      &result->verdict, err));
    bp_verdict_add_picture(&result->verdict, off);
    result->samples_per_pixel = samples;
    check->finished = true;
    return BP_OK;
}

/* Both sides have the samples of this round: the end, or the next one. */
static BpStatus end_round(BpCheck *check, BpError *err) {
    BpCheckResult *result = &check->result;
    const uint64_t total = check->options.render.samples_per_pixel;
    const BpFilm *film = NULL;
    BP_TRY(bp_render_read_film(check->render, &film, err));
    const double off = picture_off(&result->kernel, film);
    if (check->target == total) return judge(check, total, off, err);
    Round *last = &check->last;
    copy_sums(&last->kernel, &result->kernel);
    copy_sums(&last->reference, &result->reference);
    last->samples = check->target;
    last->cut_kernel = result->cut_kernel;
    last->cut_reference = result->cut_reference;
    last->picture_off = off;
    check->target = check->target > total / 2 ? total : 2 * check->target;
    check->kernel_done = false;
    return bp_render_extend(check->render, check->target, err);
}

/* Time is up: the result of the last complete round. */
static BpStatus judge_last_round(BpCheck *check, BpError *err) {
    BpCheckResult *result = &check->result;
    const Round *last = &check->last;
    if (last->samples == 0)
        return bp_fail(err, BP_ERR_INCONCLUSIVE, "time was up before both tracers had %llu samples per pixel",
                       (unsigned long long)check->target);
    copy_sums(&result->kernel, &last->kernel);
    copy_sums(&result->reference, &last->reference);
    result->cut_kernel = last->cut_kernel;
    result->cut_reference = last->cut_reference;
    result->timed_out = true;
    return judge(check, last->samples, last->picture_off, err);
}

static void report_progress(const BpCheck *check, BpCheckProgress *progress) {
    const BpCheckResult *result = &check->result;
    const double pixels = (double)check->scene->camera.width * check->scene->camera.height;
    const double total = (double)check->options.render.samples_per_pixel;
    *progress =
        (BpCheckProgress){.reference = check->kernel_done,
                          .done = check->kernel_done ? (double)check->reference_samples / total
                                                     : (double)result->report.samples / (pixels * total),
                          .seconds = check->kernel_done ? result->reference_seconds : result->kernel_seconds,
                          .finished = check->finished};
}

BpStatus bp_check_step(BpCheck *check, BpCheckProgress *progress, BpError *err) {
    BpCheckResult *result = &check->result;
    const double start = bp_clock_seconds();
    if (check->finished) {
        /* nothing is left to do */
    } else if (check->options.seconds > 0 && start - check->begun > check->options.seconds) {
        BP_TRY(judge_last_round(check, err));
    } else if (!check->kernel_done) {
        result->kernel.means_only = spreads_less(check->render);
        while (!check->kernel_done && bp_clock_seconds() - start < STEP_SECONDS)
            BP_TRY(
                step_kernel(check->render, &result->kernel, &result->cut_kernel, &check->kernel_done, err));
        result->kernel_seconds += bp_clock_seconds() - start;
        bp_render_report(check->render, &result->report);
    } else {
        BP_TRY(step_reference(check, err));
        result->reference_seconds += bp_clock_seconds() - start;
        if (check->reference_samples == check->target) BP_TRY(end_round(check, err));
    }
    if (progress != NULL) report_progress(check, progress);
    return BP_OK;
}

BpStatus bp_check_result(const BpCheck *check, const BpCheckResult **result, BpError *err) {
    *result = NULL;
    if (!check->finished) return bp_fail(err, BP_ERR_USAGE, "the check has not finished");
    *result = &check->result;
    return BP_OK;
}
