/* png.c: RGB PNG of 8 or 16 bits by libpng, tagged with the transfer curve; see image.h. A picture with an
 * alpha becomes RGBA, in which colours are straight, as the standard has it: not yet multiplied by the alpha.
 *
 * Tags. sRGB pictures carry an sRGB chunk (libpng adds the gAMA and cHRM that the standard recommends beside
 * it), which every viewer shows alike. Gamma 2 and linear pictures carry gAMA (0.5 or 1) and the primaries of
 * sRGB as cHRM. A viewer that reads gAMA (web browsers, most picture viewers) then shows the radiance it was
 * computed from, the same as the sRGB file of that picture. One that ignores gAMA takes the bytes for sRGB: a
 * gamma 2 picture then looks slightly darker in the middle (byte 128 shows as 128 where 137 was meant), which
 * is how the book's own untagged pictures are seen everywhere; a linear one looks far too dark, which is how
 * the book's pictures before its gamma section are meant to look. */
#include "image.h"

#include "base/output_file.h"
#include "base/status.h"

#include <errno.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* What libpng's callbacks need. */
typedef struct PngFailure {
    char text[200];
    int error_number;
} PngFailure;

static void on_error(png_structp png, png_const_charp message) {
    PngFailure *failure = png_get_error_ptr(png);
    failure->error_number = errno;
    snprintf(failure->text, sizeof failure->text, "%s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message) {
    (void)png;
    (void)message;
}

/* No date, and no version except on request, so that equal pictures give equal files. */
static void put_texts(png_structp png, png_infop info, const BpImageExtra *extra) {
    png_text texts[1 + BP_IMAGE_NOTES_MAX] = {{.compression = PNG_TEXT_COMPRESSION_NONE}};
    char names[1 + BP_IMAGE_NOTES_MAX][24] = {"Software"};
    static char none[] = "", ballpark[] = "Ballpark";
    texts[0].key = names[0];
    texts[0].text = extra->software != NULL ? (char *)(uintptr_t)extra->software : ballpark;
    for (size_t i = 0; i < extra->note_count; i++) {
        png_text *const text = &texts[1 + i];
        snprintf(names[1 + i], sizeof names[1 + i], "%s", extra->notes[i].png_key);
        *text = (png_text){.compression = PNG_ITXT_COMPRESSION_NONE, /* UTF-8 */
                           .key = names[1 + i],
                           .text = (char *)(uintptr_t)extra->notes[i].text,
                           .lang = none,
                           .lang_key = none};
    }
    png_set_text(png, info, texts, 1 + (int)extra->note_count);
}

static void put_tags(png_structp png, png_infop info, BpTransfer transfer, const BpImageExtra *extra) {
    if (transfer == BP_TRANSFER_SRGB) {
        png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_RELATIVE);
    } else {
        png_set_gAMA(png, info, transfer == BP_TRANSFER_LINEAR ? 1.0 : 0.5);
        png_set_cHRM(png, info, 0.3127, 0.3290, 0.64, 0.33, 0.30, 0.60, 0.15, 0.06);
    }
    put_texts(png, info, extra);
    if (extra->dots_per_inch > 0) {
        const png_uint_32 per_meter = (png_uint_32)(extra->dots_per_inch / 0.0254 + 0.5);
        png_set_pHYs(png, info, per_meter, per_meter, PNG_RESOLUTION_METER);
    }
}

/* The input: a picture, or else 8-bit colours. */
typedef struct Image {
    uint32_t width, height;
    const BpPicture *picture;
    const uint8_t *bytes;
    BpTransfer transfer;
    size_t channels; /* 3, or 4 with alpha */
    const BpImageExtra *extra;
} Image;

/* A sample of 8 bits, or of 16 with the higher byte first. */
static uint8_t *put_sample(const Image *image, double value, bool is_alpha, uint8_t *out) {
    if (!image->extra->deep) {
        *out = is_alpha ? (uint8_t)lround(value * 255) : bp_transfer_byte(value, image->transfer);
        return out + 1;
    }
    const uint16_t word =
        is_alpha ? (uint16_t)lround(value * 65535) : bp_transfer_word(value, image->transfer);
    out[0] = (uint8_t)(word >> 8);
    out[1] = (uint8_t)word;
    return out + 2;
}

static void encode_row(const Image *image, uint32_t y, uint8_t *row) {
    const size_t first = (size_t)y * image->width;
    if (image->picture == NULL) {
        memcpy(row, image->bytes + 3 * first, (size_t)image->width * 3);
        return;
    }
    for (size_t x = 0; x < image->width; x++) {
        const float *const rgb = image->picture->rgb + 3 * (first + x);
        const double alpha = image->channels == 4 ? (double)image->picture->alpha[first + x] : 1;
        for (size_t c = 0; c < 3; c++)
            row = put_sample(image, alpha > 0 ? (double)rgb[c] / alpha : 0, false, row);
        if (image->channels == 4) row = put_sample(image, alpha, true, row);
    }
}

/* All calls that can jump. `row` is a buffer for one row. The filtered rows of a noisy picture hardly repeat
 * anything but runs of bytes. zlib's strategy for such data takes half the time, and the file is 1 or 2 %
 * larger. */
static bool write_all(png_structp png, png_infop info, FILE *out, const Image *image, uint8_t *row) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
    png_init_io(png, out);
    png_set_IHDR(png, info, image->width, image->height, image->extra->deep ? 16 : 8,
                 image->channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    put_tags(png, info, image->transfer, image->extra);
    png_set_compression_strategy(png, Z_RLE);
    png_write_info(png, info);
    for (uint32_t y = 0; y < image->height; y++) {
        encode_row(image, y, row);
        png_write_row(png, row);
    }
    png_write_end(png, info);
    return true;
}

static BpStatus write_png(FILE *out, const Image *image, BpError *err) {
    BpStatus status = BP_OK;
    PngFailure failure = {.text = ""};
    png_infop info = NULL;
    uint8_t *row = malloc((size_t)image->width * image->channels * 2);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure, on_error, on_warning);
    if (png != NULL) info = png_create_info_struct(png);
    errno = 0;
    if (row == NULL || info == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for the PNG encoder");
    } else if (write_all(png, info, out, image, row)) {
        status = bp_output_finish(out, "PNG", err);
    } else {
        const char *reason = ferror(out) ? strerror(failure.error_number) : failure.text;
        /* libpng reports this differently ("too many text chunks"). */
        if (failure.error_number == ENOMEM)
            status = bp_fail(err, BP_ERR_MEMORY, "out of memory for the PNG encoder");
        else
            status = bp_fail(err, BP_ERR_FILE, "writing the PNG failed: %s", reason);
        if (ferror(out) && status == BP_ERR_FILE) bp_output_advise(err, failure.error_number);
    }
    png_destroy_write_struct(&png, &info);
    free(row);
    return status;
}

BpStatus bp_png_write(const BpPicture *picture, FILE *out, BpTransfer transfer, const BpImageExtra *extra,
                      BpError *err) {
    const Image image = {.width = picture->width,
                         .height = picture->height,
                         .picture = picture,
                         .transfer = transfer,
                         .channels = picture->alpha != NULL ? 4 : 3,
                         .extra = extra};
    return write_png(out, &image, err);
}

BpStatus bp_png_write_bytes(const uint8_t *rgb, uint32_t width, uint32_t height, FILE *out, BpError *err) {
    const BpImageExtra none = {.note_count = 0};
    const Image image = {.width = width,
                         .height = height,
                         .bytes = rgb,
                         .transfer = BP_TRANSFER_SRGB,
                         .channels = 3,
                         .extra = &none};
    return write_png(out, &image, err);
}

void bp_base64_print(const void *bytes, size_t size, FILE *out) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint8_t *at = bytes;
    for (size_t i = 0; i < size; i += 3) {
        uint32_t bits = 0;
        for (size_t b = i; b < i + 3; b++) bits = bits << 8 | (b < size ? at[b] : 0u);
        for (size_t d = 0; d < 4; d++) putc(i + d > size ? '=' : digits[bits >> (18 - 6 * d) & 63], out);
    }
}
