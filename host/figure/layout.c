/* layout.c: see layout.h. Lengths are multiples of the text's size, as they are in print. */
#include "layout.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

typedef struct Plan {
    const BpFigure *figure;
    const BpDrawing *drawing;
    BpSurface *surface;
    BpLayout *layout;
    double em;             /* the size of the text, pixels */
    double line, thin;     /* the height of a line of text, the width of a drawn line */
    double digit, outside; /* the height of digits; how far a line extends above or below their middle */
    double dots_per_inch;
    char *notes;
    size_t notes_size;
} Plan;

void bp_figure_note(char *notes, size_t size, const char *format, ...) {
    const size_t used = strlen(notes);
    va_list arguments;
    va_start(arguments, format);
    const int head = used == 0 ? 0 : snprintf(notes + used, size - used, "\n");
    if (used + (size_t)head < size)
        vsnprintf(notes + used + head, size - used - (size_t)head, format, arguments);
    va_end(arguments);
}

static double millimetres(const Plan *plan, double pixels) {
    return pixels / plan->dots_per_inch * 25.4;
}

static BpTextExtent measure(const Plan *plan, const char *text) {
    BpTextExtent extent = {0};
    plan->drawing->measure(plan->surface, text, &extent);
    return extent;
}

static void add_rectangle(const Plan *plan, double x, double y, double width, double height) {
    plan->layout->rectangles[plan->layout->rectangle_count++] = (BpBox){x, y, width, height};
}

/* From x on, with its middle at y. */
static void add_text(const Plan *plan, const char *text, double x, double y) {
    const BpTextExtent extent = measure(plan, text);
    const double baseline = y + plan->digit / 2;
    plan->layout->texts[plan->layout->text_count++] =
        (BpPlacedText){.text = text,
                       .x = x,
                       .y = baseline,
                       .is_upright = true,
                       .box = {x, baseline - extent.ascent, extent.width, extent.ascent + extent.descent}};
}

/* Upward, to the right of x, with its middle at y. */
static void add_turned_text(const Plan *plan, const char *text, double x, double y) {
    const BpTextExtent extent = measure(plan, text);
    plan->layout->texts[plan->layout->text_count++] =
        (BpPlacedText){.text = text,
                       .x = x + extent.ascent,
                       .y = y + extent.width / 2,
                       .box = {x, y - extent.width / 2, extent.ascent + extent.descent, extent.width}};
}

/* To the right of x; returns where it ends. */
static double lay_out_bar(const Plan *plan, double x, double height) {
    BpLayout *const layout = plan->layout;
    const BpColorBar *const bar = &plan->figure->bar;
    /* Half a label stands out above and below. */
    const double end = ceil(fmax(plan->outside, plan->thin)), length = height - 2 * end;
    if (length < 2 * plan->line) {
        bp_figure_note(
            plan->notes, plan->notes_size,
            "the colour bar is left out: text of %g points needs a picture of %.0f pixels in height, and "
            "this one has %.0f; ask for a larger picture, smaller text (\"figure\": { \"size\": 5 }) or "
            "fewer dots per inch (--dpi)",
            plan->em * 72 / plan->dots_per_inch, 2 * plan->line + 2 * end, height);
        return x;
    }
    const double left = ceil(x + 0.6 * plan->em + plan->thin), width = ceil(0.9 * plan->em);
    const size_t count = bp_ticks_choose(bar->range, 1.8 * plan->line / length, layout->ticks);
    layout->has_bar = true;
    layout->bar = (BpBox){left, end, width, length};
    add_rectangle(plan, left - plan->thin, end - plan->thin, width + 2 * plan->thin, length + 2 * plan->thin);
    const double mark = left + width + plan->thin, label = mark + 0.5 * plan->em;
    double right = label;
    for (size_t t = 0; t < count; t++) {
        const double y = end + (1 - layout->ticks[t].share) * length;
        add_rectangle(plan, mark, fmin(fmax(y - plan->thin / 2, end - plan->thin), end + length),
                      0.3 * plan->em, plan->thin);
        add_text(plan, layout->ticks[t].label, label, y);
        right = fmax(right, label + measure(plan, layout->ticks[t].label).width);
    }
    if (bar->label[0] == '\0') return right;
    const double needed = measure(plan, bar->label).width;
    if (needed <= height) {
        add_turned_text(plan, bar->label, right + 0.4 * plan->em, height / 2);
        return right + 0.4 * plan->em + plan->line;
    }
    bp_figure_note(
        plan->notes, plan->notes_size,
        "the label \"%s\" is left out: it is %.0f pixels long (%.1f mm), and the picture is %.0f pixels "
        "high; shorten it, or ask for a larger picture, smaller text (\"figure\": { \"size\": 5 }) or "
        "fewer dots per inch (--dpi)",
        bar->label, needed, millimetres(plan, needed), height);
    return right;
}

static void check_signs(const Plan *plan) {
    for (size_t t = 0; t < plan->layout->text_count; t++)
        if (measure(plan, plan->layout->texts[t].text).lacks_signs)
            bp_figure_note(
                plan->notes, plan->notes_size,
                "no font that is installed has all letters of \"%s\"; boxes stand for those that are missing",
                plan->layout->texts[t].text);
}

void bp_figure_lay_out(const BpFigure *figure, const uint32_t size[2], double dots_per_inch,
                       const BpDrawing *drawing, BpSurface *surface, BpLayout *layout, char *notes,
                       size_t notes_size) {
    const double points = figure->points > 0 ? figure->points : BP_FIGURE_POINTS;
    Plan plan = {.figure = figure,
                 .drawing = drawing,
                 .surface = surface,
                 .layout = layout,
                 .em = points / 72 * dots_per_inch,
                 .dots_per_inch = dots_per_inch,
                 .notes = notes,
                 .notes_size = notes_size};
    const BpTextExtent digit = measure(&plan, "0");
    plan.line = digit.ascent + digit.descent;
    plan.digit = digit.rise;
    plan.outside = fmax(digit.ascent - digit.rise / 2, digit.descent + digit.rise / 2);
    plan.thin = fmax(1, round(plan.em / 14)); /* half a point beside 7 */
    *layout = (BpLayout){.rim = 0.12 * plan.em};
    double right = size[0];
    if (figure->bar.shown) right = lay_out_bar(&plan, right, size[1]);
    if (right > size[0]) right = ceil(right + 0.3 * plan.em);
    layout->whole[0] = (uint32_t)right;
    layout->whole[1] = size[1];
    check_signs(&plan);
}
