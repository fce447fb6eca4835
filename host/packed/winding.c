/* winding.c: see winding.h. */
#include "winding.h"

#include <math.h>
#include <stddef.h>

/* The sign of a * d - b * c. Rounding keeps order, so what it makes equal is compared by its errors. */
static int sign_of_difference(double a, double d, double b, double c) {
    double one = a * d, other = b * c;
    if (one == other) {
        one = fma(a, d, -one);
        other = fma(b, c, -other);
    }
    return one > other ? 1 : one < other ? -1 : 0;
}

/* How an edge of a triangle, seen along x, goes around the origin: past the positive y axis. */
static int edge_winding(const double a[3], const double b[3]) {
    const int side = sign_of_difference(a[1], b[2], a[2], b[1]);
    if (a[2] <= 0 && b[2] > 0) return side > 0 ? 1 : 0;
    if (a[2] > 0 && b[2] <= 0) return side < 0 ? -1 : 0;
    return 0;
}

/* A sum of doubles without an error, smallest first, as J. Shewchuk, "Adaptive Precision Floating-Point
 * Arithmetic and Fast Robust Geometric Predicates", 1997, grows it. */
typedef struct Expansion {
    double parts[24];
    size_t count;
} Expansion;

static void add(Expansion *sum, double value) {
    for (size_t i = 0; i < sum->count; i++) {
        const double part = sum->parts[i], together = value + part;
        const double of_part = together - value, of_value = together - of_part;
        sum->parts[i] = (value - of_value) + (part - of_part);
        value = together;
    }
    sum->parts[sum->count++] = value;
}

/* x * y * z: four parts. */
static void add_product(Expansion *sum, double x, double y, double z) {
    const double high = y * z, low = fma(y, z, -high);
    const double a = x * high, b = x * low;
    add(sum, fma(x, low, -b));
    add(sum, b);
    add(sum, fma(x, high, -a));
    add(sum, a);
}

/* Of the determinant of three vectors. */
static int sign_of_volume(const double a[3], const double b[3], const double c[3]) {
    Expansion sum = {.count = 0};
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        add_product(&sum, a[i], b[j], c[k]);
        add_product(&sum, -a[i], b[k], c[j]);
    }
    for (size_t i = sum.count; i > 0; i--)
        if (sum.parts[i - 1] != 0) return sum.parts[i - 1] > 0 ? 1 : -1;
    return 0;
}

int bp_axis_crossing(const double a[3], const double b[3], const double c[3]) {
    const int around = edge_winding(a, b) + edge_winding(b, c) + edge_winding(c, a);
    return around != 0 && sign_of_volume(a, b, c) == around ? around : 0;
}
