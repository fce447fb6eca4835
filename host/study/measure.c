/* measure.c: errors and differences of pictures; see measure.h. */
#include "measure.h"

#include "base/color.h"
#include "base/status.h"

#include <math.h>

#define REL_MSE_OFFSET 0.01 /* keeps dark pixels from dominating (pbrt's imgtool) */
#define Z_95 1.959964       /* of the normal distribution */

void bp_study_errors(const BpPicture *x, const BpPicture *r1, const BpPicture *r2, double brightness,
                     BpStudyPoint *point) {
    const size_t pixels = (size_t)x->width * x->height;
    const double n = (double)pixels, scale = 1 / (brightness * brightness);
    double sum = 0, sum2 = 0, relative = 0;
    for (size_t p = 0; p < pixels; p++) {
        const double y = bp_luminance(x->rgb + 3 * p);
        const double product = (y - bp_luminance(r1->rgb + 3 * p)) * (y - bp_luminance(r2->rgb + 3 * p));
        sum += product;
        sum2 += product * product;
        for (size_t i = 3 * p; i < 3 * p + 3; i++) {
            const double a = (double)r1->rgb[i], b = (double)r2->rgb[i], v = (double)x->rgb[i];
            const double offset = 0.5 * (a + b) + REL_MSE_OFFSET;
            relative += (v - a) * (v - b) / (offset * offset);
        }
    }
    const double mean = sum / n, variance = fmax(0, sum2 / n - mean * mean);
    point->mse = scale * mean;
    point->mse_error = n > 1 ? scale * sqrt(variance / (n - 1)) : (double)NAN;
    point->nrmse = point->mse > 0 && point->mse > Z_95 * point->mse_error ? sqrt(point->mse) : (double)NAN;
    point->rel_mse = relative / (3 * n);
}

/* Mean luminance of one replicate of a pixel; NaN without samples. */
static double replicate(const BpFilm *a, size_t cell) {
    double sum = 0;
    for (size_t c = 0; c < 3; c++) sum += bp_luminance_weights[c] * bp_film_sum(a, 3 * cell + c);
    return a->counts[cell] > 0 ? sum / a->counts[cell] : (double)NAN;
}

static BpStudyEstimate interval(double value, double standard_error) {
    return (BpStudyEstimate){value, value - Z_95 * standard_error, value + Z_95 * standard_error};
}

/* Pixels are independent, with either sampler, so their spread gives the errors of both means. */
BpStatus bp_study_paired(const BpFilm *x, const BpFilm *base, double brightness, BpStudyEstimate *bias,
                         BpStudyEstimate *square, BpError *err) {
    const size_t pixels = (size_t)x->width * x->height, k_count = x->replicates;
    const double n = (double)pixels, scale = 1 / (brightness * brightness);
    double sum = 0, sum_variance = 0, squares = 0, squares2 = 0;
    if (x->width != base->width || x->height != base->height || k_count != base->replicates || k_count < 2)
        return bp_fail(err, BP_ERR_USAGE, "pictures of different sizes or replicates cannot be paired");
    for (size_t p = 0; p < pixels; p++) {
        double d[BP_REPLICATES_MAX], mean = 0, spread = 0;
        for (size_t k = 0; k < k_count; k++) {
            d[k] = replicate(x, p * k_count + k) - replicate(base, p * k_count + k);
            mean += d[k] / (double)k_count;
        }
        for (size_t k = 0; k < k_count; k++) spread += (d[k] - mean) * (d[k] - mean);
        const double variance = spread / (double)((k_count - 1) * k_count); /* of the mean */
        const double q = mean * mean - variance; /* expected: the squared systematic difference */
        sum += mean;
        sum_variance += variance;
        squares += q;
        squares2 += q * q;
    }
    const double mean_square = squares / n;
    *bias = interval(sum / n / brightness, sqrt(sum_variance) / n / brightness);
    *square =
        interval(scale * mean_square, scale * sqrt(fmax(0, squares2 / n - mean_square * mean_square) / n));
    return BP_OK;
}

BpStudyEstimate bp_study_unpaired(const BpPicture *x, const BpPicture *r1, const BpPicture *r2,
                                  double brightness) {
    const size_t pixels = (size_t)x->width * x->height;
    double sum = 0, variance = 0;
    for (size_t p = 0; p < pixels; p++) {
        const double a = bp_luminance(r1->rgb + 3 * p), b = bp_luminance(r2->rgb + 3 * p);
        double error = 0; /* of luminance, as if the channels erred together: never too small */
        for (size_t c = 0; c < 3; c++) error += bp_luminance_weights[c] * (double)x->error[3 * p + c];
        sum += bp_luminance(x->rgb + 3 * p) - 0.5 * (a + b);
        variance += error * error + 0.25 * (a - b) * (a - b);
    }
    return interval(sum / (double)pixels / brightness, sqrt(variance) / (double)pixels / brightness);
}
