/* draw.h: a picture as a journal prints it, with text in margins of its own.
 *
 * In:    a picture, what is to be written beside it.   Out: a wider picture; a PDF or SVG file.
 * Knows: the module that draws, paper and ink.   Does not know: scenes, where everything stands. */
#ifndef BP_FIGURE_DRAW_H
#define BP_FIGURE_DRAW_H

#include "figure.h"

#include <stdio.h>

/* What it is drawn on. */
typedef struct BpFigurePage {
    double dots_per_inch; /* above 0 */
    BpTransfer transfer;
    bool is_clear;   /* transparent, as the picture is */
    double paper[3]; /* otherwise: the radiance of the margins */
} BpFigurePage;

/* The size in pixels of the figure around a picture of width x height pixels. Loads the module that draws,
 * and reports in `notes` (UTF-8, sentences for people; "": nothing) what does not fit and fonts that are not
 * there. BP_ERR_USAGE: the module or all fonts are missing; for use before a long render. */
BpStatus bp_figure_measure(const BpFigure *figure, const BpFigurePage *page, const uint32_t size[2],
                           uint32_t whole[2], char *notes, size_t notes_size, BpError *err);

/* Replaces the radiance and alpha of `picture` by those of the figure around it, and releases what else it
 * has. The pixels of the picture stay as they are. The picture is unchanged on failure. */
BpStatus bp_figure_draw(const BpFigure *figure, const BpFigurePage *page, BpPicture *picture, BpError *err);

/* Writes the figure as BP_FORMAT_PDF or BP_FORMAT_SVG: the picture as the bytes of an 8-bit PNG, text and
 * lines as vectors. Equal figures give equal files, with the same fonts and libraries. */
BpStatus bp_figure_print(const BpFigure *figure, const BpFigurePage *page, const BpPicture *picture,
                         BpFormat format, FILE *out, BpError *err);

#endif
