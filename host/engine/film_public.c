/* film_public.c: films as ballpark.h gives them to others.
 *
 * In:    a render, files, films.   Out: films, their pictures, what they are of.
 * Knows: that a film is an accumulator.   Does not know: how sums are added, or laid out in a file. */
#include "../base/status.h"
#include "accumulator_file.h"
#include "render_state.h"

BpStatus bp_render_film(BpRender *render, BpFilm **film, BpError *err) {
    const BpAccumulator *read = NULL;
    BP_TRY(bp_render_accumulator(render, &read, err));
    *film = render->accumulator;
    render->accumulator = NULL; /* the render reads its sums anew when it is asked again */
    return BP_OK;
}

BpStatus bp_film_read(const char *path, BpFilm **film, BpError *err) {
    return bp_accumulator_load(path, film, err);
}

BpStatus bp_film_write(const BpFilm *film, const char *path, BpError *err) {
    return bp_accumulator_save(film, path, err);
}

BpStatus bp_film_merge(BpFilm *into, const BpFilm *from, BpError *err) {
    return bp_accumulator_merge(into, from, err);
}

BpStatus bp_film_picture(const BpFilm *film, BpPicture *picture, BpError *err) {
    return bp_accumulator_picture(film, picture, err);
}

double bp_film_nrmse(const BpFilm *film) {
    return bp_accumulator_nrmse(film);
}

void bp_film_info(const BpFilm *film, BpFilmInfo *info) {
    *info = (BpFilmInfo){
        .title = film->title != NULL ? film->title : "",
        .width = film->width,
        .height = film->height,
        .samples_per_pixel = bp_accumulator_range_total(film),
        .range_count = film->range_count,
        .partial = film->partial,
        .segments = film->segments,
        .cut_paths = film->cut_paths,
        .invalid_samples = film->invalid_samples,
        .scene_hash = film->scene_hash,
        .seed = film->seed,
        .max_depth = film->max_depth,
        .replicates = film->replicates,
        .sampler = (BpSampler)film->sampler,
        .precision = (BpPrecision)film->precision,
        .math = (BpMath)film->math,
        .numerics = (BpNumerics)film->numerics,
        .transfer = (BpTransfer)film->transfer,
    };
    bp_accumulator_sample_counts(film, &info->samples_least, &info->samples_most, &info->samples_mean);
}

bool bp_film_range(const BpFilm *film, size_t index, uint64_t *first, uint64_t *count) {
    if (index >= film->range_count) return false;
    *first = film->ranges[index].first;
    *count = film->ranges[index].count;
    return true;
}

void bp_film_destroy(BpFilm **film) {
    bp_accumulator_destroy(film);
}
