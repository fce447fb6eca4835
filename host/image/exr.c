/* exr.c: OpenEXR by its C API (OpenEXRCore); see image.h.
 *
 * 32-bit channels: half floats would round the radiance to 11 bits and end at 65504, and the standard errors
 * with it. The library needs to seek, so the file is assembled in memory (it is smaller than the picture) and
 * then written in one piece, to a file, a pipe or a test. */
#include "image.h"

#include "base/output_file.h"
#include "base/status.h"

#include "aov_list.h"

#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A name that no file can have, for the library's messages and for its unlink after a failure. */
#define NO_FILE "/dev/null/picture.exr"
#define LAYERS_MAX (3 + 1 + 3 + 1 + AOV_FLOATS) /* radiance, alpha, error, samples, AOVs */

/* One channel of the file: its first value and the distance to the next pixel's. */
typedef struct Layer {
    char name[32];
    const void *values;
    size_t pixel_stride; /* bytes */
    exr_pixel_type_t type;
} Layer;

/* The file while it is made. */
typedef struct Memory {
    uint8_t *bytes;
    size_t size, capacity;
    bool failed; /* there was no more */
} Memory;

static int64_t write_memory(exr_const_context_t context, void *user_data, const void *buffer, uint64_t size,
                            uint64_t offset, exr_stream_error_func_ptr_t error_callback) {
    (void)context;
    (void)error_callback;
    Memory *memory = user_data;
    const size_t end = (size_t)(offset + size);
    if (end > memory->capacity) {
        const size_t capacity = end + end / 2 + 4096;
        uint8_t *bytes = realloc(memory->bytes, capacity);
        if (bytes == NULL) {
            memory->failed = true;
            return -1;
        }
        memset(bytes + memory->capacity, 0, capacity - memory->capacity);
        memory->bytes = bytes;
        memory->capacity = capacity;
    }
    memcpy(memory->bytes + offset, buffer, (size_t)size);
    if (end > memory->size) memory->size = end;
    return (int64_t)size;
}

/* The library calls this while it holds the context's lock, which is not recursive. Any call on the context
 * here, even for its user data, would deadlock. The code that the failed call returns suffices. */
static void keep_quiet(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context;
    (void)code;
    (void)message;
}

/* Lists `floats` adjacent values per pixel as channels that are named by the letters. */
static void list_floats(const char *before, const char *letters, const float *values, size_t floats,
                        Layer layers[LAYERS_MAX], size_t *count) {
    for (size_t c = 0; c < floats && values != NULL; c++) {
        Layer *layer = &layers[(*count)++];
        *layer =
            (Layer){.values = values + c, .pixel_stride = floats * sizeof *values, .type = EXR_PIXEL_FLOAT};
        snprintf(layer->name, sizeof layer->name, "%s%c", before, letters[c]);
    }
}

/* The layers of `picture`. `samples` holds the counts as 32-bit numbers. */
static size_t list_layers(const BpPicture *picture, const uint32_t *samples, Layer layers[LAYERS_MAX]) {
    size_t count = 0;
    list_floats("", "RGB", picture->rgb, 3, layers, &count);
    list_floats("", "A", picture->alpha, 1, layers, &count); /* radiance is premultiplied, as EXR has it */
    list_floats("error.", "RGB", picture->error, 3, layers, &count);
    if (samples != NULL) layers[count++] = (Layer){"samples", samples, sizeof *samples, EXR_PIXEL_UINT};
#define LIST(place, member, floats, mean, channels)                                                          \
    list_floats(#member ".", channels, picture->member, floats, layers, &count);
    AOV_LIST(LIST)
#undef LIST
    return count;
}

static exr_result_t write_extra(exr_context_t exr, int part, const BpImageExtra *extra) {
    exr_result_t result =
        exr_attr_set_string(exr, part, "software", extra->software != NULL ? extra->software : "Ballpark");
    if (result == EXR_ERR_SUCCESS && extra->dots_per_inch > 0)
        result = exr_attr_set_float(exr, part, "xDensity", (float)extra->dots_per_inch);
    for (size_t i = 0; i < extra->note_count && result == EXR_ERR_SUCCESS; i++)
        result = exr_attr_set_string(exr, part, extra->notes[i].exr_key, extra->notes[i].text);
    return result;
}

static exr_result_t write_head(exr_context_t exr, const BpPicture *picture, const Layer *layers, size_t count,
                               const BpImageExtra *extra) {
    int part = 0;
    exr_result_t result = exr_add_part(exr, NULL, EXR_STORAGE_SCANLINE, &part);
    if (result != EXR_ERR_SUCCESS) return result;
    result = exr_initialize_required_attr_simple(exr, part, (int32_t)picture->width, (int32_t)picture->height,
                                                 EXR_COMPRESSION_ZIP);
    for (size_t i = 0; i < count && result == EXR_ERR_SUCCESS; i++)
        result =
            exr_add_channel(exr, part, layers[i].name, layers[i].type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    if (result != EXR_ERR_SUCCESS) return result;
    /* Primaries and white of Rec. 709 and sRGB. */
    const exr_attr_chromaticities_t rec709 = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    result = exr_attr_set_chromaticities(exr, part, "chromaticities", &rec709);
    if (result != EXR_ERR_SUCCESS) return result;
    result = write_extra(exr, part, extra);
    return result != EXR_ERR_SUCCESS ? result : exr_write_header(exr);
}

/* Points the encoder's channels, which are in the library's order, at the rows from `y` on. */
static void aim_channels(exr_encode_pipeline_t *encoder, uint32_t width, uint32_t y, const Layer *layers,
                         size_t count) {
    for (int16_t c = 0; c < encoder->channel_count; c++) {
        exr_coding_channel_info_t *channel = &encoder->channels[c];
        for (size_t i = 0; i < count; i++) {
            if (strcmp(channel->channel_name, layers[i].name) != 0) continue;
            const size_t line_stride = layers[i].pixel_stride * width;
            channel->user_pixel_stride = (int32_t)layers[i].pixel_stride;
            channel->user_line_stride = (int32_t)line_stride;
            channel->encode_from_ptr = (const uint8_t *)layers[i].values + line_stride * y;
        }
    }
}

typedef exr_result_t Compress(exr_encode_pipeline_t *);

/* Readers take a block that is as long as its pixels for an uncompressed one. OpenEXRCore 3.1 stores pixels
 * uncompressed if compressing makes them longer, but not if the length stays the same: such a block would be
 * read as noise. If zlib is out of memory, the library reports corrupt pixels, as if it had read them. */
static exr_result_t compress_or_keep(exr_encode_pipeline_t *encoder) {
    Compress *const *const compress = encoder->encoding_user_data;
    const exr_result_t result = (*compress)(encoder);
    if (result == EXR_ERR_CORRUPT_CHUNK) return EXR_ERR_OUT_OF_MEMORY;
    if (result == EXR_ERR_SUCCESS && encoder->compressed_bytes == encoder->packed_bytes)
        memcpy(encoder->compressed_buffer, encoder->packed_buffer, (size_t)encoder->packed_bytes);
    return result;
}

static exr_result_t write_rows(exr_context_t exr, const BpPicture *picture, const Layer *layers,
                               size_t count) {
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    Compress *compress = NULL;
    int32_t chunk_rows = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(exr, 0, &chunk_rows);
    if (result == EXR_ERR_SUCCESS && chunk_rows < 1) result = EXR_ERR_UNKNOWN;
    for (uint32_t y = 0; y < picture->height && result == EXR_ERR_SUCCESS; y += (uint32_t)chunk_rows) {
        exr_chunk_info_t chunk;
        result = exr_write_scanline_chunk_info(exr, 0, (int)y, &chunk);
        if (result != EXR_ERR_SUCCESS) break;
        result = y == 0 ? exr_encoding_initialize(exr, 0, &chunk, &encoder)
                        : exr_encoding_update(exr, 0, &chunk, &encoder);
        if (result != EXR_ERR_SUCCESS) break;
        aim_channels(&encoder, picture->width, y, layers, count);
        if (y == 0) {
            result = exr_encoding_choose_default_routines(exr, 0, &encoder);
            compress = encoder.compress_fn;
            encoder.encoding_user_data = &compress;
            encoder.compress_fn = compress_or_keep;
        }
        if (result == EXR_ERR_SUCCESS) result = exr_encoding_run(exr, 0, &encoder);
    }
    exr_encoding_destroy(exr, &encoder);
    return result;
}

BpStatus bp_exr_write(const BpPicture *picture, FILE *out, const BpImageExtra *extra, BpError *err) {
    BpStatus status = BP_OK;
    Memory memory = {.bytes = NULL};
    exr_context_t exr = NULL;
    uint32_t *samples = NULL;
    if (picture->samples != NULL) {
        const size_t pixels = (size_t)picture->width * picture->height;
        samples = malloc(pixels * sizeof *samples);
        if (samples == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the EXR's sample counts");
        for (size_t i = 0; i < pixels; i++)
            samples[i] = picture->samples[i] < UINT32_MAX ? (uint32_t)picture->samples[i] : UINT32_MAX;
    }
    Layer layers[LAYERS_MAX];
    const size_t count = list_layers(picture, samples, layers);

    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.user_data = &memory;
    setup.write_fn = write_memory;
    setup.error_handler_fn = keep_quiet;
    exr_result_t result = exr_start_write(&exr, NO_FILE, EXR_WRITE_FILE_DIRECTLY, &setup);
    if (result == EXR_ERR_SUCCESS) result = write_head(exr, picture, layers, count, extra);
    if (result == EXR_ERR_SUCCESS) result = write_rows(exr, picture, layers, count);
    /* Also writes the table of chunks. */
    const exr_result_t finished = exr != NULL ? exr_finish(&exr) : EXR_ERR_SUCCESS;
    if (result == EXR_ERR_SUCCESS) result = finished;
    if (result != EXR_ERR_SUCCESS) {
        if (memory.failed) result = EXR_ERR_OUT_OF_MEMORY;
        status = bp_fail(err, result == EXR_ERR_OUT_OF_MEMORY ? BP_ERR_MEMORY : BP_ERR_FILE,
                         "encoding the EXR of %u x %u pixels failed: %s", (unsigned)picture->width,
                         (unsigned)picture->height, exr_get_default_error_message(result));
    } else {
        fwrite(memory.bytes, 1, memory.size, out);
        status = bp_output_finish(out, "EXR", err);
    }
    free(memory.bytes);
    free(samples);
    return status;
}
