/* layout.h: where everything stands in a figure.
 *
 * In:    a figure, the size of its picture, what measures text.   Out: places in pixels.
 * Knows: how colour bars look in print.   Does not know: how they are drawn, which colours they have. */
#ifndef BP_FIGURE_LAYOUT_H
#define BP_FIGURE_LAYOUT_H

#include "drawing.h"
#include "figure.h"
#include "ticks.h"

enum { BP_LAYOUT_TEXTS_MAX = BP_TICKS_MAX + 1, BP_LAYOUT_RECTANGLES_MAX = BP_TICKS_MAX + 1 };

typedef struct BpBox {
    double x, y, width, height;
} BpBox;

typedef struct BpPlacedText {
    const char *text; /* of the figure, or of the layout's ticks */
    double x, y;      /* the beginning of the baseline */
    bool is_upright;
    BpBox box; /* that the letters stay within */
} BpPlacedText;

typedef struct BpLayout {
    uint32_t whole[2];  /* the figure's width and height */
    uint32_t origin[2]; /* of the picture in it */
    double rim;         /* the width of a rim around letters, for which there is room */
    BpTick ticks[BP_TICKS_MAX];
    BpPlacedText texts[BP_LAYOUT_TEXTS_MAX];
    size_t text_count;
    BpBox rectangles[BP_LAYOUT_RECTANGLES_MAX]; /* filled with the colour of the text: frames and marks */
    size_t rectangle_count;
    bool has_bar;
    BpBox bar; /* whole pixels, over its frame */
} BpLayout;

/* Texts overlap neither each other nor the picture, and lie within the figure. What does not fit is left out,
 * and `notes` has a sentence about it. The layout must stay where it is, since texts point to its ticks. */
void bp_figure_lay_out(const BpFigure *figure, const uint32_t size[2], double dots_per_inch,
                       const BpDrawing *drawing, BpSurface *surface, BpLayout *layout, char *notes,
                       size_t notes_size);

/* Appends a sentence to `notes`, after a line feed if there is one already. */
void bp_figure_note(char *notes, size_t size, const char *format, ...) BP_PRINTF_LIKE(3, 4);

#endif
