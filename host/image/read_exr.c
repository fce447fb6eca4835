/* read_exr.c: images as OpenEXR files, by the library's C API (OpenEXRCore); see reader.h.
 *
 * Scan lines or tiles, the largest level: R, G and B as half or 32-bit floats, or Y alone as grey, in the
 * layer that exr_layers.h chooses. The image is the display window: black where the file has no data, without
 * what lies around it. Alpha is left out, with a note where texels are transparent. Colours of other
 * primaries than Rec. 709's (the attribute "chromaticities") are converted. */
#include "exr_layers.h"
#include "primaries.h"
#include "reader.h"

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
    BpExrLayer layer;
    bool b44, all_half;               /* its compression; whether all channels of the part are half floats */
    exr_attr_box2i_t window, display; /* where there are data; what the image shows */
    float *block; /* a chunk's pixels, unpacked, before they go to their place; then their alpha */
    size_t block_size;
    size_t transparent; /* texels that are not opaque */
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
    if (code == EXR_ERR_FEATURE_NOT_IMPLEMENTED)
        return bp_image_fail(reader->input, err,
                             "found pixels that this version of OpenEXR's library cannot unpack, such as "
                             "those of DWAA, expected another compression, such as ZIP; convert it");
    if (code == EXR_ERR_OUT_OF_MEMORY || errno == ENOMEM)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for reading an OpenEXR file");
    return bp_image_fail(reader->input, err, "found a damaged OpenEXR file: %s: %s", what,
                         exr_get_default_error_message(code));
}

static BpStatus open_file(ExrReader *reader, BpError *err) {
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    errno = 0;
    init.error_handler_fn = keep_quiet;
    init.user_data = (void *)(uintptr_t)reader->input;
    init.read_fn = read_at;
    init.size_fn = size_of;
    const exr_result_t code = exr_start_read(&reader->exr, reader->input->path, &init);
    return code == EXR_ERR_SUCCESS ? BP_OK : fail_code(reader, "its header", code, err);
}

static BpStatus read_compression(ExrReader *reader, BpError *err) {
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    const exr_result_t code = exr_get_compression(reader->exr, reader->layer.part, &compression);
    reader->b44 = compression == EXR_COMPRESSION_B44 || compression == EXR_COMPRESSION_B44A;
    return code == EXR_ERR_SUCCESS ? BP_OK : fail_code(reader, "its header", code, err);
}

/* Chunks that B44 makes no smaller, such as all of 32-bit floats, are left as they are by programs that use
 * the library's C++ interface, and rearranged channel by channel by others; version 3.1 of the C interface
 * unpacks them in any case, and beyond their end. */
static BpStatus check_b44(const ExrReader *reader, const exr_chunk_info_t *chunk, BpError *err) {
    if (!reader->b44 || chunk->packed_size < chunk->unpacked_size) return BP_OK;
    return bp_image_fail(reader->input, err,
                         "found B44 compression that makes pixels no smaller, which programs write in "
                         "different ways, expected another compression, such as ZIP; convert it");
}

/* Checks the layer's windows, and that it is not a cube map. */
static BpStatus read_header(ExrReader *reader, exr_storage_t *storage, BpError *err) {
    const int part = reader->layer.part;
    exr_attr_box2i_t *const windows[] = {&reader->window, &reader->display};
    exr_envmap_t map = EXR_ENVMAP_LATLONG;
    exr_result_t code = exr_get_storage(reader->exr, part, storage);
    if (code == EXR_ERR_SUCCESS) code = exr_get_data_window(reader->exr, part, &reader->window);
    if (code == EXR_ERR_SUCCESS) code = exr_get_display_window(reader->exr, part, &reader->display);
    if (code != EXR_ERR_SUCCESS) return fail_code(reader, "its header", code, err);
    if (exr_attr_get_envmap(reader->exr, part, "envmap", &map) == EXR_ERR_SUCCESS && map == EXR_ENVMAP_CUBE)
        return bp_image_fail(reader->input, err,
                             "found a cube map, expected an image by longitude and latitude; convert it "
                             "(exrenvmap of OpenEXR does)");
    for (int w = 0; w < 2; w++) /* the second is held against the scene's texels as well */
        if ((int64_t)windows[w]->max.x - windows[w]->min.x >= BP_IMAGE_SIDE_MAX ||
            (int64_t)windows[w]->max.y - windows[w]->min.y >= BP_IMAGE_SIDE_MAX)
            return bp_image_fail(reader->input, err,
                                 "found a %s window of %lld by %lld texels, expected sides of "
                                 "1 to %u",
                                 w == 0 ? "data" : "display",
                                 (long long)windows[w]->max.x - windows[w]->min.x + 1,
                                 (long long)windows[w]->max.y - windows[w]->min.y + 1, BP_IMAGE_SIDE_MAX);
    return BP_OK;
}

/* Copies those pixels of an unpacked chunk that the display window has. */
static void place_block(ExrReader *reader, int64_t column, int64_t row, int64_t columns, int64_t rows) {
    const int64_t left = column + reader->window.min.x - reader->display.min.x;
    const int64_t top = row + reader->window.min.y - reader->display.min.y;
    const int64_t width = reader->image->width, height = reader->image->height;
    const int64_t begin = left < 0 ? -left : 0, end = left + columns > width ? width - left : columns;
    const float *const alpha = reader->block + 3 * columns * rows;
    for (int64_t y = 0; y < rows && begin < end; y++) {
        if (top + y < 0 || top + y >= height) continue;
        memcpy(reader->image->texels + 3 * ((top + y) * width + left + begin),
               reader->block + 3 * (y * columns + begin), (size_t)(end - begin) * 3 * sizeof(float));
        for (int64_t x = begin; x < end; x++) reader->transparent += alpha[y * columns + x] < 1;
    }
}

/* Room for the pixels of a chunk, all black and opaque. */
static BpStatus clear_block(ExrReader *reader, int64_t columns, int64_t rows, BpError *err) {
    const size_t count = (size_t)columns * (size_t)rows, size = count * 4 * sizeof(float);
    if (size > reader->block_size) {
        free(reader->block);
        reader->block = malloc(size);
        reader->block_size = reader->block != NULL ? size : 0;
        if (reader->block == NULL)
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for reading an OpenEXR file");
    }
    if (size > 0) memset(reader->block, 0, size);
    for (size_t i = 3 * count; i < 4 * count; i++) reader->block[i] = 1;
    return BP_OK;
}

/* Reads a block of pixels. `column`, `row`: of its first, in the data window. */
static BpStatus read_chunk(ExrReader *reader, const exr_chunk_info_t *chunk, int64_t column, int64_t row,
                           BpError *err) {
    const int64_t width = (int64_t)reader->window.max.x - reader->window.min.x + 1;
    const int64_t height = (int64_t)reader->window.max.y - reader->window.min.y + 1;
    const int part = reader->layer.part;
    char what[64];
    snprintf(what, sizeof what, "row %lld, column %lld", (long long)row, (long long)column);
    if (column < 0 || row < 0 || chunk->width < 0 || chunk->height < 0 || column + chunk->width > width ||
        row + chunk->height > height || chunk->unpacked_size > CHUNK_BYTES_MAX ||
        chunk->packed_size > reader->input->size)
        return fail_code(reader, what, EXR_ERR_CORRUPT_CHUNK, err);
    BP_TRY(check_b44(reader, chunk, err));
    BP_TRY(clear_block(reader, chunk->width, chunk->height, err));
    exr_result_t code = reader->decoding ? exr_decoding_update(reader->exr, part, chunk, &reader->decode)
                                         : exr_decoding_initialize(reader->exr, part, chunk, &reader->decode);
    const bool first = !reader->decoding;
    reader->decoding = reader->decoding || code == EXR_ERR_SUCCESS;
    for (int i = 0; i < reader->decode.channel_count && code == EXR_ERR_SUCCESS; i++) {
        exr_coding_channel_info_t *channel = &reader->decode.channels[i];
        const int place = bp_exr_channel_place(&reader->layer, channel->channel_name);
        const bool alpha = bp_exr_channel_is_alpha(&reader->layer, channel->channel_name) &&
                           channel->x_samples == 1 && channel->y_samples == 1 &&
                           channel->data_type != EXR_PIXEL_UINT;
        const int32_t stride = (int32_t)sizeof(float) * (alpha ? 1 : 3);
        channel->decode_to_ptr = NULL;
        if (place < 0 && !alpha) continue;
        channel->decode_to_ptr =
            (uint8_t *)(reader->block + (alpha ? (ptrdiff_t)3 * chunk->width * chunk->height : place));
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_pixel_stride = stride;
        channel->user_line_stride = stride * chunk->width;
    }
    if (code == EXR_ERR_SUCCESS && first)
        code = exr_decoding_choose_default_routines(reader->exr, part, &reader->decode);
    if (code == EXR_ERR_SUCCESS) code = exr_decoding_run(reader->exr, part, &reader->decode);
    if (code != EXR_ERR_SUCCESS) return fail_code(reader, what, code, err);
    place_block(reader, column, row, chunk->width, chunk->height);
    return BP_OK;
}

/* Numbers of units of `step` pixels, counted from where the data begin. */
typedef struct Span {
    int64_t begin, end;
} Span;

/* The units that the display window has pixels of. */
static Span span_shown(int32_t data_min, int32_t data_max, int32_t shown_min, int32_t shown_max,
                       int64_t step) {
    const int64_t first = shown_min > data_min ? (int64_t)shown_min - data_min : 0;
    const int64_t last = (int64_t)(shown_max < data_max ? shown_max : data_max) - data_min;
    return (Span){first / step, last < first ? first / step : last / step + 1};
}

static Span rows_shown(const ExrReader *reader, int64_t step) {
    return span_shown(reader->window.min.y, reader->window.max.y, reader->display.min.y,
                      reader->display.max.y, step);
}

static Span columns_shown(const ExrReader *reader, int64_t step) {
    return span_shown(reader->window.min.x, reader->window.max.x, reader->display.min.x,
                      reader->display.max.x, step);
}

static BpStatus read_lines(ExrReader *reader, BpError *err) {
    int32_t lines = 0;
    exr_result_t code = exr_get_scanlines_per_chunk(reader->exr, reader->layer.part, &lines);
    if (code != EXR_ERR_SUCCESS || lines < 1) return fail_code(reader, "its header", code, err);
    const Span chunks = rows_shown(reader, lines);
    for (int64_t row = chunks.begin * lines; row < chunks.end * lines; row += lines) {
        exr_chunk_info_t chunk;
        code = exr_read_scanline_chunk_info(reader->exr, reader->layer.part,
                                            (int)(row + reader->window.min.y), &chunk);
        char what[32];
        snprintf(what, sizeof what, "row %lld", (long long)row);
        if (code != EXR_ERR_SUCCESS) return fail_code(reader, what, code, err);
        BP_TRY(read_chunk(reader, &chunk, 0, (int64_t)chunk.start_y - reader->window.min.y, err));
    }
    return BP_OK;
}

static BpStatus read_tiles(ExrReader *reader, BpError *err) {
    const int part = reader->layer.part;
    uint32_t tile_width = 0, tile_height = 0;
    exr_tile_level_mode_t levels;
    exr_tile_round_mode_t rounding;
    exr_result_t code =
        exr_get_tile_descriptor(reader->exr, part, &tile_width, &tile_height, &levels, &rounding);
    if (code != EXR_ERR_SUCCESS || tile_width < 1 || tile_height < 1)
        return fail_code(reader, "its tiles", code, err);
    const Span rows = rows_shown(reader, tile_height), columns = columns_shown(reader, tile_width);
    for (int64_t y = rows.begin; y < rows.end; y++)
        for (int64_t x = columns.begin; x < columns.end; x++) {
            exr_chunk_info_t chunk;
            char what[64];
            snprintf(what, sizeof what, "tile %lld, %lld", (long long)x, (long long)y);
            code = exr_read_tile_chunk_info(reader->exr, part, (int)x, (int)y, 0, 0, &chunk);
            if (code != EXR_ERR_SUCCESS) return fail_code(reader, what, code, err);
            BP_TRY(read_chunk(reader, &chunk, x * tile_width, y * tile_height, err));
        }
    return BP_OK;
}

static void spread_gray(BpImage *image) {
    const size_t count = (size_t)image->width * image->height;
    for (size_t i = 0; i < count; i++)
        image->texels[3 * i + 1] = image->texels[3 * i + 2] = image->texels[3 * i];
}

/* Says what of the display window has no data, and what of the data is not shown. */
static void note_windows(const ExrReader *reader) {
    const Span rows = rows_shown(reader, 1), columns = columns_shown(reader, 1);
    const int64_t shown = columns.end > columns.begin && rows.end > rows.begin
                              ? (columns.end - columns.begin) * (rows.end - rows.begin)
                              : 0;
    const int64_t texels = (int64_t)reader->image->width * reader->image->height;
    const int64_t data = ((int64_t)reader->window.max.x - reader->window.min.x + 1) *
                         ((int64_t)reader->window.max.y - reader->window.min.y + 1);
    if (shown < texels)
        bp_texels_note(reader->image, "it has data for %lld of %lld texels, and the others are black",
                       (long long)shown, (long long)texels);
    if (shown < data)
        bp_texels_note(reader->image, "%lld pixels outside its display window are left out",
                       (long long)(data - shown));
}

/* Colours of other primaries become Rec. 709's; grey is the same in all of them. */
static BpStatus convert_colors(const ExrReader *reader, BpError *err) {
    exr_attr_chromaticities_t c;
    if (reader->layer.gray ||
        exr_attr_get_chromaticities(reader->exr, reader->layer.part, "chromaticities", &c) != EXR_ERR_SUCCESS)
        return BP_OK;
    const BpPrimaries primaries = {{(double)c.red_x, (double)c.red_y},
                                   {(double)c.green_x, (double)c.green_y},
                                   {(double)c.blue_x, (double)c.blue_y},
                                   {(double)c.white_x, (double)c.white_y}};
    return bp_image_convert(reader->input, &primaries, "the attribute \"chromaticities\"", reader->image,
                            err);
}

static BpStatus read_image(ExrReader *reader, BpError *err) {
    exr_storage_t storage;
    BP_TRY(open_file(reader, err));
    BP_TRY(bp_exr_layer_choose(reader->input, reader->exr, &reader->layer, err));
    BP_TRY(read_header(reader, &storage, err));
    BP_TRY(read_compression(reader, err));
    const exr_attr_box2i_t display = reader->display;
    BP_TRY(bp_image_allocate(reader->input, (uint64_t)((int64_t)display.max.x - display.min.x + 1),
                             (uint64_t)((int64_t)display.max.y - display.min.y + 1), &reader->image, err));
    BP_TRY(storage == EXR_STORAGE_SCANLINE ? read_lines(reader, err) : read_tiles(reader, err));
    if (reader->layer.gray) spread_gray(reader->image);
    if (reader->layer.note[0] != '\0') bp_texels_note(reader->image, "%s", reader->layer.note);
    note_windows(reader);
    bp_texels_note_alpha(reader->image, reader->transparent);
    return convert_colors(reader, err);
}

BpStatus bp_image_read_exr(const BpImageInput *input, BpImage **image, BpError *err) {
    ExrReader reader = {.input = input};
    const BpStatus status = read_image(&reader, err);
    if (reader.decoding) exr_decoding_destroy(reader.exr, &reader.decode);
    if (reader.exr != NULL) exr_finish(&reader.exr);
    free(reader.block);
    if (status != BP_OK) bp_texels_destroy(&reader.image);
    *image = reader.image;
    return status;
}
