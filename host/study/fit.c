/* fit.c: the law of the error, the front of best choices, the advice; see fit.h. */
#include "fit.h"

#include "film/adaptive.h"

#include <math.h>

/* Another configuration is better than the base at less than this share of its time, which exceeds the
 * scatter of times. */
#define CLEARLY_SOONER 0.9

static const double targets[BP_STUDY_TARGETS] = {0.05, 0.01, 0.002};

bool bp_study_fit(const double *n, const double *y, size_t count, double *floor, double *slope) {
    /* Minimise the sum of (floor / y + slope / (n y) - 1)^2: normal equations of two unknowns. */
    double aa = 0, ab = 0, bb = 0, a1 = 0, b1 = 0;
    double least = INFINITY, most = 0;
    *floor = *slope = NAN;
    for (size_t i = 0; i < count; i++) {
        if (!(y[i] > 0)) continue;
        const double a = 1 / y[i], b = 1 / (n[i] * y[i]);
        aa += a * a;
        ab += a * b;
        bb += b * b;
        a1 += a;
        b1 += b;
        least = fmin(least, n[i]);
        most = fmax(most, n[i]);
    }
    const double determinant = aa * bb - ab * ab;
    if (!(most > least) || !(determinant > 0)) return false;
    *floor = (a1 * bb - b1 * ab) / determinant;
    *slope = (b1 * aa - a1 * ab) / determinant;
    if (*floor < 0) {
        *floor = 0;
        *slope = b1 / bb;
    } else if (*slope < 0) {
        *slope = 0;
        *floor = a1 / aa;
    }
    return true;
}

static bool beats(const BpStudyPoint *a, const BpStudyPoint *b) {
    return a->seconds <= b->seconds && a->nrmse <= b->nrmse &&
           (a->seconds < b->seconds || a->nrmse < b->nrmse);
}

void bp_study_front(BpStudyResult *result) {
    for (size_t s = 0; s < result->count; s++) {
        for (size_t i = 0; i < result->series[s].count; i++) {
            BpStudyPoint *point = &result->series[s].points[i];
            point->front = isfinite(point->nrmse);
            for (size_t t = 0; t < result->count && point->front; t++)
                for (size_t j = 0; j < result->series[t].count; j++)
                    if (beats(&result->series[t].points[j], point)) point->front = false;
        }
    }
}

void bp_study_summarize(BpStudyResult *result) {
    const double pixels = (double)result->scene->camera.width * result->scene->camera.height;
    const BpStudyPoint *base = &result->series[0].points[result->series[0].count - 1];
    for (size_t s = 0; s < result->count; s++) {
        BpStudySeries *series = &result->series[s];
        const BpStudyPoint *last = &series->points[series->count - 1];
        double n[BP_STUDY_LEVELS_MAX], y[BP_STUDY_LEVELS_MAX];
        for (size_t i = 0; i < series->count; i++) {
            n[i] = (double)series->points[i].samples;
            y[i] = isfinite(series->points[i].nrmse) ? series->points[i].mse : 0;
        }
        bp_study_fit(n, y, series->count, &series->fit_floor, &series->fit_slope);
        series->seconds_per_sample = last->seconds / ((double)last->samples * pixels);
        series->efficiency = last->claimed > 0 ? base->claimed * base->claimed * base->seconds /
                                                     (last->claimed * last->claimed * last->seconds)
                                               : (double)NAN;
    }
    bp_study_front(result);
    bp_study_advise(result);
}

double bp_study_time_scatter(const BpStudyResult *result) {
    double widest = NAN;
    for (size_t s = 1; s < result->count; s++) {
        const BpStudyEstimate *ratio = &result->series[s].time_ratio;
        widest = fmax(widest, 0.5 * (ratio->high - ratio->low) / ratio->value); /* of NaN, the other one */
    }
    return widest;
}

/* The error that remains with any number of samples. It counts only if it is significant: its interval lies
 * above 0. */
static double floor_of(const BpStudySeries *series) {
    if (isnan(series->bias_square.value)) return isfinite(series->fit_floor) ? series->fit_floor : 0;
    return series->bias_square.low > 0 ? series->bias_square.value : 0;
}

static double noise_square(const BpStudyPoint *point) {
    return point->claimed * point->claimed;
}

/* Samples per pixel at which the noise comes down to `square`: along a line in logarithms between the counts
 * measured, for low-discrepancy samples gain from being many; outside them by V / N. */
static double samples_at(const BpStudySeries *series, double square) {
    const BpStudyPoint *points = series->points;
    size_t i = 0;
    while (i < series->count && noise_square(&points[i]) > square) i++;
    if (i == 0 || i == series->count) {
        const BpStudyPoint *end = &points[i == 0 ? 0 : i - 1];
        return noise_square(end) * (double)end->samples / square;
    }
    const double before = noise_square(&points[i - 1]), after = noise_square(&points[i]);
    const double n = (double)points[i - 1].samples, m = (double)points[i].samples;
    return after > 0 ? n * pow(m / n, log(before / square) / log(before / after)) : m;
}

/* Samples per pixel that reach `mse`, noise and bias together. 0: no number does. */
static double samples_for(const BpStudySeries *series, double mse) {
    const double floor = floor_of(series);
    if (!(mse > floor) || !isfinite(series->points[series->count - 1].claimed)) return 0;
    return fmax(1, ceil(samples_at(series, mse - floor) * (1 - 1e-12)));
}

void bp_study_advise(BpStudyResult *result) {
    const double pixels = (double)result->full_width * result->full_height;
    for (int t = 0; t < BP_STUDY_TARGETS; t++) {
        BpStudyAdvice *advice = &result->advice[t];
        *advice = (BpStudyAdvice){.target = targets[t], .samples = NAN, .seconds = NAN};
        double least = INFINITY;
        for (size_t s = 0; s < result->count; s++) {
            const BpStudySeries *series = &result->series[s];
            const double samples = samples_for(series, targets[t] * targets[t]);
            const double seconds = samples * pixels * series->seconds_per_sample;
            if (!(samples > 0) || !(seconds < least)) continue;
            /* So few samples make the same picture as without it, and `render` refuses them. */
            if (series->configuration.options.adaptive && samples < BP_ADAPTIVE_MEAN_MIN) continue;
            const bool extrapolated = samples < (double)series->points[0].samples ||
                                      samples > (double)series->points[series->count - 1].samples;
            *advice = (BpStudyAdvice){targets[t], true, s, samples, seconds, extrapolated};
            least = s == 0 ? CLEARLY_SOONER * seconds : seconds;
        }
    }
}
