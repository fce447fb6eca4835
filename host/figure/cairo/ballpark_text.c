/* ballpark_text.c: the module that draws by Cairo and Pango; see drawing.h. */
#include "figure/drawing.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <pango/pangocairo.h>

#include <stdlib.h>
#include <string.h>

struct BpSurface {
    cairo_surface_t *cairo;
    cairo_t *pen;
    PangoLayout *layout;
    PangoFontDescription *font;
    char family[256];
    bool (*write)(void *out, const unsigned char *bytes, size_t size);
    void *out;
    bool is_svg;
};

static cairo_status_t write_bytes(void *closure, const unsigned char *bytes, unsigned int size) {
    const BpSurface *const surface = closure;
    return surface->write(surface->out, bytes, size) ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

/* Without a date, so that equal figures give equal files. */
static cairo_surface_t *open_pdf(BpSurface *surface, double width, double height) {
    cairo_surface_t *const pdf = cairo_pdf_surface_create_for_stream(write_bytes, surface, width, height);
    cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_CREATE_DATE, "");
    cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_CREATOR, "Ballpark");
    return pdf;
}

/* Shapes of letters and their distances are the same in pixels and in vectors: nothing is moved to whole
 * pixels. */
static void use_exact_letters(cairo_t *pen, PangoContext *context) {
    cairo_font_options_t *const options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(pen, options);
    pango_cairo_context_set_font_options(context, options);
    pango_context_set_round_glyph_positions(context, FALSE);
    cairo_font_options_destroy(options);
}

static bool find_family(BpSurface *surface, PangoContext *context) {
    PangoFont *const found = pango_context_load_font(context, surface->font);
    if (found == NULL) return false;
    PangoFontDescription *const description = pango_font_describe(found);
    const char *const family = pango_font_description_get_family(description);
    if (family != NULL) strncpy(surface->family, family, sizeof surface->family - 1);
    pango_font_description_free(description);
    g_object_unref(found);
    return true;
}

static const char *open_surface(const BpSurfacePage *page, BpSurface **made) {
    const double points = 72 / page->dots_per_inch; /* of a pixel */
    BpSurface *const surface = calloc(1, sizeof *surface);
    *made = surface;
    if (surface == NULL) return "out of memory";
    surface->write = page->write;
    surface->out = page->out;
    surface->is_svg = page->kind == BP_SURFACE_SVG;
    if (page->kind == BP_SURFACE_PIXELS)
        surface->cairo = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, (int)page->width, (int)page->height);
    else if (page->kind == BP_SURFACE_PDF)
        surface->cairo = open_pdf(surface, points * page->width, points * page->height);
    else
        surface->cairo = cairo_svg_surface_create_for_stream(write_bytes, surface, points * page->width,
                                                             points * page->height);
    surface->pen = cairo_create(surface->cairo);
    if (cairo_status(surface->pen) != CAIRO_STATUS_SUCCESS)
        return cairo_status_to_string(cairo_status(surface->pen));
    if (page->kind != BP_SURFACE_PIXELS) cairo_scale(surface->pen, points, points);
    surface->layout = pango_cairo_create_layout(surface->pen);
    PangoContext *const context = pango_layout_get_context(surface->layout);
    use_exact_letters(surface->pen, context);
    surface->font = pango_font_description_from_string(page->font);
    pango_font_description_set_absolute_size(surface->font, page->points / points * PANGO_SCALE);
    pango_layout_set_font_description(surface->layout, surface->font);
    pango_layout_set_single_paragraph_mode(surface->layout, TRUE);
    return find_family(surface, context) ? NULL
                                         : "there is no font; install some (`apt install fonts-dejavu-core`)";
}

static const char *family_of(BpSurface *surface) {
    return surface->family;
}

static void measure_text(BpSurface *surface, const char *text, BpTextExtent *extent) {
    PangoRectangle ink, logical;
    pango_layout_set_text(surface->layout, text, -1);
    pango_layout_get_extents(surface->layout, &ink, &logical);
    const int baseline = pango_layout_get_baseline(surface->layout);
    extent->width = logical.width / (double)PANGO_SCALE;
    extent->ascent = (baseline - logical.y) / (double)PANGO_SCALE;
    extent->descent = (logical.y + logical.height - baseline) / (double)PANGO_SCALE;
    extent->rise = (baseline - ink.y) / (double)PANGO_SCALE;
    extent->lacks_signs = pango_layout_get_unknown_glyphs_count(surface->layout) > 0;
}

static void draw_text(BpSurface *surface, const BpDrawnText *text) {
    cairo_t *const pen = surface->pen;
    pango_layout_set_text(surface->layout, text->text, -1);
    const double baseline = pango_layout_get_baseline(surface->layout) / (double)PANGO_SCALE;
    cairo_save(pen);
    cairo_translate(pen, text->x, text->y);
    if (!text->is_upright) cairo_rotate(pen, -1.5707963267948966);
    cairo_translate(pen, 0, -baseline);
    pango_cairo_update_layout(pen, surface->layout);
    if (text->rim > 0) {
        cairo_new_path(pen);
        cairo_move_to(pen, 0, 0);
        pango_cairo_layout_path(pen, surface->layout);
        cairo_set_source_rgb(pen, 1, 1, 1);
        cairo_set_line_width(pen, 2 * text->rim);
        cairo_set_line_join(pen, CAIRO_LINE_JOIN_ROUND);
        cairo_stroke(pen);
    }
    cairo_set_source_rgb(pen, text->ink[0], text->ink[1], text->ink[2]);
    cairo_move_to(pen, 0, 0);
    pango_cairo_show_layout(pen, surface->layout);
    cairo_restore(pen);
}

static void draw_rectangle(BpSurface *surface, double x, double y, double width, double height,
                           const double color[3]) {
    cairo_set_source_rgb(surface->pen, color[0], color[1], color[2]);
    cairo_rectangle(surface->pen, x, y, width, height);
    cairo_fill(surface->pen);
}

static void draw_image(BpSurface *surface, const BpDrawnImage *image) {
    const cairo_format_t format = image->has_alpha ? CAIRO_FORMAT_ARGB32 : CAIRO_FORMAT_RGB24;
    cairo_surface_t *const source = cairo_image_surface_create(format, (int)image->width, (int)image->height);
    if (cairo_surface_status(source) == CAIRO_STATUS_SUCCESS) {
        unsigned char *const rows = cairo_image_surface_get_data(source);
        const size_t stride = (size_t)cairo_image_surface_get_stride(source);
        for (size_t y = 0; y < image->height; y++)
            memcpy(rows + y * stride, image->pixels + y * image->width, sizeof *image->pixels * image->width);
        cairo_surface_mark_dirty(source);
        void *const png = image->png != NULL && surface->is_svg ? malloc(image->png_size) : NULL;
        if (png != NULL) {
            memcpy(png, image->png, image->png_size);
            cairo_surface_set_mime_data(source, CAIRO_MIME_TYPE_PNG, png, image->png_size, free, png);
        }
    }
    cairo_set_source_surface(surface->pen, source, image->x, image->y);
    cairo_paint(surface->pen); /* with the fault of the source, if it has one */
    cairo_surface_destroy(source);
}

static const char *finish_surface(BpSurface *surface, const uint32_t **pixels, size_t *stride) {
    const bool in_memory = cairo_surface_get_type(surface->cairo) == CAIRO_SURFACE_TYPE_IMAGE;
    cairo_status_t status = cairo_status(surface->pen);
    if (in_memory) {
        cairo_surface_flush(surface->cairo);
        *pixels = (const uint32_t *)(const void *)cairo_image_surface_get_data(surface->cairo);
        *stride = (size_t)cairo_image_surface_get_stride(surface->cairo) / sizeof **pixels;
    } else {
        cairo_surface_finish(surface->cairo);
    }
    if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface->cairo);
    return status == CAIRO_STATUS_SUCCESS ? NULL : cairo_status_to_string(status);
}

static void close_surface(BpSurface **closed) {
    BpSurface *const surface = *closed;
    *closed = NULL;
    if (surface == NULL) return;
    if (surface->font != NULL) pango_font_description_free(surface->font);
    if (surface->layout != NULL) g_object_unref(surface->layout);
    if (surface->pen != NULL) cairo_destroy(surface->pen);
    if (surface->cairo != NULL) cairo_surface_destroy(surface->cairo);
    free(surface);
}

extern const BpDrawing bp_drawing_module __attribute__((visibility("default")));
const BpDrawing bp_drawing_module = {.version = BP_DRAWING_VERSION,
                                     .open = open_surface,
                                     .family = family_of,
                                     .measure = measure_text,
                                     .text = draw_text,
                                     .rectangle = draw_rectangle,
                                     .image = draw_image,
                                     .finish = finish_surface,
                                     .close = close_surface};
