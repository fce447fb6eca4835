/* image_png.c: images as PNG files, by libpng; see image_file.h.
 *
 * 8 and 16 bits a channel, grey, colours or a palette, interlaced or not; alpha is left out. What a file says
 * of its colour space is not looked at: the scene says whether its numbers are sRGB's. */
#include "image_file.h"

#include "base/color.h"

#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#define UNPACKED_MAX 1032u /* a byte of deflate's becomes so many at most */

typedef struct PngReader {
    const BpImageInput *input;
    png_structp png;
    png_infop info;
    png_bytep bytes; /* a row, or all of them of an interlaced file */
    png_bytepp rows; /* of an interlaced file */
    float *light;    /* what each number stands for */
    BpImage *image;
    uint32_t row;    /* that is being read */
    char fault[128]; /* as libpng has it */
    bool no_memory;  /* libpng was refused memory, which it reports like any damage */
} PngReader;

static png_voidp take_memory(png_structp png, png_alloc_size_t size) {
    PngReader *reader = png_get_mem_ptr(png);
    void *memory = malloc(size);
    reader->no_memory = reader->no_memory || memory == NULL;
    return memory;
}

static void give_memory(png_structp png, png_voidp memory) {
    (void)png;
    free(memory);
}

static void on_error(png_structp png, png_const_charp message) {
    PngReader *reader = png_get_error_ptr(png);
    snprintf(reader->fault, sizeof reader->fault, "%s", message);
    longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp message) {
    (void)png;
    (void)message;
}

static void read_bytes(png_structp png, png_bytep bytes, size_t count) {
    PngReader *reader = png_get_io_ptr(png);
    if (fread(bytes, 1, count, reader->input->stream) != count) png_error(png, "the file ends too early");
}

/* Linear light of all numbers of `bits` bits. */
static float *light_of_numbers(int bits, bool srgb) {
    const size_t count = (size_t)1 << bits;
    float *light = malloc(count * sizeof *light);
    for (size_t i = 0; light != NULL && i < count; i++) {
        const double share = (double)i / (double)(count - 1);
        light[i] = (float)(srgb ? bp_linear_from_srgb(share) : share);
    }
    return light;
}

static void store_row(PngReader *reader, const unsigned char *bytes, uint32_t row, bool wide) {
    float *const texels = reader->image->texels + (size_t)3 * reader->image->width * row;
    for (size_t i = 0; i < (size_t)3 * reader->image->width; i++)
        texels[i] = reader->light[wide ? (size_t)bytes[2 * i] << 8 | bytes[2 * i + 1] : bytes[i]];
}

/* Everything that may come back by longjmp; what it takes stands in `reader`. */
static BpStatus read_image(PngReader *reader, BpError *err) {
    png_structp png = reader->png;
    png_infop info = reader->info;
    png_set_user_limits(png, BP_IMAGE_SIDE_MAX, BP_IMAGE_SIDE_MAX);
    png_set_chunk_malloc_max(png, 1 << 24);
    png_set_chunk_cache_max(png, 64);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, NULL, 0);
    png_set_read_fn(png, reader, read_bytes);
    png_read_info(png, info);
    const uint32_t width = png_get_image_width(png, info), height = png_get_image_height(png, info);
    const bool wide = png_get_bit_depth(png, info) == 16;
    const uint64_t least = (uint64_t)height * png_get_rowbytes(png, info) / UNPACKED_MAX;
    if (least > reader->input->size)
        return bp_image_fail(
            reader->input, err,
            "found %llu bytes, expected at least %llu for %u by %u texels; the file is damaged "
            "or incomplete",
            (unsigned long long)reader->input->size, (unsigned long long)least, (unsigned)width,
            (unsigned)height);
    BP_TRY(bp_image_allocate(reader->input, width, height, &reader->image, err));
    png_set_expand(png); /* palettes, and grey of fewer than 8 bits */
    png_set_strip_alpha(png);
    png_set_gray_to_rgb(png);
    const bool interlaced = png_set_interlace_handling(png) > 1;
    png_read_update_info(png, info);
    const size_t row_bytes = png_get_rowbytes(png, info);
    if (row_bytes != (size_t)width * (wide ? 6 : 3)) png_error(png, "unexpected kind of pixels");
    reader->light = light_of_numbers(wide ? 16 : 8, reader->input->srgb);
    reader->bytes = calloc(interlaced ? height : 1, row_bytes);
    if (reader->bytes != NULL && interlaced) reader->rows = malloc(height * sizeof *reader->rows);
    if (reader->light == NULL || reader->bytes == NULL || (interlaced && reader->rows == NULL))
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for an image of %u by %u texels", (unsigned)width,
                       (unsigned)height);
    if (interlaced) {
        for (uint32_t row = 0; row < height; row++) reader->rows[row] = reader->bytes + row * row_bytes;
        png_read_image(png, reader->rows);
    }
    for (uint32_t row = 0; row < height; row++) {
        reader->row = row;
        if (!interlaced) png_read_row(png, reader->bytes, NULL);
        store_row(reader, interlaced ? reader->rows[row] : reader->bytes, row, wide);
    }
    png_read_end(png, NULL);
    return BP_OK;
}

static BpStatus read_guarded(PngReader *reader, BpError *err) {
    if (setjmp(png_jmpbuf(reader->png)) != 0) {
        if (reader->no_memory) return bp_fail(err, BP_ERR_MEMORY, "out of memory for reading a PNG file");
        return reader->image == NULL
                   ? bp_image_fail(reader->input, err, "found a damaged PNG file: %s", reader->fault)
                   : bp_image_fail(reader->input, err,
                                   "found a damaged PNG file: %s; %u of %u rows could be read", reader->fault,
                                   (unsigned)reader->row, (unsigned)reader->image->height);
    }
    return read_image(reader, err);
}

BpStatus bp_image_read_png(const BpImageInput *input, BpImage **image, BpError *err) {
    PngReader reader = {.input = input};
    BpStatus status = BP_OK;
    reader.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &reader, on_error, on_warning, &reader,
                                          take_memory, give_memory);
    if (reader.png != NULL) reader.info = png_create_info_struct(reader.png);
    if (reader.info == NULL)
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for reading a PNG file");
    else
        status = read_guarded(&reader, err);
    png_destroy_read_struct(&reader.png, &reader.info, NULL);
    free(reader.bytes);
    free(reader.rows);
    free(reader.light);
    if (status != BP_OK) bp_texels_destroy(&reader.image);
    *image = reader.image;
    return status;
}
