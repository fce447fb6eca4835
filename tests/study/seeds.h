/* seeds.h: small renders of the book's scenes, seed after seed, and references that have converged.
 *
 * In:    a scene's name, a width, samples, a sampler, seeds.   Out: films, pictures.
 * Knows: the render loop.   Does not know: what is asked of the pictures. */
#ifndef TESTS_COST_SEEDS_H
#define TESTS_COST_SEEDS_H

#include "base/color.h"
#include "support/load_scene.h"
#include "support/open_render.h"
#include "support/unit_test.h"

#include "base/status.h"
#include "render/render.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static inline void must(BpStatus status, const BpError *err) {
    if (status != BP_OK) fail_msg("%s", err->message);
}

/* A scene of the book, without folder and ending. */
static inline BpScene *book_scene(const char *name, uint32_t width) {
    char path[512];
    snprintf(path, sizeof path, "scenes/%s.json", name);
    return load_scene(path, width);
}

static inline BpRender *open_render(const BpScene *scene, BpSampler sampler, uint64_t seed,
                                    uint64_t samples) {
    BpRenderOptions options;
    BpRender *render = NULL;
    BpError err = {0};
    bp_render_defaults(scene, &options);
    options.sampler = sampler;
    options.seed = seed;
    options.samples_per_pixel = samples;
    must(open_render_on_device(scene, &options, &render, &err), &err);
    return render;
}

static inline const BpFilm *finish_render(BpRender *render) {
    BpProgress progress = {0};
    const BpFilm *film = NULL;
    BpError err = {0};
    while (!progress.finished) must(bp_render_step(render, &progress, &err), &err);
    must(bp_render_read_film(render, &film, &err), &err);
    return film;
}

static inline BpPicture make_picture(const BpScene *scene, BpSampler sampler, uint64_t seed,
                                     uint64_t samples) {
    BpPicture picture;
    BpError err = {0};
    BpRender *render = open_render(scene, sampler, seed, samples);
    must(bp_film_picture(finish_render(render), &picture, &err), &err);
    bp_render_destroy(&render);
    return picture;
}

static inline double luminance(const float *rgb) {
    double sum = 0;
    for (int c = 0; c < 3; c++) sum += bp_luminance_weights[c] * (double)rgb[c];
    return sum;
}

#endif
