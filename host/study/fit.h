/* fit.h: evaluates the points of a study: the law of the error, the Pareto front, the advice.
 *
 * In:    points.   Out: fits, efficiencies, the front, the advice.
 * Knows: arithmetic.    Does not know: how the points were measured. */
#ifndef BP_STUDY_FIT_H
#define BP_STUDY_FIT_H

#include "study.h"

/* Least squares of relative errors of y = floor + slope / n, with floor and slope >= 0. Values that are not
 * positive are left out; false (and NaN) with fewer than two at different n. */
bool bp_study_fit(const double *n, const double *y, size_t count, double *floor, double *slope);
/* Marks the Pareto front: the points that no other point beats in both seconds and nrmse. */
void bp_study_front(BpStudyResult *result);
/* Fits, times, efficiencies. */
void bp_study_summarize(BpStudyResult *result);
/* For each target, the configuration that reaches it first; the base, unless another is faster by a tenth. */
void bp_study_advise(BpStudyResult *result);

#endif
