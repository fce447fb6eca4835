/* read_pfm.c: images as portable float maps; see reader.h.
 *
 * "PF" (colours) or "Pf" (grey), width, height and a number whose sign tells the order of bytes, then 32-bit
 * floats, the lowest row first (P. Debevec, "HDRShop", 2001). Beyond its sign the number says nothing that
 * programs agree on, so it is not used, which is said where it is not 1. Between the words may stand any
 * white space and lines of comment ("#"), as ImageMagick writes them; behind the number only white space. */
#include "reader.h"

#include "base/decimal.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WORD_MAX = 32 };

static bool is_space(int c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/* The first character behind white space and comments. */
static int skip_space(FILE *stream) {
    int c = fgetc(stream);
    while (is_space(c) || c == '#') {
        if (c == '#')
            while (c != '\n' && c != EOF) c = fgetc(stream);
        else
            c = fgetc(stream);
    }
    return c;
}

/* The next word of the header and the one character of space behind it. False: there is none of a sane
 * length.
 */
static bool read_word(FILE *stream, char word[WORD_MAX]) {
    size_t length = 0;
    int c = skip_space(stream);
    while (c > ' ' && c < 127 && length + 1 < WORD_MAX) {
        word[length++] = (char)c;
        c = fgetc(stream);
    }
    word[length] = '\0';
    return length > 0 && is_space(c);
}

static bool read_number(FILE *stream, double *number) {
    char word[WORD_MAX];
    if (!read_word(stream, word)) return false;
    const char *const end = bp_decimal_parse(word, number);
    return end != NULL && *end == '\0';
}

/* A float of four bytes. */
static float float_of(const unsigned char bytes[4], bool little) {
    const uint32_t bits =
        little ? (uint32_t)bytes[3] << 24 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[1] << 8 | bytes[0]
               : (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static BpStatus read_rows(const BpImageInput *input, size_t channels, bool little, BpImage *image,
                          BpError *err) {
    const size_t width = image->width, row_bytes = 4 * channels * width;
    unsigned char *bytes = malloc(row_bytes);
    if (bytes == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a row of an image");
    BpStatus status = BP_OK;
    for (size_t row = image->height; row-- > 0 && status == BP_OK;) {
        if (fread(bytes, 1, row_bytes, input->stream) != row_bytes) {
            status = bp_image_fail(input, err, "found the end of the file in row %zu, expected more", row);
            break;
        }
        for (size_t i = 0; i < 3 * width; i++)
            image->texels[3 * width * row + i] = float_of(bytes + 4 * (channels == 3 ? i : i / 3), little);
    }
    free(bytes);
    return status;
}

/* Reads over so many bytes, the end of a line for example, if they are white space. */
static bool skip_rest(FILE *stream, uint64_t count) {
    while (count > 0 && is_space(fgetc(stream))) count--;
    return count == 0;
}

BpStatus bp_image_read_pfm(const BpImageInput *input, BpImage **image, BpError *err) {
    char kind[WORD_MAX];
    double width = 0, height = 0, scale = 0;
    if (!read_word(input->stream, kind) || !(strcmp(kind, "PF") == 0 || strcmp(kind, "Pf") == 0) ||
        !read_number(input->stream, &width) || !read_number(input->stream, &height) ||
        !read_number(input->stream, &scale))
        return bp_image_fail(
            input, err, "found a header that is none, expected \"PF\" or \"Pf\", width, height and -1 or 1");
    if (!(width >= 1 && width <= 1e9 && height >= 1 && height <= 1e9) || width != (uint32_t)width ||
        height != (uint32_t)height || scale == 0)
        return bp_image_fail(input, err,
                             "found %g by %g texels and the number %g, expected whole numbers from 1 up, and "
                             "one that is not 0",
                             width, height, scale);
    const uint64_t channels = strcmp(kind, "PF") == 0 ? 3 : 1;
    const uint64_t wanted = 4 * channels * (uint64_t)width * (uint64_t)height;
    const long begin = ftell(input->stream);
    const uint64_t there = begin >= 0 && input->size >= (uint64_t)begin ? input->size - (uint64_t)begin : 0;
    if (width <= BP_IMAGE_SIDE_MAX && height <= BP_IMAGE_SIDE_MAX &&
        (there < wanted || !skip_rest(input->stream, there - wanted)))
        return bp_image_fail(input, err,
                             "found %" PRIu64 " bytes behind the header, expected %" PRIu64
                             " for %.0f by %.0f texels; the file is damaged or incomplete",
                             there, wanted, width, height);
    BP_TRY(bp_image_allocate(input, (uint64_t)width, (uint64_t)height, image, err));
    if (fabs(fabs(scale) - 1) > 1e-6)
        bp_texels_note(*image, "the factor %g of its header is not used", fabs(scale));
    const BpStatus status = read_rows(input, (size_t)channels, scale < 0, *image, err);
    if (status != BP_OK) bp_texels_destroy(image);
    return status;
}
