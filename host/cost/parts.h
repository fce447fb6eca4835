/* parts.h: the parts of a study, apart so that tests can see them.
 *
 * In:    pictures and accumulators, measured points.   Out: settings, errors, intervals, fits, crops.
 * Knows: arithmetic, what render can do.   Does not know: the order of a study (study.c), how results look.
 */
#ifndef BP_COST_PARTS_H
#define BP_COST_PARTS_H

#include "study.h"

#define BP_STUDY_CROP_WIDTH 96u
#define BP_STUDY_CROP_HEIGHT 64u

/* ---- settings.c ---- */

/* Fills the settings of a scene and returns their number: 0 is the base; with `has_double`, 1 is the truth.
 * Ways that change nothing against the base are left out. */
size_t bp_study_settings(const BpScene *scene, const BpRenderOptions *base, bool has_double,
                         BpStudySetting settings[BP_STUDY_SETTINGS_MAX]);

/* ---- timing.c ----
 *
 * A machine that has other work is slower now and then, by a quarter or more, for a tenth of a second or
 * several. So ways to render take turns in short rounds of equal work, and medians over rounds are compared:
 * what hits one way in one round is an outlier, and what hits a whole round cancels. */

#define BP_STUDY_ROUNDS_MAX 16u

double bp_study_round_sum(const double *rounds, size_t count);
/* Seconds of all `count` <= BP_STUDY_ROUNDS_MAX rounds as if none had been disturbed: the median rate times
 * all samples. Of few rounds their sum. */
double bp_study_round_seconds(const double *rounds, const double *samples, size_t count);
/* One way's time over the base's: the median of the rounds' ratios, with its 95 % interval. NaN: too few. */
BpStudyEstimate bp_study_round_ratio(const double *own, const double *base, size_t count);

/* ---- measure.c ---- */

double bp_study_luminance(const float rgb[3]);

/* Mean of (x - r1)(x - r2) of luminance over brightness^2, its standard error from the spread over pixels,
 * and the relative MSE of the channels: mse, mse_error and rel_mse of `point`, and nrmse from them. */
void bp_study_errors(const BpPicture *x, const BpPicture *r1, const BpPicture *r2, double brightness,
                     BpStudyPoint *point);

/* Differences of two accumulators of one size and number of replicates, pixel by pixel and replicate by
 * replicate: of brightness, and the mean squared systematic change of a pixel's luminance, both relative to
 * `brightness`. BP_ERR_USAGE: sizes or replicates differ, or there are fewer than two replicates. */
BpStatus bp_study_paired(const BpAccumulator *x, const BpAccumulator *base, double brightness,
                         BpStudyEstimate *bias, BpStudyEstimate *square, BpError *err);
/* The difference of brightness between x and the mean of two references with random numbers of their own. */
BpStudyEstimate bp_study_unpaired(const BpPicture *x, const BpPicture *r1, const BpPicture *r2,
                                  double brightness);

/* ---- crop.c ---- */

/* Adds how far each pixel of x is from y, in units of `brightness`, at most 1. */
void bp_study_interest_add(double *interest, const BpPicture *x, const BpPicture *y, double brightness);
/* The window of a crop's size with the most of it. */
void bp_study_crop_place(const double *interest, uint32_t width, uint32_t height, uint32_t *left,
                         uint32_t *top);
/* Fills the crop; clear it with bp_study_crop_clear() also on failure. */
BpStatus bp_study_crop(const BpPicture *x, const BpPicture *r1, const BpPicture *r2, uint32_t left,
                       uint32_t top, BpTransfer transfer, BpStudyCrop *crop, BpError *err);
void bp_study_crop_clear(BpStudyCrop *crop);

/* ---- fit.c ---- */

/* Least squares of relative errors of y = floor + slope / n, with floor and slope >= 0. Values that are not
 * positive are left out; false (and NaN) with fewer than two at different n. */
bool bp_study_fit(const double *n, const double *y, size_t count, double *floor, double *slope);
/* Marks the points that no other beats in seconds or nrmse without losing in the other. */
void bp_study_front(BpStudyResult *result);
/* Fits, times, efficiencies. */
void bp_study_summarize(BpStudyResult *result);
/* For each target the setting that gets there soonest; the base, unless another is sooner by a tenth. */
void bp_study_advise(BpStudyResult *result);

#endif
