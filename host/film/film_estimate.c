/* film_estimate.c: means and standard errors from replicate sums; formulas in film.h. */
#include "film.h"

#include "base/color.h"
#include "base/names.h"
#include "base/status.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A sum in steps. */
static double sum_steps(const BpFilm *film, size_t index) {
    const double fine_step = 1.0 / (double)(INT64_C(1) << BP_FINE_BITS);
    const double steps = (double)film->sums[index];
    if (film->fine_sums == NULL) return steps;
    return steps + (double)film->fine_sums[index] * fine_step;
}

double bp_film_sum(const BpFilm *film, size_t index) {
    return ldexp(sum_steps(film, index), -film->scale_log2);
}

/* One pixel: index 0 to 2 the channels, 3 the luminance. */
typedef struct PixelEstimate {
    double mean[4];
    double squared_error[4]; /* of the mean; NaN where unknown */
    double expected;         /* luminance, with light that has not been found yet */
    double unseen;           /* the part of the luminance's squared error for that light */
    uint64_t samples;
} PixelEstimate;

/* A pixel's replicates: index 0 to 2 the channels, 3 the luminance. */
typedef struct Replicates {
    double means[BP_REPLICATES_MAX][4];
    double counts[BP_REPLICATES_MAX]; /* none is 0 */
    unsigned filled;
} Replicates;

/* The mean of all replicates but `left_out`, and the squared error of a mean of `samples` like theirs. Two
 * passes, mean first: no difference of large squares. */
static void estimate_without(const Replicates *replicates, unsigned left_out, double samples, double mean[4],
                             double squared_error[4]) {
    double total = 0;
    unsigned used = 0;
    for (size_t c = 0; c < 4; c++) mean[c] = squared_error[c] = 0;
    for (unsigned k = 0; k < replicates->filled; k++) {
        if (k == left_out) continue;
        for (size_t c = 0; c < 4; c++) mean[c] += replicates->counts[k] * replicates->means[k][c];
        total += replicates->counts[k];
        used++;
    }
    for (size_t c = 0; c < 4 && used > 0; c++) mean[c] /= total;
    for (unsigned k = 0; k < replicates->filled; k++) {
        for (size_t c = 0; c < 4 && k != left_out; c++) {
            const double difference = replicates->means[k][c] - mean[c];
            squared_error[c] += replicates->counts[k] * difference * difference;
        }
    }
    for (size_t c = 0; c < 4; c++)
        squared_error[c] = used < 2 ? (double)NAN : squared_error[c] / ((used - 1) * samples);
}

#define ALL_REPLICATES UINT_MAX /* none is left out */

/* Adds the variance of light that the pixel's samples may not have found. If the replicates differ so much
 * that one of them has found it, their variance already contains it: then the replicates other than the
 * brightest give the pixel's noise without it, slightly too low, since noise too has a brightest replicate;
 * `rest_factor` compensates for that (within a tenth, for normal noise and 3 to 8 replicates). */
static void add_unseen(const BpUnseen *unseen, const BpUnseenWeights *weights, size_t pixel,
                       const Replicates *replicates, PixelEstimate *estimate) {
    const BpUnseenPixel *light = &unseen->pixels[pixel];
    const double weight = bp_unseen_weight(weights, light);
    if (!(weight > 0)) return;
    unsigned brightest = 0, darkest = 0;
    for (unsigned k = 1; k < replicates->filled; k++) {
        if (replicates->means[k][3] > replicates->means[brightest][3]) brightest = k;
        if (replicates->means[k][3] < replicates->means[darkest][3]) darkest = k;
    }
    const double mean = light->mean, square = light->square, samples = (double)estimate->samples;
    const double variance = fmax(square - mean * mean, 0) / samples;
    const double apart = replicates->means[brightest][3] - replicates->means[darkest][3];
    const bool found = apart * samples / replicates->filled > 0.5 * square / mean;
    double rest_mean[4], rest_error[4];
    if (found) estimate_without(replicates, brightest, samples, rest_mean, rest_error);
    const double rest_factor = replicates->filled / (replicates->filled - 1.5);
    for (int c = 0; c < 4; c++) {
        const double unseen_error = variance * (c < 3 ? (double)unseen->tint[c] : 1);
        const double seen = estimate->squared_error[c];
        /* fmin: with only two replicates, the remaining one has no spread. */
        const double both = found ? fmax(fmin(rest_error[c] * rest_factor + unseen_error, seen), unseen_error)
                                  : seen + unseen_error;
        estimate->squared_error[c] += weight * (both - seen);
    }
    estimate->unseen = weight * variance;
    estimate->expected += weight * (mean - (found ? estimate->mean[3] - rest_mean[3] : 0));
}

/* `weights` may be NULL: then the errors are those of the light that the samples have found. */
static PixelEstimate estimate_pixel(const BpFilm *film, const BpUnseenWeights *weights, size_t pixel) {
    PixelEstimate estimate = {.samples = 0};
    const size_t k_count = film->replicates;
    const uint32_t *counts = film->counts + pixel * k_count;
    const double unit = ldexp(1, -film->scale_log2);
    Replicates replicates; /* not zeroed: that would cost more than the rest */
    replicates.filled = 0;
    for (size_t k = 0; k < k_count; k++) {
        if (counts[k] == 0) continue;
        const double count = counts[k];
        double *mean = replicates.means[replicates.filled];
        mean[3] = 0;
        for (size_t c = 0; c < 3; c++) {
            mean[c] = sum_steps(film, 3 * (pixel * k_count + k) + c) * unit / count;
            mean[3] += bp_luminance_weights[c] * mean[c];
        }
        replicates.counts[replicates.filled++] = count;
        estimate.samples += counts[k];
    }
    estimate_without(&replicates, ALL_REPLICATES, (double)estimate.samples, estimate.mean,
                     estimate.squared_error);
    estimate.expected = estimate.mean[3];
    if (replicates.filled >= 2 && weights != NULL && film->unseen != NULL)
        add_unseen(film->unseen, weights, pixel, &replicates, &estimate);
    return estimate;
}

BpStatus bp_film_picture(const BpFilm *film, BpPicture *picture, BpError *err) {
    const size_t pixels = (size_t)film->width * film->height;
    *picture = (BpPicture){
        .width = film->width,
        .height = film->height,
        .rgb = malloc(pixels * 3 * sizeof *picture->rgb),
        .error = malloc(pixels * 3 * sizeof *picture->error),
        .samples = malloc(pixels * sizeof *picture->samples),
        .alpha = film->met != NULL ? malloc(pixels * sizeof *picture->alpha) : NULL,
    };
    if ((film->met != NULL && picture->alpha == NULL) || picture->rgb == NULL || picture->error == NULL ||
        picture->samples == NULL) {
        bp_picture_clear(picture);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a picture of %zu pixels", pixels);
    }
    if (bp_film_has_aovs(film) && bp_film_give_aovs(film, picture, err) != BP_OK) {
        bp_picture_clear(picture);
        return BP_ERR_MEMORY;
    }
    BpUnseenWeights weights;
    bp_unseen_weigh(film, &weights);
    for (size_t pixel = 0; pixel < pixels; pixel++) {
        const PixelEstimate estimate = estimate_pixel(film, &weights, pixel);
        for (size_t c = 0; c < 3; c++) {
            picture->rgb[3 * pixel + c] = (float)estimate.mean[c];
            picture->error[3 * pixel + c] = (float)sqrt(estimate.squared_error[c]);
        }
        picture->samples[pixel] = estimate.samples;
        if (film->met != NULL)
            picture->alpha[pixel] =
                estimate.samples > 0 ? (float)((double)film->met[pixel] / (double)estimate.samples) : 0;
    }
    return BP_OK;
}

BpFilmClaim bp_film_claim(const BpFilm *film) {
    const size_t pixels = (size_t)film->width * film->height;
    double luminance = 0, squared_error = 0, unseen = 0;
    BpUnseenWeights weights;
    bp_unseen_weigh(film, &weights);
    for (size_t pixel = 0; pixel < pixels; pixel++) {
        const PixelEstimate estimate = estimate_pixel(film, &weights, pixel);
        luminance += estimate.expected;
        squared_error += estimate.squared_error[3];
        unseen += estimate.unseen;
    }
    luminance /= (double)pixels;
    squared_error /= (double)pixels;
    unseen /= (double)pixels;
    return (BpFilmClaim){.luminance = luminance,
                         .nrmse = luminance > 0 ? sqrt(squared_error) / luminance : (double)NAN,
                         .unseen_part = squared_error > 0 ? unseen / squared_error : 0};
}

double bp_film_nrmse(const BpFilm *film) {
    return bp_film_claim(film).nrmse;
}

double bp_film_unseen_part(const BpFilm *film) {
    return film->unseen != NULL ? bp_film_claim(film).unseen_part : 0;
}

void bp_film_mean(const BpFilm *film, double mean[3]) {
    const size_t pixels = (size_t)film->width * film->height;
    double sum[3] = {0};
    for (size_t pixel = 0; pixel < pixels; pixel++) {
        const PixelEstimate estimate = estimate_pixel(film, NULL, pixel);
        for (size_t c = 0; c < 3; c++) sum[c] += estimate.mean[c];
    }
    for (size_t c = 0; c < 3; c++) mean[c] = sum[c] / (double)pixels;
}

double bp_film_rounding(const BpFilm *film) {
    if (!film->coarse) return BP_ROUNDING_MAX;
    double mean[3];
    bp_film_mean(film, mean);
    double luminance = 0;
    for (size_t c = 0; c < 3; c++) luminance += bp_luminance_weights[c] * mean[c];
    const double fine_step = ldexp(1, -film->scale_log2 - BP_FINE_BITS);
    return fmax(fine_step / luminance, BP_ROUNDING_MAX);
}

double bp_film_squared_error(const BpFilm *film, const BpUnseenWeights *weights, size_t pixel) {
    return estimate_pixel(film, weights, pixel).squared_error[3];
}

static void add_cause(uint64_t count, const char *words, char text[BP_INVALID_TEXT_SIZE]) {
    const size_t used = strlen(text);
    if (count == 0) return;
    snprintf(text + used, BP_INVALID_TEXT_SIZE - used, "%s%" PRIu64 " %s", used > 0 ? ", " : " (", count,
             words);
}

const char *bp_film_invalid_causes(const BpFilm *film, char text[BP_INVALID_TEXT_SIZE]) {
    text[0] = '\0';
#define SAY(member, tally, words) add_cause(film->member, words, text);
    BP_INVALID_LIST(SAY)
#undef SAY
    if (text[0] != '\0') strcat(text, ")");
    return text;
}

BpStatus bp_film_check_valid(const BpFilm *film, BpError *err) {
    const size_t cells = (size_t)film->width * film->height * film->replicates;
    uint64_t valid = 0;
    for (size_t cell = 0; cell < cells; cell++) valid += film->counts[cell];
    if (film->invalid_samples <= valid) return BP_OK;
    char text[BP_INVALID_TEXT_SIZE];
    return bp_fail(err, BP_ERR_LIMIT,
                   "%" PRIu64 " of %" PRIu64 " samples are invalid%s, so they show nothing of the scene: its "
                   "numbers may be too large or too small for %s precision, and `ballpark check` shows more",
                   film->invalid_samples, film->invalid_samples + valid, bp_film_invalid_causes(film, text),
                   bp_precision_names[film->precision]);
}

void bp_film_sample_counts(const BpFilm *film, uint64_t *least, uint64_t *most, double *mean) {
    const size_t pixels = (size_t)film->width * film->height;
    uint64_t total = 0;
    *least = UINT64_MAX;
    *most = 0;
    for (size_t pixel = 0; pixel < pixels; pixel++) {
        uint64_t samples = 0;
        for (uint32_t k = 0; k < film->replicates; k++) samples += film->counts[pixel * film->replicates + k];
        total += samples;
        if (samples < *least) *least = samples;
        if (samples > *most) *most = samples;
    }
    *mean = (double)total / (double)pixels;
}
