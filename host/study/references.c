/* references.c: see references.h. */
#include "references.h"

#include "base/clock.h"
#include "base/color.h"
#include "base/status.h"
#include "film/film.h"

#include <math.h>
#include <stdlib.h>

#define SAMPLES_FIRST 16u
#define SAMPLES_MOST (1u << 18)
#define SEED UINT64_C(0x7275746820697320) /* keeps the references' random numbers apart from the study's */

static BpStatus open_one(BpReferences *references, int r, const BpRenderOptions *base,
                         const BpDeviceInfo *device, BpError *err) {
    const BpScene *scene = references->scene;
    BpRenderOptions options;
    if (!references->kernel)
        return bp_sums_init(&references->sums[r], scene->camera.width, scene->camera.height, err);
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = SAMPLES_FIRST;
    options.max_depth = BP_STUDY_DEPTH;
    options.precision = BP_PRECISION_DOUBLE;
    options.sampler = BP_SAMPLER_SOBOL;
    options.roulette = BP_ROULETTE_OFF;
    options.samples_only = true;
    options.seed = references->seed[r];
    options.force = base->force;
    return bp_render_create(scene, &options, device, 1, &references->render[r], err);
}

BpStatus bp_references_open(BpReferences *references, const BpScene *scene, const BpRenderOptions *base,
                            const BpDeviceInfo *device, BpError *err) {
    references->scene = scene;
    references->kernel = device->has_double;
    references->wanted = SAMPLES_FIRST;
    references->start = bp_clock_seconds();
    for (int r = 0; r < 2; r++) {
        references->seed[r] = base->seed ^ (SEED + (uint64_t)r);
        BP_TRY(open_one(references, r, base, device, err));
    }
    return BP_OK;
}

static BpStatus read_sums(const BpSums *sums, BpPicture *picture, BpError *err) {
    const size_t pixels = (size_t)sums->width * sums->height;
    *picture =
        (BpPicture){.width = sums->width, .height = sums->height, .rgb = malloc(pixels * 3 * sizeof(float))};
    if (picture->rgb == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for a reference");
    for (size_t p = 0; p < pixels; p++)
        for (size_t c = 0; c < 3; c++)
            picture->rgb[3 * p + c] = (float)(sums->pixels[p].sum[c] / (double)sums->pixels[p].count);
    return BP_OK;
}

static BpStatus read_render(BpRender *render, BpPicture *picture, BpError *err) {
    const BpFilm *film = NULL;
    BP_TRY(bp_render_read_film(render, &film, err));
    BP_TRY(bp_film_check_valid(film, err));
    return bp_film_picture(film, picture, err);
}

/* Continues the reference whose turn it is; *done: it has all its samples. */
static BpStatus trace(BpReferences *references, bool *done, BpError *err) {
    const int r = references->turn;
    if (references->kernel) {
        BpProgress progress;
        BP_TRY(bp_render_step(references->render[r], &progress, err));
        *done = progress.finished;
        if (*done) references->done[r] = references->wanted;
        return BP_OK;
    }
    const BpReferenceOptions options = {.first_sample = references->done[r],
                                        .samples = 1,
                                        .seed = references->seed[r],
                                        .max_depth = BP_STUDY_DEPTH};
    BP_TRY(bp_reference_render(references->scene, &options, &references->sums[r], NULL, err));
    *done = ++references->done[r] == references->wanted;
    return BP_OK;
}

BpStatus bp_references_step(BpReferences *references, double seconds, bool *finished, BpError *err) {
    bool done = false;
    BP_TRY(trace(references, &done, err));
    *finished = false;
    if (!done) return BP_OK;
    references->turn = 1 - references->turn;
    if (references->turn != 0) return BP_OK;
    /* Doubling takes as long as everything so far. */
    if (2 * (bp_clock_seconds() - references->start) < seconds && references->wanted < SAMPLES_MOST) {
        references->wanted *= 2;
        for (int r = 0; r < 2 && references->kernel; r++)
            BP_TRY(bp_render_extend(references->render[r], references->wanted, err));
        return BP_OK;
    }
    for (int r = 0; r < 2; r++) {
        if (references->kernel)
            BP_TRY(read_render(references->render[r], &references->pictures[r], err));
        else
            BP_TRY(read_sums(&references->sums[r], &references->pictures[r], err));
        bp_render_destroy(&references->render[r]);
        bp_sums_clear(&references->sums[r]);
    }
    *finished = true;
    return BP_OK;
}

void bp_references_judge(const BpReferences *references, double *brightness, double *nrmse) {
    const BpPicture *first = &references->pictures[0], *second = &references->pictures[1];
    const size_t pixels = (size_t)first->width * first->height;
    double sum = 0, square = 0;
    for (size_t p = 0; p < pixels; p++) {
        const double a = bp_luminance(first->rgb + 3 * p), b = bp_luminance(second->rgb + 3 * p);
        sum += 0.5 * (a + b);
        square += 0.25 * (a - b) * (a - b);
    }
    *brightness = sum / (double)pixels;
    *nrmse = *brightness > 0 ? sqrt(square / (double)pixels) / *brightness : (double)NAN;
}

void bp_references_clear(BpReferences *references) {
    for (int r = 0; r < 2; r++) {
        bp_render_destroy(&references->render[r]);
        bp_sums_clear(&references->sums[r]);
        bp_picture_clear(&references->pictures[r]);
    }
}
