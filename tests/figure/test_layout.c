/* test_layout.c: what stands beside a picture overlaps nothing, whatever is asked for (host/figure/layout.h).
 *
 * Text is measured by a font whose letters all have the same width. */
#include "support/unit_test.h"

#include "figure/layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double em;

static void measure(BpSurface *surface, const char *text, BpTextExtent *extent) {
    (void)surface;
    double letters = 0;
    for (; *text != '\0'; text++) letters += ((unsigned char)*text & 0xc0) != 0x80;
    *extent = (BpTextExtent){
        .width = 0.62 * em * letters, .ascent = 0.93 * em, .descent = 0.24 * em, .rise = 0.73 * em};
}

static const BpDrawing drawing = {.measure = measure};

static bool is_apart(BpBox a, BpBox b) {
    return a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y;
}

static bool is_inside(BpBox a, double width, double height) {
    const double slack = 1e-9 * (width + height);
    return a.x >= -slack && a.y >= -slack && a.x + a.width <= width + slack &&
           a.y + a.height <= height + slack;
}

/* The letters and a rim around them. */
static BpBox with_rim(BpBox box, double rim) {
    return (BpBox){box.x - rim, box.y - rim, box.width + 2 * rim, box.height + 2 * rim};
}

static void lay_out(const BpFigure *figure, uint32_t width, uint32_t height, double dots_per_inch,
                    BpLayout *layout, char notes[2048]) {
    const uint32_t size[2] = {width, height};
    notes[0] = '\0';
    em = (figure->points > 0 ? figure->points : 7) / 72 * dots_per_inch;
    bp_figure_lay_out(figure, size, dots_per_inch, &drawing, NULL, layout, notes, 2048);
}

static void check(const BpLayout *layout, uint32_t width, uint32_t height) {
    const double w = layout->whole[0], h = layout->whole[1];
    const BpBox picture = {layout->origin[0], layout->origin[1], width, height};
    assert_true(is_inside(picture, w, h));
    for (size_t t = 0; t < layout->text_count; t++) {
        const BpBox box = layout->texts[t].box;
        assert_true(is_inside(box, w, h));
        assert_true(is_apart(with_rim(box, layout->rim), picture));
        for (size_t u = 0; u < t; u++) assert_true(is_apart(box, layout->texts[u].box));
        for (size_t r = 0; r < layout->rectangle_count; r++)
            assert_true(is_apart(box, layout->rectangles[r]));
        if (layout->has_bar) assert_true(is_apart(box, layout->bar));
    }
    for (size_t r = 0; r < layout->rectangle_count; r++) {
        assert_true(is_inside(layout->rectangles[r], w, h));
        assert_true(is_apart(with_rim(layout->rectangles[r], layout->rim), picture));
    }
    if (!layout->has_bar) return;
    assert_true(layout->bar.x >= width && is_inside(layout->bar, w, h));
    assert_true(floor(layout->bar.x) == layout->bar.x && floor(layout->bar.height) == layout->bar.height);
}

static double draw(void) {
    return rand() / (double)RAND_MAX;
}

static BpFigure figure_of(double points, double least, double greatest, const char *label) {
    BpFigure figure = {.points = points, .bar = {.shown = true, .range = {least, greatest}}};
    snprintf(figure.bar.label, sizeof figure.bar.label, "%s", label);
    return figure;
}

/* What is there, and what is said not to be, is all of it. */
static void nothing_overlaps(void **state) {
    (void)state;
    static BpLayout layout;
    char notes[2048], label[64];
    srand(11);
    for (int i = 0; i < 20000; i++) {
        const double width = pow(10, 30 * draw() - 15), least = (draw() - 0.5) * width * pow(10, 6 * draw());
        const uint32_t size[2] = {1 + (uint32_t)pow(10, 3.5 * draw()), 1 + (uint32_t)pow(10, 3.5 * draw())};
        const int letters = (int)(40 * draw());
        snprintf(label, sizeof label, "%.*s", letters, "a label that has up to forty letters, Å, ²");
        const BpFigure figure = figure_of(1 + 20 * draw(), least, least + width, label);
        lay_out(&figure, size[0], size[1], 40 + 900 * draw(), &layout, notes);
        check(&layout, size[0], size[1]);
        const bool has_label =
            layout.text_count > 0 && layout.texts[layout.text_count - 1].text == figure.bar.label;
        assert_true(layout.has_bar != (strstr(notes, "bar is left out") != NULL));
        if (layout.has_bar && letters > 0)
            assert_true(has_label != (strstr(notes, "is left out: it is") != NULL));
        if (layout.has_bar) assert_true(layout.text_count >= 2u + (has_label ? 1u : 0u));
        if (!layout.has_bar) assert_int_equal(layout.whole[0], size[0]);
    }
}

/* A mark is level with its value on the bar, and the middle of its digits with the mark. */
static void marks_are_level_with_their_values(void **state) {
    (void)state;
    static BpLayout layout;
    char notes[2048];
    const BpFigure figure = figure_of(7, 0, 1, "x");
    lay_out(&figure, 400, 300, 300, &layout, notes);
    assert_int_equal(layout.text_count, 1 + layout.rectangle_count - 1);
    for (size_t t = 0; t + 1 < layout.text_count; t++) {
        const double value = strtod(layout.texts[t].text, NULL);
        const double level = layout.bar.y + (1 - value) * layout.bar.height;
        const BpBox mark = layout.rectangles[1 + t];
        assert_true(fabs(mark.y + mark.height / 2 - level) <= mark.height);
        assert_true(fabs(layout.texts[t].y - 0.73 * em / 2 - level) < 1e-9);
    }
    assert_string_equal(notes, "");
}

/* Lengths in print do not depend on the resolution. */
static void print_is_alike_at_any_resolution(void **state) {
    (void)state;
    static BpLayout coarse, fine;
    char notes[2048];
    const BpFigure figure = figure_of(8, -5, 17, "speed (Å/ps)");
    lay_out(&figure, 400, 300, 150, &coarse, notes);
    lay_out(&figure, 1600, 1200, 600, &fine, notes);
    assert_int_equal(coarse.text_count, fine.text_count);
    for (size_t t = 0; t < fine.text_count; t++) {
        assert_string_equal(coarse.texts[t].text, fine.texts[t].text);
        assert_true(fabs(4 * coarse.texts[t].x - fine.texts[t].x) < 16);
        assert_true(fabs(4 * coarse.texts[t].y - fine.texts[t].y) < 16);
    }
}

static void nothing_to_write_changes_nothing(void **state) {
    (void)state;
    static BpLayout layout;
    char notes[2048];
    const BpFigure figure = {.points = 0};
    lay_out(&figure, 40, 30, 300, &layout, notes);
    assert_int_equal(layout.whole[0], 40);
    assert_int_equal(layout.whole[1], 30);
    assert_int_equal(layout.text_count + layout.rectangle_count, 0);
    assert_string_equal(notes, "");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_overlaps),
        cmocka_unit_test(marks_are_level_with_their_values),
        cmocka_unit_test(print_is_alike_at_any_resolution),
        cmocka_unit_test(nothing_to_write_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
