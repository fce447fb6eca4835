/* drawing.h: the functions by which a module draws text, rectangles and images.
 *
 * In:    text, places in pixels.   Out: pixels, or the bytes of a PDF or SVG file.
 * Knows: nothing.   Does not know: what is drawn (figure.h), who draws it
 * (cairo/ballpark_text.c).
 *
 * Places are in pixels of the figure, from its upper left corner, and need not be whole. Texts are UTF-8. The
 * functions that return a text return NULL for success, or else what is wrong, valid until the next call. */
#ifndef BP_FIGURE_DRAWING_H
#define BP_FIGURE_DRAWING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define BP_DRAWING_SYMBOL "bp_drawing_module"
#define BP_DRAWING_VERSION 1u

typedef enum BpSurfaceKind { BP_SURFACE_PIXELS, BP_SURFACE_PDF, BP_SURFACE_SVG } BpSurfaceKind;

/* What is drawn on; belongs to the module. */
typedef struct BpSurface BpSurface;

typedef struct BpSurfacePage {
    BpSurfaceKind kind;
    uint32_t width, height; /* pixels */
    double dots_per_inch;
    const char *font; /* family and style */
    double points;    /* size of the text */
    /* Takes the bytes of a file; false: no more can be written. */
    bool (*write)(void *out, const unsigned char *bytes, size_t size);
    void *out;
} BpSurfacePage;

/* In pixels. */
typedef struct BpTextExtent {
    double width;
    double ascent, descent; /* of the font, above and below the baseline */
    double rise;            /* of this text's ink above the baseline */
    bool lacks_signs;       /* no font has all of its letters */
} BpTextExtent;

typedef struct BpDrawnText {
    const char *text;
    double x, y;       /* the beginning of the baseline */
    bool is_upright;   /* else it runs upward, turned to the left by a quarter */
    const double *ink; /* encoded RGB, 0 to 1 */
    double rim;        /* width of a white rim around the letters; 0: none */
} BpDrawnText;

/* Rows of 32-bit words without gaps, the top row first: alpha, red, green and blue from the highest byte on,
 * the colours multiplied by the alpha. */
typedef struct BpDrawnImage {
    const uint32_t *pixels; /* the module does not keep them */
    uint32_t width, height;
    double x, y;
    bool has_alpha;  /* else the highest bytes have no meaning */
    const void *png; /* Optional: the same as a PNG file, for formats that can hold it */
    size_t png_size;
} BpDrawnImage;

typedef struct BpDrawing {
    uint32_t version;
    /* *surface is to be closed, also after a failure. */
    const char *(*open)(const BpSurfacePage *page, BpSurface **surface);
    /* The family of the font that stands for the one that was asked for. */
    const char *(*family)(BpSurface *surface);
    void (*measure)(BpSurface *surface, const char *text, BpTextExtent *extent);
    void (*text)(BpSurface *surface, const BpDrawnText *text);
    void (*rectangle)(BpSurface *surface, double x, double y, double width, double height,
                      const double color[3]);
    void (*image)(BpSurface *surface, const BpDrawnImage *image);
    /* Ends the drawing; of BP_SURFACE_PIXELS, *pixels are as in BpDrawnImage, in rows of *stride words, until
     * the surface is closed. */
    const char *(*finish)(BpSurface *surface, const uint32_t **pixels, size_t *stride);
    void (*close)(BpSurface **surface);
} BpDrawing;

#endif
