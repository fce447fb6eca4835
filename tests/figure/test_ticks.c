/* test_ticks.c: the marks of a scale, against numbers read back from their labels (host/figure/ticks.h). */
#include "support/unit_test.h"

#include "figure/ticks.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The number that a label shows, and in *last what its last decimal is worth. */
static double read_label(const char *label, double *last) {
    static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    char digits[64] = "";
    double sign = 1;
    if (strncmp(label, "−", strlen("−")) == 0) {
        sign = -1;
        label += strlen("−");
    }
    const size_t length = strspn(label, "0123456789.");
    memcpy(digits, label, length);
    label += length;
    const char *const point = strchr(digits, '.');
    int exponent = 0, power_sign = 1;
    if (strncmp(label, "×10", strlen("×10")) == 0) {
        label += strlen("×10");
        if (strncmp(label, "⁻", strlen("⁻")) == 0) {
            power_sign = -1;
            label += strlen("⁻");
        }
        for (bool found = true; found;) {
            found = false;
            for (int d = 0; d < 10 && !found; d++)
                if (strncmp(label, raised[d], strlen(raised[d])) == 0) {
                    exponent = 10 * exponent + d;
                    label += strlen(raised[d]);
                    found = true;
                }
        }
    }
    assert_string_equal(label, "");
    char number[96];
    snprintf(number, sizeof number, "%se%d", digits, power_sign * exponent);
    *last = pow(10, power_sign * exponent - (point == NULL ? 0 : (int)strlen(point + 1)));
    return sign * strtod(number, NULL);
}

/* How many multiples of the step lie in the range. */
static double count_multiples(const double range[2], double step) {
    return floor(range[1] / step + 1e-9) - ceil(range[0] / step - 1e-9) + 1;
}

static void check_range(double least, double greatest, double apart) {
    const double range[2] = {least, greatest}, width = greatest - least;
    BpTick ticks[BP_TICKS_MAX];
    double values[BP_TICKS_MAX], last = 0, own = 0;
    const size_t count = bp_ticks_choose(range, apart, ticks);
    assert_true(count >= 2 && count <= BP_TICKS_MAX);
    for (size_t t = 0; t < count; t++) {
        values[t] = read_label(ticks[t].label, &own);
        last = fmax(last, own); /* a 0 that was rounded has no decimals */
        assert_true(ticks[t].share >= 0 && ticks[t].share <= 1);
        if (t > 0) assert_true(values[t] > values[t - 1]);
        if (t > 0) assert_true(ticks[t].share - ticks[t - 1].share >= apart - 1e-6);
    }
    const bool ends = count == 2 && !(ticks[0].share > 0) && !(ticks[1].share < 1);
    const double step = values[1] - values[0];
    for (size_t t = 0; t < count; t++) {
        const double place = least + ticks[t].share * width;
        const double off = fabs(values[t] - place);
        if (!(off <= (ends ? 0.501 * last : 2e-9 * width + 1e-12 * fabs(place))))
            fail_msg("[%.17g, %.17g]: \"%s\" stands at %.17g", least, greatest, ticks[t].label, place);
        if (t > 0 && !ends) assert_true(fabs(values[t] - values[t - 1] - step) <= 1e-6 * step);
    }
    /* No finer step would have done. */
    for (int exponent = -4; exponent <= 1; exponent++)
        for (int m = 0; m < 3; m++) {
            const double finer = (double[]){1, 2, 5}[m] * pow(10, floor(log10(width)) + exponent);
            const double marks = count_multiples(range, finer);
            if (finer >= apart * width && marks <= BP_TICKS_MAX && marks > (double)count)
                fail_msg("[%.17g, %.17g]: %zu marks, and %g by %g", least, greatest, count, marks, finer);
        }
}

static double draw(void) {
    return rand() / (double)RAND_MAX;
}

static void labels_say_where_they_stand(void **state) {
    (void)state;
    srand(7);
    for (int i = 0; i < 40000; i++) {
        const double width = pow(10, 24 * draw() - 12), middle = (draw() - 0.5) * width * pow(10, 3 * draw());
        check_range(middle - width / 2, middle + width / 2, draw());
    }
    check_range(-1, 1, 0);
    check_range(0, 1e300, 0.2);
    check_range(1e6, 1e6 + 1, 0.2);
    check_range(99999, 100001, 1);
}

static void choose(double least, double greatest, double apart, const char *expected) {
    const double range[2] = {least, greatest};
    BpTick ticks[BP_TICKS_MAX];
    char text[1024] = "";
    const size_t count = bp_ticks_choose(range, apart, ticks);
    for (size_t t = 0; t < count; t++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s%s", t > 0 ? " " : "", ticks[t].label);
    assert_string_equal(text, expected);
}

static void numbers_are_written_as_people_write_them(void **state) {
    (void)state;
    choose(0, 1, 0.15, "0.0 0.2 0.4 0.6 0.8 1.0");
    choose(-0.3, 2.65, 0.1, "0.0 0.5 1.0 1.5 2.0 2.5");
    choose(-1, 1, 0.4, "−1 0 1");
    choose(0, 9000, 0.2, "0 2000 4000 6000 8000");
    choose(-2e6, 2e6, 0.2, "−2×10⁶ −1×10⁶ 0 1×10⁶ 2×10⁶");
    choose(0, 3e-5, 0.3, "0 1×10⁻⁵ 2×10⁻⁵ 3×10⁻⁵");
    choose(1.5e10, 2.5e10, 0.5, "1.5×10¹⁰ 2.0×10¹⁰ 2.5×10¹⁰");
    choose(0.31, 0.39, 0.5, "0.310 0.390"); /* 0.35 alone is round: both ends */
    choose(5, 5, 0.1, "5.000");
    choose(0, 0, 0.1, "0");
    choose(-1.7e308, 1.7e308, 0.1, "−1.70×10³⁰⁸ 1.70×10³⁰⁸");
    choose(0, 5e-324, 0.1, "0 5×10⁻³²⁴");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(labels_say_where_they_stand),
        cmocka_unit_test(numbers_are_written_as_people_write_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
