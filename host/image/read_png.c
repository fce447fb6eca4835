/* read_png.c: images as PNG files, by libpng; see reader.h.
 *
 * 8 and 16 bits a channel, grey, colours or a palette, interlaced or not; alpha is left out, with a note
 * where texels are transparent. Where the scene does not say how numbers are encoded, the file does: by the
 * chunks gAMA and cHRM, which are followed, or by sRGB. The colour spaces of ICC profiles and of cICP are not
 * known here: such numbers are taken for sRGB's, which is noted unless they are. The order of these chunks is
 * that of the PNG specification (third edition, 2023, section 4.3). */
#include "camera_notes.h"
#include "primaries.h"
#include "reader.h"

#include "base/plural.h"

#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#define UNPACKED_MAX 1032u /* a byte of deflate's becomes so many at most */

typedef struct PngReader {
    const BpImageInput *input;
    png_structp png;
    png_infop info;
    png_bytep bytes;    /* a row, or all of them of an interlaced file */
    png_bytepp rows;    /* of an interlaced file */
    float *light;       /* what each number stands for */
    png_colorp palette; /* NULL: the numbers are colours themselves */
    int palette_count;
    png_bytep alphas; /* of the first alpha_count colours of the palette; those of the others are opaque */
    int alpha_count;
    size_t channels;    /* 3, or 4 with alpha, where there is no palette */
    size_t outside;     /* texels that name no colour of the palette */
    size_t transparent; /* texels that are not opaque */
    BpImage *image;
    uint32_t row;      /* that is being read */
    char fault[128];   /* as libpng has it */
    char warning[128]; /* the first that matters, or "" */
    bool no_memory;    /* libpng was refused memory, which it reports like any damage */
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

/* Chunks that decide what numbers mean are left out by libpng where they are damaged, with a warning. It
 * knows sRGB profiles that are not quite right, and takes them for sRGB. */
static void on_warning(png_structp png, png_const_charp message) {
    static const char *const chunks[] = {"PLTE", "gAMA", "cHRM", "sRGB", "iCCP", "cICP"};
    PngReader *reader = png_get_error_ptr(png);
    if (strstr(message, "known incorrect sRGB profile") != NULL || reader->warning[0] != '\0') return;
    for (size_t i = 0; i < sizeof chunks / sizeof *chunks; i++)
        if (strncmp(message, chunks[i], 4) == 0)
            snprintf(reader->warning, sizeof reader->warning, "%s", message);
}

static void read_bytes(png_structp png, png_bytep bytes, size_t count) {
    PngReader *reader = png_get_io_ptr(png);
    if (fread(bytes, 1, count, reader->input->stream) != count) png_error(png, "the file ends too early");
}

/* How numbers stand for light. */
typedef struct PngColors {
    double exponent; /* 0: as sRGB has it */
    bool converted;
    BpPrimaries primaries; /* of `converted` */
} PngColors;

/* Whether a chunk that is not applied has the last word on colours; it is noted unless it says sRGB. */
static bool has_other_space(PngReader *reader) {
    png_unknown_chunkp chunks = NULL;
    png_charp name = NULL;
    png_bytep profile = NULL;
    png_uint_32 size = 0;
    int compression = 0;
    const int count = png_get_unknown_chunks(reader->png, reader->info, &chunks);
    for (int i = 0; i < count; i++) {
        if (memcmp(chunks[i].name, "cICP", 4) != 0 || chunks[i].size < 4) continue;
        const unsigned primaries = chunks[i].data[0], curve = chunks[i].data[1];
        if (primaries != 1 || curve != 13)
            bp_texels_note(
                reader->image,
                "its colour space (primaries %u, curve %u of its cICP chunk) is not known: read as sRGB",
                primaries, curve);
        return true;
    }
    if (png_get_iCCP(reader->png, reader->info, &name, &compression, &profile, &size) == 0) return false;
    bp_note_profile(reader->image, name, profile, size);
    return true;
}

/* Programs write gamma 1 / 2.2, more or less rounded, for sRGB's curve, which it imitates. */
static bool is_srgb_gamma(double gamma) {
    return fabs(2.2 * gamma - 1) < 0.02;
}

/* What the file says of its colours. */
static void read_colors(PngReader *reader, PngColors *colors) {
    int intent = 0;
    double gamma = 0;
    BpPrimaries *const p = &colors->primaries;
    if (has_other_space(reader) || png_get_sRGB(reader->png, reader->info, &intent) != 0) return;
    if (png_get_gAMA(reader->png, reader->info, &gamma) != 0 && gamma > 0 && !is_srgb_gamma(gamma)) {
        colors->exponent = 1 / gamma;
        bp_texels_note(reader->image, "its numbers are decoded by the gamma of its gAMA chunk, %.4g", gamma);
    }
    colors->converted = (png_get_color_type(reader->png, reader->info) & PNG_COLOR_MASK_COLOR) != 0 &&
                        png_get_cHRM(reader->png, reader->info, &p->white[0], &p->white[1], &p->red[0],
                                     &p->red[1], &p->green[0], &p->green[1], &p->blue[0], &p->blue[1]) != 0;
}

/* Numbers beyond the palette are black, as in most programs. */
static void store_indices(PngReader *reader, const unsigned char *bytes, float *texels) {
    for (size_t i = 0; i < reader->image->width; i++) {
        const bool outside = bytes[i] >= reader->palette_count;
        const png_color color = outside ? (png_color){0, 0, 0} : reader->palette[bytes[i]];
        reader->outside += outside;
        reader->transparent += bytes[i] < reader->alpha_count && reader->alphas[bytes[i]] < 255;
        texels[3 * i] = reader->light[color.red];
        texels[3 * i + 1] = reader->light[color.green];
        texels[3 * i + 2] = reader->light[color.blue];
    }
}

static void store_row(PngReader *reader, const unsigned char *bytes, uint32_t row, bool wide) {
    float *const texels = reader->image->texels + (size_t)3 * reader->image->width * row;
    if (reader->palette != NULL) {
        store_indices(reader, bytes, texels);
        return;
    }
    for (size_t i = 0; i < reader->image->width; i++)
        for (size_t c = 0; c < reader->channels; c++) {
            const size_t at = i * reader->channels + c;
            const size_t number = wide ? (size_t)bytes[2 * at] << 8 | bytes[2 * at + 1] : bytes[at];
            if (c < 3)
                texels[3 * i + c] = reader->light[number];
            else
                reader->transparent += number < (wide ? 65535 : 255);
        }
}

/* Everything that may come back by longjmp; what it takes stands in `reader`. */
static BpStatus read_image(PngReader *reader, BpError *err) {
    png_structp png = reader->png;
    png_infop info = reader->info;
    png_set_user_limits(png, BP_IMAGE_SIDE_MAX, BP_IMAGE_SIDE_MAX);
    png_set_chunk_malloc_max(png, 1 << 24);
    png_set_chunk_cache_max(png, 64);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, NULL, 0);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_ALWAYS, (png_const_bytep) "cICP", 1);
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
    PngColors colors = {.exponent = reader->input->encoding == BP_ENCODING_LINEAR ? 1 : 0};
    if (reader->input->encoding == BP_ENCODING_OF_FORMAT) read_colors(reader, &colors);
    if (png_get_color_type(png, info) == PNG_COLOR_TYPE_PALETTE) {
        png_get_PLTE(png, info, &reader->palette, &reader->palette_count);
        png_get_tRNS(png, info, &reader->alphas, &reader->alpha_count, NULL);
        png_set_packing(png);
        png_set_check_for_invalid_index(png, 0);
    } else {
        png_set_expand(png); /* grey of fewer than 8 bits, and one transparent colour to alpha */
        png_set_gray_to_rgb(png);
    }
    const bool interlaced = png_set_interlace_handling(png) > 1;
    png_read_update_info(png, info);
    const size_t row_bytes = png_get_rowbytes(png, info);
    reader->channels = png_get_channels(png, info);
    const size_t texel_bytes = reader->palette != NULL ? 1 : reader->channels * (wide ? 2 : 1);
    if (row_bytes != width * texel_bytes ||
        (reader->palette == NULL && reader->channels != 3 && reader->channels != 4))
        png_error(png, "unexpected kind of pixels");
    reader->light = bp_light_of_numbers(wide ? 16 : 8, colors.exponent);
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
    png_read_end(png, info);
    png_bytep exif = NULL;
    png_uint_32 exif_size = 0;
    if (png_get_eXIf_1(png, info, &exif_size, &exif) != 0)
        bp_note_orientation(reader->image, exif, exif_size);
    if (reader->warning[0] != '\0' && reader->input->encoding == BP_ENCODING_OF_FORMAT)
        bp_texels_note(reader->image, "its colours may be wrong, since a chunk is not used (%s)",
                       reader->warning);
    bp_texels_note_alpha(reader->image, reader->transparent);
    if (reader->outside > 0)
        bp_texels_note(reader->image, "%zu texel%s of a colour that its palette lacks: black",
                       reader->outside, bp_plural(reader->outside));
    if (!colors.converted) return BP_OK;
    return bp_image_convert(reader->input, &colors.primaries, "its cHRM chunk", reader->image, err);
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
