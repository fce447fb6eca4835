/* orient.c: see orient.h. */
#include "orient.h"

#include <math.h>
#include <stddef.h>

/* A sum without rounding: numbers of rising size that do not overlap (J. R. Shewchuk, "Adaptive Precision
 * Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997). */
typedef struct Sum {
    double part[96]; /* as many as numbers are added at most: 24 products of three, each in four parts */
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

/* The largest part decides. */
static int sign_of(const Sum *sum) {
    if (sum->count == 0) return 0;
    return sum->part[sum->count - 1] > 0 ? 1 : -1;
}

static int exact_sign(const double a[2], const double b[2], const double c[2]) {
    Sum sum = {.count = 0};
    add_product(&sum, a[0], b[1]);
    add_product(&sum, -a[1], b[0]);
    add_product(&sum, b[0], c[1]);
    add_product(&sum, -b[1], c[0]);
    add_product(&sum, c[0], a[1]);
    add_product(&sum, -c[1], a[0]);
    return sign_of(&sum);
}

int orient(const double a[2], const double b[2], const double c[2]) {
    /* (3 + 16 u) u with u = 2^-53, Shewchuk's bound for this order of operations. */
    static const double bound = 3.3306690738754716e-16;
    const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
    const double area = left - right;
    if (fabs(area) > bound * (fabs(left) + fabs(right)) + 1e-290) return area > 0 ? 1 : -1;
    return exact_sign(a, b, c);
}

/* Adds the determinant of three vectors, times `sign`, which is 1 or -1. */
static void add_determinant(Sum *sum, double sign, const double a[3], const double b[3], const double c[3]) {
    for (int x = 0; x < 3; x++)
        for (int turn = 0; turn < 2; turn++) {
            const int y = (x + 1 + turn) % 3, z = (x + 2 - turn) % 3;
            const double first = (turn == 0 ? sign : -sign) * a[x], product = first * b[y];
            add_product(sum, fma(first, b[y], -product), c[z]);
            add_product(sum, product, c[z]);
        }
}

static int exact_sign3(const double a[3], const double b[3], const double c[3], const double d[3]) {
    Sum sum = {.count = 0};
    add_determinant(&sum, 1, b, c, d);
    add_determinant(&sum, -1, b, c, a);
    add_determinant(&sum, 1, b, d, a);
    add_determinant(&sum, -1, c, d, a);
    return sign_of(&sum);
}

int orient3(const double a[3], const double b[3], const double c[3], const double d[3]) {
    /* (7 + 56 u) u, Shewchuk's bound for this order of operations. */
    static const double bound = 7.7715611723761027e-16;
    double u[3], v[3], w[3], volume = 0, size = 0;
    for (int i = 0; i < 3; i++) {
        u[i] = b[i] - a[i];
        v[i] = c[i] - a[i];
        w[i] = d[i] - a[i];
    }
    for (int i = 0; i < 3; i++) {
        const double left = v[(i + 1) % 3] * w[(i + 2) % 3], right = v[(i + 2) % 3] * w[(i + 1) % 3];
        volume += u[i] * (left - right);
        size += fabs(u[i]) * (fabs(left) + fabs(right));
    }
    if (fabs(volume) > bound * size + 1e-240) return volume > 0 ? 1 : -1;
    return exact_sign3(a, b, c, d);
}
