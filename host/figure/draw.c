/* draw.c: see draw.h. */
#include "draw.h"

#include "base/color.h"
#include "base/module.h"
#include "base/output_file.h"
#include "drawing.h"
#include "image/image.h"
#include "layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { SIDE_MAX = 32767 }; /* of Cairo */

/* A figure on its way. */
typedef struct Work {
    const BpFigure *figure;
    const BpFigurePage *page;
    const BpDrawing *drawing;
    BpSurface *surface;
    BpLayout layout;
} Work;

static BpStatus load_drawing(const BpDrawing **drawing, BpError *err) {
    static const BpModuleName name = {"ballpark_text.so", "BALLPARK_TEXT", BP_DRAWING_SYMBOL,
                                      BP_DRAWING_VERSION, false};
    const void *loaded = NULL;
    BpError fault = {0};
    if (bp_module_load(&name, &loaded, &fault) != BP_OK)
        return bp_fail(err, BP_ERR_USAGE,
                       "no text, PDF or SVG can be drawn, since %.650s; install Pango (`apt install "
                       "libpango1.0-dev`) and build "
                       "Ballpark again, or render PNG pictures without colour bars and other text",
                       fault.message);
    *drawing = loaded;
    return BP_OK;
}

static BpStatus fail_drawing(const char *fault, BpError *err) {
    return bp_fail(err, strstr(fault, "memory") != NULL ? BP_ERR_MEMORY : BP_ERR_USAGE,
                   "text cannot be drawn: %s", fault);
}

static bool write_nothing(void *out, const unsigned char *bytes, size_t size) {
    (void)out, (void)bytes, (void)size;
    return true;
}

static bool write_file(void *out, const unsigned char *bytes, size_t size) {
    return fwrite(bytes, 1, size, out) == size;
}

static BpStatus open_surface(Work *work, BpSurfaceKind kind, const uint32_t whole[2], FILE *out,
                             BpError *err) {
    const BpFigure *const figure = work->figure;
    const BpSurfacePage page = {.kind = kind,
                                .width = whole[0],
                                .height = whole[1],
                                .dots_per_inch = work->page->dots_per_inch,
                                .font = figure->font[0] != '\0' ? figure->font : BP_FIGURE_FONT,
                                .points = figure->points > 0 ? figure->points : BP_FIGURE_POINTS,
                                .write = out != NULL ? write_file : write_nothing,
                                .out = out};
    const char *const fault = work->drawing->open(&page, &work->surface);
    return fault == NULL ? BP_OK : fail_drawing(fault, err);
}

/* Loads the module and decides where everything stands. */
static BpStatus lay_out(Work *work, const uint32_t size[2], char *notes, size_t notes_size, BpError *err) {
    static const uint32_t small[2] = {1, 1};
    notes[0] = '\0';
    BP_TRY(load_drawing(&work->drawing, err));
    BpStatus status = open_surface(work, BP_SURFACE_PIXELS, small, NULL, err);
    if (status == BP_OK) {
        const char *const family = work->drawing->family(work->surface);
        const char *const asked = work->figure->font[0] != '\0' ? work->figure->font : BP_FIGURE_FONT;
        static const char *const generic[] = {"sans", "sans-serif", "serif", "monospace"};
        bool is_known = strncasecmp(asked, family, strlen(family)) == 0;
        for (size_t i = 0; i < sizeof generic / sizeof *generic; i++)
            is_known = is_known || strncasecmp(asked, generic[i], strlen(generic[i])) == 0;
        bp_figure_lay_out(work->figure, size, work->page->dots_per_inch, work->drawing, work->surface,
                          &work->layout, notes, notes_size);
        if (!is_known && bp_figure_has_text(work->figure))
            bp_figure_note(notes, notes_size, "the font \"%s\" is not installed; %s is used instead", asked,
                           family);
    }
    work->drawing->close(&work->surface);
    for (int d = 0; d < 2 && status == BP_OK; d++)
        if (work->layout.whole[d] > SIDE_MAX)
            status = bp_fail(
                err, BP_ERR_USAGE,
                "the figure has %u x %u pixels, and what draws text, PDF and SVG has at most %d along a "
                "side; render a smaller picture, or one without text as a PNG",
                work->layout.whole[0], work->layout.whole[1], SIDE_MAX);
    return status;
}

/* Black on light paper, white on dark paper. */
static const double *choose_ink(const Work *work) {
    static const double black[3] = {0, 0, 0}, white[3] = {1, 1, 1};
    const BpFigurePage *const page = work->page;
    if (work->figure->text != BP_TEXT_AUTO) return work->figure->text == BP_TEXT_BLACK ? black : white;
    const double luminance = bp_luminance_of(page->paper);
    return page->is_clear || bp_transfer_byte(luminance, page->transfer) >= 128 ? black : white;
}

static uint32_t word_of(const float linear[3], BpTransfer transfer) {
    uint32_t word = 0xff;
    for (int c = 0; c < 3; c++) word = word << 8 | bp_transfer_byte((double)linear[c], transfer);
    return word;
}

static BpStatus draw_bar(const Work *work, BpError *err) {
    const BpBox *const place = &work->layout.bar;
    const uint32_t width = (uint32_t)place->width, height = (uint32_t)place->height;
    uint32_t *const pixels = malloc((size_t)width * height * sizeof *pixels);
    if (pixels == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a colour bar");
    for (uint32_t y = 0; y < height; y++) {
        const double stop = (1 - (y + 0.5) / height) * (BP_COLOR_BAR_STOPS - 1);
        const uint32_t word = word_of(work->figure->bar.colors[(size_t)(stop + 0.5)], work->page->transfer);
        for (uint32_t x = 0; x < width; x++) pixels[(size_t)y * width + x] = word;
    }
    const BpDrawnImage image = {
        .pixels = pixels, .width = width, .height = height, .x = place->x, .y = place->y};
    work->drawing->image(work->surface, &image);
    free(pixels);
    return BP_OK;
}

/* Everything but picture and paper. */
static BpStatus draw_all(const Work *work, BpError *err) {
    const BpLayout *const layout = &work->layout;
    const double *const ink = choose_ink(work);
    const double white[3] = {1, 1, 1};
    const bool has_rim = work->page->is_clear && work->figure->text == BP_TEXT_AUTO;
    const double rim = has_rim ? layout->rim : 0;
    for (size_t r = 0; r < layout->rectangle_count && has_rim; r++) {
        const BpBox *const box = &layout->rectangles[r];
        work->drawing->rectangle(work->surface, box->x - rim, box->y - rim, box->width + 2 * rim,
                                 box->height + 2 * rim, white);
    }
    for (size_t r = 0; r < layout->rectangle_count; r++) {
        const BpBox *const box = &layout->rectangles[r];
        work->drawing->rectangle(work->surface, box->x, box->y, box->width, box->height, ink);
    }
    for (size_t t = 0; t < layout->text_count; t++) {
        const BpPlacedText *const text = &layout->texts[t];
        const BpDrawnText drawn = {.text = text->text,
                                   .x = text->x,
                                   .y = text->y,
                                   .is_upright = text->is_upright,
                                   .ink = ink,
                                   .rim = rim};
        work->drawing->text(work->surface, &drawn);
    }
    return layout->has_bar ? draw_bar(work, err) : BP_OK;
}

BpStatus bp_figure_measure(const BpFigure *figure, const BpFigurePage *page, const uint32_t size[2],
                           uint32_t whole[2], char *notes, size_t notes_size, BpError *err) {
    Work work = {.figure = figure, .page = page};
    BP_TRY(lay_out(&work, size, notes, notes_size, err));
    memcpy(whole, work.layout.whole, sizeof work.layout.whole);
    return BP_OK;
}

/* The pixel of the figure below what is drawn. */
static void put_ground(const Work *work, const BpPicture *picture, uint32_t x, uint32_t y, float rgb[3],
                       float *alpha) {
    const uint32_t u = x - work->layout.origin[0], v = y - work->layout.origin[1]; /* wraps: outside */
    const size_t from = (size_t)v * picture->width + u;
    if (u < picture->width && v < picture->height) {
        memcpy(rgb, picture->rgb + 3 * from, 3 * sizeof *rgb);
        if (alpha != NULL) *alpha = picture->alpha[from];
        return;
    }
    for (int c = 0; c < 3; c++) rgb[c] = work->page->is_clear ? 0 : (float)work->page->paper[c];
    if (alpha != NULL) *alpha = work->page->is_clear ? 0 : 1;
}

/* Lays a drawn pixel over one of the figure, in the numbers of an 8-bit file, as programs do that show PDF
 * and SVG. */
static void put_over(uint32_t drawn, BpTransfer transfer, float rgb[3], float *alpha) {
    const double cover = (drawn >> 24) / 255.0, below = alpha != NULL ? (double)*alpha : 1;
    const double whole = cover + below * (1 - cover);
    if (cover == 0) return;
    for (int c = 0; c < 3; c++) {
        const double ink = (drawn >> (16 - 8 * c) & 0xff) / 255.0; /* multiplied by `cover` */
        const double straight = below > 0 ? (double)rgb[c] / below : 0;
        const double ground = bp_transfer_byte(straight, transfer) / 255.0;
        const double mixed = (ink + ground * below * (1 - cover)) / whole;
        rgb[c] = (float)(whole * bp_transfer_inverse(floor(255 * mixed + 0.5) / 255, transfer));
    }
    if (alpha != NULL) *alpha = (float)whole;
}

static BpStatus compose(const Work *work, const uint32_t *drawn, size_t stride, BpPicture *picture,
                        BpError *err) {
    const uint32_t width = work->layout.whole[0], height = work->layout.whole[1];
    const size_t count = (size_t)width * height;
    const bool has_alpha = picture->alpha != NULL;
    BpPicture figure = {.width = width, .height = height};
    figure.rgb = malloc(count * 3 * sizeof *figure.rgb);
    if (has_alpha) figure.alpha = malloc(count * sizeof *figure.alpha);
    if (figure.rgb == NULL || (has_alpha && figure.alpha == NULL)) {
        bp_picture_clear(&figure);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a figure of %u x %u pixels", width, height);
    }
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const size_t i = (size_t)y * width + x;
            float *const alpha = has_alpha ? &figure.alpha[i] : NULL;
            put_ground(work, picture, x, y, figure.rgb + 3 * i, alpha);
            put_over(drawn[y * stride + x], work->page->transfer, figure.rgb + 3 * i, alpha);
        }
    bp_picture_clear(picture);
    *picture = figure;
    return BP_OK;
}

BpStatus bp_figure_draw(const BpFigure *figure, const BpFigurePage *page, BpPicture *picture, BpError *err) {
    Work work = {.figure = figure, .page = page};
    const uint32_t size[2] = {picture->width, picture->height};
    const uint32_t *drawn = NULL;
    size_t stride = 0;
    char notes[1]; /* bp_figure_measure() has them */
    BP_TRY(lay_out(&work, size, notes, sizeof notes, err));
    BpStatus status = open_surface(&work, BP_SURFACE_PIXELS, work.layout.whole, NULL, err);
    if (status == BP_OK) status = draw_all(&work, err);
    if (status == BP_OK) {
        const char *const fault = work.drawing->finish(work.surface, &drawn, &stride);
        status = fault == NULL ? compose(&work, drawn, stride, picture, err) : fail_drawing(fault, err);
    }
    work.drawing->close(&work.surface);
    return status;
}

/* The pixels as an image of the drawing has them. */
static uint32_t *encode_pixels(const BpPicture *picture, BpTransfer transfer) {
    const size_t count = (size_t)picture->width * picture->height;
    uint32_t *const words = malloc(count * sizeof *words);
    for (size_t i = 0; i < count && words != NULL; i++) {
        const double alpha = picture->alpha != NULL ? (double)picture->alpha[i] : 1;
        const uint32_t cover = (uint32_t)lround(255 * alpha);
        float straight[3];
        for (int c = 0; c < 3; c++)
            straight[c] = alpha > 0 ? (float)((double)picture->rgb[3 * i + (size_t)c] / alpha) : 0;
        const uint32_t word = word_of(straight, transfer);
        words[i] = cover << 24;
        for (int shift = 0; shift <= 16; shift += 8)
            words[i] |= ((word >> shift & 0xff) * cover + 127) / 255 << shift;
    }
    return words;
}

/* Paper, then the picture. */
static BpStatus draw_ground(const Work *work, const BpPicture *picture, bool with_png, BpError *err) {
    const BpFigurePage *const page = work->page;
    const BpLayout *const layout = &work->layout;
    const BpImageExtra none = {.note_count = 0};
    char *png = NULL;
    size_t size = 0;
    if (!page->is_clear && (layout->whole[0] > picture->width || layout->whole[1] > picture->height)) {
        double paper[3];
        for (int c = 0; c < 3; c++) paper[c] = bp_transfer_byte(page->paper[c], page->transfer) / 255.0;
        work->drawing->rectangle(work->surface, 0, 0, layout->whole[0], layout->whole[1], paper);
    }
    FILE *const memory = with_png ? open_memstream(&png, &size) : NULL;
    BpStatus status = BP_OK;
    if (memory != NULL) status = bp_png_write(picture, memory, page->transfer, &none, err);
    if (memory != NULL && fclose(memory) != 0 && status == BP_OK)
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a picture");
    uint32_t *const words = status == BP_OK ? encode_pixels(picture, page->transfer) : NULL;
    if (status == BP_OK && (words == NULL || (with_png && png == NULL)))
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a picture");
    if (status == BP_OK) {
        const BpDrawnImage image = {.pixels = words,
                                    .width = picture->width,
                                    .height = picture->height,
                                    .x = layout->origin[0],
                                    .y = layout->origin[1],
                                    .has_alpha = picture->alpha != NULL,
                                    .png = png,
                                    .png_size = size};
        work->drawing->image(work->surface, &image);
    }
    free(words);
    free(png);
    return status;
}

BpStatus bp_figure_print(const BpFigure *figure, const BpFigurePage *page, const BpPicture *picture,
                         BpFormat format, FILE *out, BpError *err) {
    Work work = {.figure = figure, .page = page};
    const uint32_t size[2] = {picture->width, picture->height};
    const uint32_t *drawn = NULL;
    size_t stride = 0;
    char notes[1]; /* bp_figure_measure() has them */
    const bool is_svg = format == BP_FORMAT_SVG;
    BP_TRY(lay_out(&work, size, notes, sizeof notes, err));
    BpStatus status =
        open_surface(&work, is_svg ? BP_SURFACE_SVG : BP_SURFACE_PDF, work.layout.whole, out, err);
    if (status == BP_OK) status = draw_ground(&work, picture, is_svg, err);
    if (status == BP_OK) status = draw_all(&work, err);
    if (status == BP_OK) {
        const char *const fault = work.drawing->finish(work.surface, &drawn, &stride);
        status = bp_output_finish(out, is_svg ? "SVG" : "PDF", err);
        if (status == BP_OK && fault != NULL) status = fail_drawing(fault, err);
    }
    work.drawing->close(&work.surface);
    return status;
}
