/* uniformity.h: is a sample of points uniform in the unit square or cube?
 *
 * In:    points whose coordinates were mapped so that the law under test makes them uniform on [0, 1).
 * Out:   the smallest p-value of a chi-square test over about 100 equal cells and of a Kolmogorov test on
 * each coordinate. Few cells on purpose: at the same sample a fine grid has less power against smooth errors.
 */
#ifndef TESTS_SUPPORT_UNIFORMITY_H
#define TESTS_SUPPORT_UNIFORMITY_H

#include "base/quantile.h"
#include "distributions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* `points`: count * dimensions, dimensions 1 to 3. 0 when a coordinate lies outside [0, 1] or is NaN. */
static inline double uniformity(const double *points, size_t count, int dimensions) {
    static const size_t sides[4][3] = {{1, 1, 1}, {100, 1, 1}, {10, 10, 1}, {5, 5, 4}};
    double seen[128] = {0}, due[128];
    size_t cells = 1;
    for (int d = 0; d < 3; ++d) cells *= sides[dimensions][d];
    for (size_t i = 0; i < cells; ++i) due[i] = (double)count / (double)cells;
    for (size_t i = 0; i < count; ++i) {
        size_t cell = 0;
        for (int d = 0; d < dimensions; ++d) {
            const double u = points[i * (size_t)dimensions + (size_t)d];
            if (!(u >= 0 && u <= 1)) return 0;
            const size_t side = sides[dimensions][d];
            size_t step = (size_t)(u * (double)side);
            if (step == side) step = side - 1;
            cell = cell * side + step;
        }
        seen[cell] += 1;
    }
    double least = chi_square_test(seen, due, cells, NULL);

    const size_t sorted_count = count < 1000000 ? count : 1000000;
    double *sorted = malloc(sorted_count * sizeof *sorted);
    if (sorted == NULL) return 0;
    for (int d = 0; d < dimensions; ++d) {
        for (size_t i = 0; i < sorted_count; ++i) sorted[i] = points[i * (size_t)dimensions + (size_t)d];
        bp_sort_doubles(sorted, sorted_count);
        least = fmin(least, kolmogorov_test(sorted, sorted_count));
    }
    free(sorted);
    return least;
}

/* An azimuth as a fraction of the circle. */
static inline double turn(double y, double x) {
    const double pi = 3.14159265358979323846, angle = atan2(y, x) / (2 * pi);
    return angle < 0 ? angle + 1 : angle;
}

#endif
