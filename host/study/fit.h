/* fit.h: what follows from the points of a study: the law of the error, the front of best points, the advice.
 *
 * In:    points.        Out: fits, efficiencies, the front, the advice.
 * Knows: arithmetic.    Does not know: how the points were measured. */
#ifndef BP_STUDY_FIT_H
#define BP_STUDY_FIT_H

#include "study.h"

/* Least squares of relative errors of y = floor + slope / n, with floor and slope >= 0. Values that are not
 * positive are left out; false (and NaN) with fewer than two at different n. */
bool bp_study_fit(const double *n, const double *y, size_t count, double *floor, double *slope);
/* Marks the points that no other beats in seconds or nrmse without losing in the other. */
void bp_study_front(BpStudyResult *result);
/* Fits, times, efficiencies. */
void bp_study_summarize(BpStudyResult *result);
/* For each target the configuration that gets there soonest; the base, unless another is sooner by a tenth.
 */
void bp_study_advise(BpStudyResult *result);

#endif
