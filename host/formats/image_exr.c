/* image_exr.c: images as OpenEXR files, by the library's C API (OpenEXRCore); see image_file.h.
 *
 * The first part of a file, in scan lines or tiles, the largest level: R, G and B as half or 32-bit floats,
 * or Y alone as grey. The image is the data window, whatever the display window is. */
#include "image_file.h"

#include <errno.h>
#include <openexr.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#define CHUNK_BYTES_MAX ((uint64_t)1 << 29) /* unpacked */

typedef struct ExrReader {
    const BpImageInput *input;
    exr_context_t exr;
    exr_decode_pipeline_t decode;
    bool decoding;
    BpImage *image;
    exr_attr_box2i_t window;
    bool gray;
} ExrReader;

static int64_t read_at(exr_const_context_t context, void *user_data, void *buffer, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t error_callback) {
    (void)context;
    (void)error_callback;
    const BpImageInput *input = user_data;
    if (offset > input->size || fseeko(input->stream, (off_t)offset, SEEK_SET) != 0) return -1;
    return (int64_t)fread(buffer, 1, (size_t)size, input->stream);
}

static int64_t size_of(exr_const_context_t context, void *user_data) {
    (void)context;
    return (int64_t)((const BpImageInput *)user_data)->size;
}

/* Nothing may be asked of the context here, whose lock the library holds. */
static void keep_quiet(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context;
    (void)code;
    (void)message;
}

/* Where zlib lacks the memory to unpack, the library calls the pixels corrupt; errno was 0 at the beginning.
 */
static BpStatus fail_code(const ExrReader *reader, const char *what, exr_result_t code, BpError *err) {
    if (code == EXR_ERR_OUT_OF_MEMORY || errno == ENOMEM)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for reading an OpenEXR file");
    return bp_image_fail(reader->input, err, "found a damaged OpenEXR file: %s: %s", what,
                         exr_get_default_error_message(code));
}

/* Whether the channels are what an image has. */
static BpStatus check_channels(ExrReader *reader, BpError *err) {
    static const char letters[] = "RGBY";
    const exr_attr_chlist_t *channels = NULL;
    const exr_result_t code = exr_get_channels(reader->exr, 0, &channels);
    unsigned found = 0;
    if (code != EXR_ERR_SUCCESS) return fail_code(reader, "its channels", code, err);
    for (int i = 0; i < channels->num_channels; i++) {
        const exr_attr_chlist_entry_t *channel = &channels->entries[i];
        if (channel->x_sampling != 1 || channel->y_sampling != 1)
            return bp_image_fail(reader->input, err,
                                 "found a channel with fewer samples than pixels, expected one for each");
        const char *const letter =
            channel->name.length == 1 ? memchr(letters, channel->name.str[0], sizeof letters - 1) : NULL;
        if (letter == NULL) continue;
        if (channel->pixel_type != EXR_PIXEL_HALF && channel->pixel_type != EXR_PIXEL_FLOAT)
            return bp_image_fail(reader->input, err, "found whole numbers in channel %c, expected floats",
                                 *letter);
        found |= 1u << (letter - letters);
    }
    reader->gray = found == 8;
    if ((found & 7) != 7 && !reader->gray)
        return bp_image_fail(reader->input, err, "found no channels R, G and B, nor Y alone, expected these");
    return BP_OK;
}

static BpStatus read_header(ExrReader *reader, exr_storage_t *storage, BpError *err) {
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    errno = 0;
    init.error_handler_fn = keep_quiet;
    init.user_data = (void *)(uintptr_t)reader->input;
    init.read_fn = read_at;
    init.size_fn = size_of;
    exr_result_t code = exr_start_read(&reader->exr, reader->input->path, &init);
    if (code != EXR_ERR_SUCCESS) return fail_code(reader, "its header", code, err);
    code = exr_get_storage(reader->exr, 0, storage);
    if (code == EXR_ERR_SUCCESS) code = exr_get_data_window(reader->exr, 0, &reader->window);
    if (code != EXR_ERR_SUCCESS) return fail_code(reader, "its header", code, err);
    if (*storage != EXR_STORAGE_SCANLINE && *storage != EXR_STORAGE_TILED)
        return bp_image_fail(reader->input, err, "found deep data, expected an image");
    return check_channels(reader, err);
}

/* Reads a block of pixels straight into the image. `column`, `row`: of its first, as the file has it. */
static BpStatus read_chunk(ExrReader *reader, const exr_chunk_info_t *chunk, int64_t column, int64_t row,
                           BpError *err) {
    const int64_t width = reader->image->width, height = reader->image->height;
    char what[64];
    snprintf(what, sizeof what, "row %lld, column %lld", (long long)row, (long long)column);
    if (column < 0 || row < 0 || chunk->width < 0 || chunk->height < 0 || column + chunk->width > width ||
        row + chunk->height > height || chunk->unpacked_size > CHUNK_BYTES_MAX ||
        chunk->packed_size > reader->input->size)
        return fail_code(reader, what, EXR_ERR_CORRUPT_CHUNK, err);
    exr_result_t code = reader->decoding ? exr_decoding_update(reader->exr, 0, chunk, &reader->decode)
                                         : exr_decoding_initialize(reader->exr, 0, chunk, &reader->decode);
    const bool first = !reader->decoding;
    reader->decoding = reader->decoding || code == EXR_ERR_SUCCESS;
    float *const texels = reader->image->texels + 3 * (row * width + column);
    for (int i = 0; i < reader->decode.channel_count && code == EXR_ERR_SUCCESS; i++) {
        exr_coding_channel_info_t *channel = &reader->decode.channels[i];
        const char *const letters = reader->gray ? "Y" : "RGB", *name = channel->channel_name;
        const char *const letter = strlen(name) == 1 ? strchr(letters, name[0]) : NULL;
        channel->decode_to_ptr = NULL;
        if (letter == NULL) continue;
        channel->decode_to_ptr = (uint8_t *)(texels + (letter - letters));
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_pixel_stride = 3 * sizeof(float);
        channel->user_line_stride = (int32_t)(3 * sizeof(float) * reader->image->width);
    }
    if (code == EXR_ERR_SUCCESS && first)
        code = exr_decoding_choose_default_routines(reader->exr, 0, &reader->decode);
    if (code == EXR_ERR_SUCCESS) code = exr_decoding_run(reader->exr, 0, &reader->decode);
    return code == EXR_ERR_SUCCESS ? BP_OK : fail_code(reader, what, code, err);
}

static BpStatus read_lines(ExrReader *reader, BpError *err) {
    int32_t lines = 0;
    exr_result_t code = exr_get_scanlines_per_chunk(reader->exr, 0, &lines);
    if (code != EXR_ERR_SUCCESS || lines < 1) return fail_code(reader, "its header", code, err);
    for (int64_t row = 0; row < reader->image->height; row += lines) {
        exr_chunk_info_t chunk;
        code = exr_read_scanline_chunk_info(reader->exr, 0, (int)(row + reader->window.min.y), &chunk);
        char what[32];
        snprintf(what, sizeof what, "row %lld", (long long)row);
        if (code != EXR_ERR_SUCCESS) return fail_code(reader, what, code, err);
        BP_TRY(read_chunk(reader, &chunk, 0, (int64_t)chunk.start_y - reader->window.min.y, err));
    }
    return BP_OK;
}

static BpStatus read_tiles(ExrReader *reader, BpError *err) {
    uint32_t tile_width = 0, tile_height = 0;
    exr_tile_level_mode_t levels;
    exr_tile_round_mode_t rounding;
    exr_result_t code =
        exr_get_tile_descriptor(reader->exr, 0, &tile_width, &tile_height, &levels, &rounding);
    if (code != EXR_ERR_SUCCESS || tile_width < 1 || tile_height < 1)
        return fail_code(reader, "its tiles", code, err);
    for (uint32_t y = 0; y * (uint64_t)tile_height < reader->image->height; y++)
        for (uint32_t x = 0; x * (uint64_t)tile_width < reader->image->width; x++) {
            exr_chunk_info_t chunk;
            char what[64];
            snprintf(what, sizeof what, "tile %u, %u", (unsigned)x, (unsigned)y);
            code = exr_read_tile_chunk_info(reader->exr, 0, (int)x, (int)y, 0, 0, &chunk);
            if (code != EXR_ERR_SUCCESS) return fail_code(reader, what, code, err);
            BP_TRY(read_chunk(reader, &chunk, (int64_t)x * tile_width, (int64_t)y * tile_height, err));
        }
    return BP_OK;
}

static void spread_gray(BpImage *image) {
    const size_t count = (size_t)image->width * image->height;
    for (size_t i = 0; i < count; i++)
        image->texels[3 * i + 1] = image->texels[3 * i + 2] = image->texels[3 * i];
}

static BpStatus read_image(ExrReader *reader, BpError *err) {
    exr_storage_t storage;
    BP_TRY(read_header(reader, &storage, err));
    const exr_attr_box2i_t window = reader->window;
    BP_TRY(bp_image_allocate(reader->input, (uint64_t)((int64_t)window.max.x - window.min.x + 1),
                             (uint64_t)((int64_t)window.max.y - window.min.y + 1), &reader->image, err));
    BP_TRY(storage == EXR_STORAGE_SCANLINE ? read_lines(reader, err) : read_tiles(reader, err));
    if (reader->gray) spread_gray(reader->image);
    return BP_OK;
}

BpStatus bp_image_read_exr(const BpImageInput *input, BpImage **image, BpError *err) {
    ExrReader reader = {.input = input};
    const BpStatus status = read_image(&reader, err);
    if (reader.decoding) exr_decoding_destroy(reader.exr, &reader.decode);
    if (reader.exr != NULL) exr_finish(&reader.exr);
    if (status != BP_OK) bp_texels_destroy(&reader.image);
    *image = reader.image;
    return status;
}
