/* text.h: draws small letters into an 8-bit picture, for legends.
 *
 * In:    a canvas, a string.   Out: pixels; a picture with them.
 * Knows: the shapes of digits, small letters and the signs of expressions.   Does not know: what is written.
 */
#ifndef BP_IMAGE_TEXT_H
#define BP_IMAGE_TEXT_H

#include "ballpark.h"

/* 8-bit RGB, top row first; the pixels are the caller's. */
typedef struct BpCanvas {
    uint32_t width, height;
    uint8_t *rgb;
} BpCanvas;

#define BP_TEXT_ADVANCE 6u /* pixels from one letter to the next, at scale 1 */
#define BP_TEXT_HEIGHT 8u  /* seven above the line and one below */

/* Fills a rectangle, clipped to the canvas. */
void bp_canvas_fill(BpCanvas *canvas, uint32_t x, uint32_t y, uint32_t width, uint32_t height,
                    const uint8_t color[3]);

/* Writes `text` with its upper left corner at (x, y), each dot `scale` pixels wide. An unknown letter is a
 * gap. */
void bp_canvas_text(BpCanvas *canvas, uint32_t x, uint32_t y, uint32_t scale, const char *text,
                    const uint8_t color[3]);

/* Copies the canvas to the picture's radiance, encoded for 8-bit files through `transfer`: all of it, which
 * is as wide as the picture, to the rows from `top` on, except for pixels of the colour `untouched`
 * (Optional). The alpha of drawn pixels becomes 1. */
void bp_canvas_copy(const BpCanvas *canvas, const uint8_t untouched[3], BpPicture *picture, uint32_t top,
                    BpTransfer transfer);

/* The width of `text` in pixels, without the gap after its last letter. */
uint32_t bp_text_width(const char *text, uint32_t scale);

#endif
