/* figure.h: what is written beside a picture.
 *
 * In:    values, colours, texts.   Out: the struct that has them.
 * Knows: what a figure in print has.   Does not know: scenes, how it is drawn (draw.h). */
#ifndef BP_FIGURE_FIGURE_H
#define BP_FIGURE_FIGURE_H

#include "base/status.h"

enum { BP_FIGURE_TEXT_SIZE = 256, BP_COLOR_BAR_STOPS = 256 };

#define BP_FIGURE_FONT "DejaVu Sans"
#define BP_FIGURE_POINTS 7.0
#define BP_FIGURE_POINTS_MIN 1.0
#define BP_FIGURE_POINTS_MAX 144.0
#define BP_FIGURE_DPI 300.0

/* The colour of text and lines. AUTO: black on light paper, white on dark paper, and black with a white rim
 * where the paper is transparent, which can be read on any page. */
typedef enum BpFigureText { BP_TEXT_AUTO, BP_TEXT_BLACK, BP_TEXT_WHITE } BpFigureText;
extern const char *const bp_figure_text_names[];

/* The values that the colours of a map stand for. */
typedef struct BpColorBar {
    bool shown;
    char label[BP_FIGURE_TEXT_SIZE];     /* UTF-8, with its unit; "": none */
    double range[2];                     /* finite, the least value first */
    float colors[BP_COLOR_BAR_STOPS][3]; /* linear, from the least value to the most */
} BpColorBar;

/* What is written beside a picture. All zeros: nothing. */
typedef struct BpFigure {
    char font[BP_FIGURE_TEXT_SIZE]; /* a family and its style, "Arial Bold"; "": the default */
    double points;                  /* the size of the text; 0: the default */
    BpFigureText text;
    BpColorBar bar;
} BpFigure;

/* Whether there is anything to write. */
bool bp_figure_has_text(const BpFigure *figure);

#endif
