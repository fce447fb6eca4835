/* measure.h: errors and differences of pictures.
 *
 * In:    pictures and films.   Out: errors with standard errors, differences with their intervals.
 * Knows: statistics of pixels.   Does not know: which configurations are measured. */
#ifndef BP_STUDY_MEASURE_H
#define BP_STUDY_MEASURE_H

#include "study.h"

/* Mean of (x - r1)(x - r2) of luminance over brightness^2, its standard error from the spread over pixels,
 * and the relative MSE of the channels: mse, mse_error and rel_mse of `point`, and nrmse from them. */
void bp_study_errors(const BpPicture *x, const BpPicture *r1, const BpPicture *r2, double brightness,
                     BpStudyPoint *point);

/* Differences of two films of equal size and number of replicates, pixel by pixel and replicate by replicate:
 * that of brightness, and the mean squared systematic change of a pixel's luminance, both relative to
 * `brightness`. BP_ERR_USAGE: sizes or replicates differ, or there are fewer than two replicates. */
BpStatus bp_study_paired(const BpFilm *x, const BpFilm *base, double brightness, BpStudyEstimate *bias,
                         BpStudyEstimate *square, BpError *err);
/* The difference of brightness between x and the mean of two references with random numbers of their own. */
BpStudyEstimate bp_study_unpaired(const BpPicture *x, const BpPicture *r1, const BpPicture *r2,
                                  double brightness);

#endif
