/* check.c: see check.h. */
#include "check.h"

#include "base/clock.h"
#include "base/status.h"
#include "reference/reference.h"

#include <math.h>
#include <stdlib.h>

#define STEP_SECONDS 0.3

struct BpCheck {
    const BpScene *scene;
    BpCheckOptions options;
    BpRender *render;
    uint64_t reference_samples; /* done */
    uint64_t slice;             /* samples of the next step of the reference */
    bool kernel_done, finished;
    BpCheckResult result;
};

BpStatus bp_check_create(const BpScene *scene, const BpCheckOptions *options, const BpDeviceInfo *device,
                         BpCheck **check_out, BpError *err) {
    *check_out = NULL;
    if (options->render.samples_per_pixel < 2)
        return bp_fail(err, BP_ERR_USAGE, "a check needs at least 2 samples per pixel to measure noise");
    if (options->render.sampler != BP_SAMPLER_INDEPENDENT)
        return bp_fail(err, BP_ERR_USAGE, "a check needs --sampler independent");
    BpCheck *check = calloc(1, sizeof *check);
    if (check == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a check");
    check->scene = scene;
    check->options = *options;
    check->slice = 1;
    const uint32_t width = scene->camera.width, height = scene->camera.height;
    BpStatus status = bp_sums_init(&check->result.kernel, width, height, err);
    if (status == BP_OK) status = bp_sums_init(&check->result.reference, width, height, err);
    if (status == BP_OK)
        status =
            bp_render_create(scene, &options->render, device, device != NULL ? 1 : 0, &check->render, err);
    if (status != BP_OK) bp_check_destroy(&check);
    *check_out = check;
    return status;
}

void bp_check_destroy(BpCheck **check) {
    if (check == NULL || *check == NULL) return;
    bp_render_destroy(&(*check)->render);
    bp_sums_clear(&(*check)->result.kernel);
    bp_sums_clear(&(*check)->result.reference);
    free(*check);
    *check = NULL;
}

/* Where rays go to lamps, the samples of the kernel have the means of the reference's and less spread. */
static bool spreads_less(const BpRender *render) {
    BpRenderReport report;
    bp_render_report(render, &report);
    return report.lamps == BP_LAMPS_ON;
}

/* One chunk of the kernel. */
static BpStatus step_kernel(BpRender *render, BpSums *sums, uint64_t *cut_paths, bool *finished,
                            BpError *err) {
    BpSampleBlock block = {0};
    BP_TRY(bp_render_step_samples(render, &block, finished, err));
    for (size_t i = 0; i < (size_t)block.pixel_count * block.samples; ++i) {
        const float *value = block.values + 4 * i;
        const double radiance[3] = {(double)value[0], (double)value[1], (double)value[2]};
        const double segments = floor((double)value[3]);
        if ((double)value[3] > segments) *cut_paths += 1;
        bp_pixel_sums_add(&sums->pixels[block.first_pixel + i / block.samples], radiance, (uint64_t)segments);
    }
    bp_sample_block_clear(&block);
    return BP_OK;
}

BpStatus bp_check_render_kernel(BpRender *render, BpSums *sums, uint64_t *cut_paths, BpError *err) {
    uint64_t cut = 0;
    sums->means_only = spreads_less(render);
    for (bool finished = false; !finished;) BP_TRY(step_kernel(render, sums, &cut, &finished, err));
    if (cut_paths != NULL) *cut_paths += cut;
    return BP_OK;
}

/* A slice of the reference, and how long the next one should be. */
static BpStatus step_reference(BpCheck *check, BpError *err) {
    const BpRenderOptions *render = &check->options.render;
    const uint64_t rest = render->samples_per_pixel - check->reference_samples;
    const uint64_t samples = check->slice < rest ? check->slice : rest;
    /* Another generator, and for good measure another seed. */
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

/* How far the picture is from the means of its samples (BpVerdict, picture_off). */
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

/* The verdict on the samples of both, and on what the kernel's picture makes of its own. */
static BpStatus judge(BpCheck *check, BpError *err) {
    BpCheckResult *result = &check->result;
    const BpFilm *picture = NULL;
    BP_TRY(bp_verdict(&result->kernel, &result->reference, check->options.level, &result->verdict, err));
    BP_TRY(bp_render_read_film(check->render, &picture, err));
    bp_verdict_add_picture(&result->verdict, picture_off(&result->kernel, picture));
    return BP_OK;
}

BpStatus bp_check_step(BpCheck *check, BpCheckProgress *progress, BpError *err) {
    BpCheckResult *result = &check->result;
    const uint64_t total = check->options.render.samples_per_pixel;
    const double start = bp_clock_seconds();
    if (!check->kernel_done) {
        result->kernel.means_only = spreads_less(check->render);
        while (!check->kernel_done && bp_clock_seconds() - start < STEP_SECONDS)
            BP_TRY(
                step_kernel(check->render, &result->kernel, &result->cut_kernel, &check->kernel_done, err));
        result->kernel_seconds += bp_clock_seconds() - start;
        bp_render_report(check->render, &result->report);
    } else if (check->reference_samples < total) {
        BP_TRY(step_reference(check, err));
        result->reference_seconds += bp_clock_seconds() - start;
    }
    if (check->reference_samples == total && !check->finished) {
        BP_TRY(judge(check, err));
        check->finished = true;
    }
    if (progress != NULL) {
        const double pixels = (double)check->scene->camera.width * check->scene->camera.height;
        *progress = (BpCheckProgress){
            .reference = check->kernel_done,
            .done = check->kernel_done ? (double)check->reference_samples / (double)total
                                       : (double)result->report.samples / (pixels * (double)total),
            .seconds = check->kernel_done ? result->reference_seconds : result->kernel_seconds,
            .finished = check->finished};
    }
    return BP_OK;
}

BpStatus bp_check_result(const BpCheck *check, const BpCheckResult **result, BpError *err) {
    *result = NULL;
    if (!check->finished) return bp_fail(err, BP_ERR_USAGE, "the check has not finished");
    *result = &check->result;
    return BP_OK;
}
