/* fuzz_pictures.c: any picture in every format: what is written reads back equal (host/image/image.h).
 *
 * The input is width, height, which layers there are, then bits of floats: NaN, infinities and huge values
 * come of themselves. PNG is read by libpng, EXR by OpenEXRCore, the others byte by byte. */
#include "fuzz.h"
#include "image/image.h"

#include <openexr.h>
#include <png.h>
#include <stdio.h>

#define SIDE_MAX 40u

/* ---- making and writing ---- */

static float *make_plane(Bytes *bytes, size_t count) {
    float *plane = malloc(count * sizeof *plane);
    require(plane != NULL);
    for (size_t i = 0; i < count; i++) plane[i] = take_float(bytes);
    return plane;
}

static BpPicture make_picture(Bytes *bytes) {
    const uint32_t width = 1 + take_byte(bytes) % SIDE_MAX, height = 1 + take_byte(bytes) % SIDE_MAX;
    const uint8_t layers = take_byte(bytes);
    const size_t pixels = (size_t)width * height;
    BpPicture picture = {.width = width, .height = height, .rgb = make_plane(bytes, 3 * pixels)};
    if (layers & 1u) picture.error = make_plane(bytes, 3 * pixels);
    if (layers & 2u) picture.depth = make_plane(bytes, pixels);
    if (layers & 4u) picture.normal = make_plane(bytes, 3 * pixels);
    if (layers & 8u) picture.albedo = make_plane(bytes, 3 * pixels);
    if (layers & 16u) {
        picture.samples = malloc(pixels * sizeof *picture.samples);
        require(picture.samples != NULL);
        for (size_t i = 0; i < pixels; i++) picture.samples[i] = take_bits(bytes, layers & 32u ? 8 : 3);
    }
    return picture;
}

static uint8_t *write_picture(const BpPicture *picture, BpFormat format, BpTransfer transfer, size_t *size) {
    char *bytes = NULL;
    FILE *out = open_memstream(&bytes, size);
    require(out != NULL && bp_picture_write_stream(picture, out, format, transfer, NULL) == BP_OK);
    fclose(out);
    return (uint8_t *)bytes;
}

/* ---- PPM and PFM ---- */

static uint8_t byte_of(const BpPicture *picture, size_t i, BpTransfer transfer) {
    return bp_transfer_byte((double)picture->rgb[i], transfer);
}

/* The pixels behind a header; stops unless the header is this one and the rest as long as `body` says. */
static const uint8_t *after_header(const uint8_t *file, size_t size, const char *header, size_t body) {
    const size_t length = strlen(header);
    require(size == length + body && memcmp(file, header, length) == 0);
    return file + length;
}

static void check_ppm(const BpPicture *picture, BpTransfer transfer) {
    const size_t count = 3 * (size_t)picture->width * picture->height;
    char header[64];
    size_t size = 0;
    uint8_t *file = write_picture(picture, BP_FORMAT_PPM, transfer, &size);
    snprintf(header, sizeof header, "P6\n%u %u\n255\n", picture->width, picture->height);
    const uint8_t *pixels = after_header(file, size, header, count);
    for (size_t i = 0; i < count; i++) require(pixels[i] == byte_of(picture, i, transfer));
    free(file);

    char *text = (char *)write_picture(picture, BP_FORMAT_PPM_ASCII, transfer, &size);
    unsigned width = 0, height = 0;
    int used = 0;
    require(sscanf(text, "P3 %u %u 255%n", &width, &height, &used) == 2 && used > 0);
    require(width == picture->width && height == picture->height);
    char *rest = text + used;
    for (size_t i = 0; i < count; i++) require(strtol(rest, &rest, 10) == byte_of(picture, i, transfer));
    require(strcmp(rest, "\n") == 0);
    free(text);
}

static void check_pfm(const BpPicture *picture) {
    const size_t row = 3 * (size_t)picture->width;
    char header[64];
    size_t size = 0;
    uint8_t *file = write_picture(picture, BP_FORMAT_PFM, BP_TRANSFER_SRGB, &size);
    snprintf(header, sizeof header, "PF\n%u %u\n-1.0\n", picture->width, picture->height);
    const uint8_t *bytes = after_header(file, size, header, 4 * row * picture->height);
    for (size_t y = 0; y < picture->height; y++)
        for (size_t i = 0; i < row; i++) {
            const uint8_t *at = bytes + 4 * ((picture->height - 1 - y) * row + i); /* the bottom row first */
            const uint32_t bits =
                at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
            require(memcmp(&bits, &picture->rgb[y * row + i], 4) == 0);
        }
    free(file);
}

/* ---- PNG ---- */

static void check_png(const BpPicture *picture, BpTransfer transfer) {
    size_t size = 0;
    uint8_t *file = write_picture(picture, BP_FORMAT_PNG, transfer, &size);
    png_image image = {.version = PNG_IMAGE_VERSION};
    require(png_image_begin_read_from_memory(&image, file, size) != 0);
    png_image_free(&image);
    /* The simplified interface would convert by the file's gamma. */
    FILE *in = fmemopen(file, size, "rb");
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    require(in != NULL && info != NULL);
    if (setjmp(png_jmpbuf(png))) abort();
    png_init_io(png, in);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    require(png_get_image_width(png, info) == picture->width &&
            png_get_image_height(png, info) == picture->height);
    require(png_get_bit_depth(png, info) == 8 && png_get_color_type(png, info) == PNG_COLOR_TYPE_RGB);
    png_bytepp rows = png_get_rows(png, info);
    const size_t row = 3 * (size_t)picture->width;
    for (size_t y = 0; y < picture->height; y++)
        for (size_t i = 0; i < row; i++) require(rows[y][i] == byte_of(picture, y * row + i, transfer));
    png_destroy_read_struct(&png, &info, NULL);
    fclose(in);
    free(file);
}

/* ---- EXR ---- */

typedef struct Memory {
    const uint8_t *bytes;
    size_t size;
} Memory;

static int64_t memory_size(exr_const_context_t context, void *user_data) {
    (void)context;
    return (int64_t)((const Memory *)user_data)->size;
}

static int64_t read_memory(exr_const_context_t context, void *user_data, void *buffer, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t error_callback) {
    const Memory *memory = user_data;
    (void)context;
    (void)error_callback;
    if (offset > memory->size) return -1;
    const size_t left = memory->size - (size_t)offset, count = size < left ? (size_t)size : left;
    memcpy(buffer, memory->bytes + offset, count);
    return (int64_t)count;
}

/* One channel of the file, 32 bits a pixel. */
static void read_channel(exr_context_t exr, const char *name, exr_pixel_type_t type, const BpPicture *picture,
                         uint32_t *values) {
    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    int32_t rows = 0;
    unsigned found = 0;
    require(exr_get_scanlines_per_chunk(exr, 0, &rows) == EXR_ERR_SUCCESS && rows > 0);
    for (uint32_t y = 0; y < picture->height; y += (uint32_t)rows) {
        exr_chunk_info_t chunk;
        require(exr_read_scanline_chunk_info(exr, 0, (int)y, &chunk) == EXR_ERR_SUCCESS);
        require((y == 0 ? exr_decoding_initialize(exr, 0, &chunk, &decoder)
                        : exr_decoding_update(exr, 0, &chunk, &decoder)) == EXR_ERR_SUCCESS);
        for (int16_t c = 0; c < decoder.channel_count; c++) {
            exr_coding_channel_info_t *channel = &decoder.channels[c];
            channel->decode_to_ptr = NULL;
            if (strcmp(channel->channel_name, name) != 0) continue;
            require(channel->data_type == type);
            channel->decode_to_ptr = (uint8_t *)(values + (size_t)y * picture->width);
            channel->user_pixel_stride = 4;
            channel->user_line_stride = (int32_t)(4 * picture->width);
            found++;
        }
        if (y == 0) require(exr_decoding_choose_default_routines(exr, 0, &decoder) == EXR_ERR_SUCCESS);
        require(exr_decoding_run(exr, 0, &decoder) == EXR_ERR_SUCCESS);
    }
    require(found > 0);
    exr_decoding_destroy(exr, &decoder);
}

/* Compares `channels` interleaved planes of floats with the channels of these names, bit for bit. */
static int check_planes(exr_context_t exr, const BpPicture *picture, const float *planes,
                        const char *const *names, size_t channels, uint32_t *values) {
    if (planes == NULL) return 0;
    const size_t pixels = (size_t)picture->width * picture->height;
    for (size_t c = 0; c < channels; c++) {
        read_channel(exr, names[c], EXR_PIXEL_FLOAT, picture, values);
        for (size_t i = 0; i < pixels; i++) require(memcmp(&values[i], &planes[channels * i + c], 4) == 0);
    }
    return (int)channels;
}

static void check_exr(const BpPicture *picture) {
    static const char *const rgb[] = {"R", "G", "B"}, *const error[] = {"error.R", "error.G", "error.B"};
    static const char *const normal[] = {"normal.X", "normal.Y", "normal.Z"}, *const depth[] = {"depth.Z"};
    static const char *const albedo[] = {"albedo.R", "albedo.G", "albedo.B"};
    const size_t pixels = (size_t)picture->width * picture->height;
    Memory memory = {NULL, 0};
    uint8_t *file = write_picture(picture, BP_FORMAT_EXR, BP_TRANSFER_SRGB, &memory.size);
    memory.bytes = file;
    exr_context_t exr = NULL;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.user_data = &memory;
    setup.read_fn = read_memory;
    setup.size_fn = memory_size;
    require(exr_start_read(&exr, "memory", &setup) == EXR_ERR_SUCCESS);
    exr_attr_box2i_t window;
    require(exr_get_data_window(exr, 0, &window) == EXR_ERR_SUCCESS);
    require(window.max.x - window.min.x + 1 == (int32_t)picture->width);
    require(window.max.y - window.min.y + 1 == (int32_t)picture->height);
    uint32_t *values = malloc(pixels * sizeof *values);
    require(values != NULL);
    int channels = check_planes(exr, picture, picture->rgb, rgb, 3, values);
    channels += check_planes(exr, picture, picture->error, error, 3, values);
    channels += check_planes(exr, picture, picture->depth, depth, 1, values);
    channels += check_planes(exr, picture, picture->normal, normal, 3, values);
    channels += check_planes(exr, picture, picture->albedo, albedo, 3, values);
    if (picture->samples != NULL) {
        read_channel(exr, "samples", EXR_PIXEL_UINT, picture, values);
        for (size_t i = 0; i < pixels; i++)
            require(values[i] == (picture->samples[i] < UINT32_MAX ? picture->samples[i] : UINT32_MAX));
        channels++;
    }
    const exr_attr_chlist_t *list = NULL;
    require(exr_get_channels(exr, 0, &list) == EXR_ERR_SUCCESS && list->num_channels == channels);
    exr_finish(&exr);
    free(values);
    free(file);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Bytes bytes = {data, size, 0};
    BpPicture picture = make_picture(&bytes);
    static const BpTransfer transfers[] = {BP_TRANSFER_GAMMA2, BP_TRANSFER_SRGB, BP_TRANSFER_LINEAR};
    for (size_t t = 0; t < 3; t++) {
        check_ppm(&picture, transfers[t]);
        check_png(&picture, transfers[t]);
    }
    check_pfm(&picture);
    check_exr(&picture);
    bp_picture_clear(&picture);
    return 0;
}
