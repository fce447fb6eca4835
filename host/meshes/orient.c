/* orient.c: see orient.h. */
#include "orient.h"

#include <math.h>
#include <stddef.h>

/* A sum without rounding: numbers of rising size that do not overlap (J. R. Shewchuk, "Adaptive Precision
 * Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997). */
typedef struct Sum {
    double part[16];
    size_t count;
} Sum;

static void add(Sum *sum, double value) {
    size_t kept = 0;
    for (size_t i = 0; i < sum->count; i++) {
        const double part = sum->part[i], whole = value + part, shift = whole - value;
        const double rest = (value - (whole - shift)) + (part - shift);
        if (rest != 0) sum->part[kept++] = rest;
        value = whole;
    }
    if (value != 0) sum->part[kept++] = value;
    sum->count = kept;
}

static void add_product(Sum *sum, double x, double y) {
    const double product = x * y;
    add(sum, fma(x, y, -product));
    add(sum, product);
}

static int exact_sign(const double a[2], const double b[2], const double c[2]) {
    Sum sum = {.count = 0};
    add_product(&sum, a[0], b[1]);
    add_product(&sum, -a[1], b[0]);
    add_product(&sum, b[0], c[1]);
    add_product(&sum, -b[1], c[0]);
    add_product(&sum, c[0], a[1]);
    add_product(&sum, -c[1], a[0]);
    if (sum.count == 0) return 0;
    return sum.part[sum.count - 1] > 0 ? 1 : -1; /* the largest part decides */
}

int orient(const double a[2], const double b[2], const double c[2]) {
    /* (3 + 16 u) u with u = 2^-53, Shewchuk's bound for this order of operations. */
    static const double bound = 3.3306690738754716e-16;
    const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
    const double area = left - right;
    if (fabs(area) > bound * (fabs(left) + fabs(right)) + 1e-290) return area > 0 ? 1 : -1;
    return exact_sign(a, b, c);
}
