/* test_image_formats.c: what is written reads back: PPM and PFM byte by byte, PNG by libpng, EXR by
 * OpenEXRCore.
 */
#include "support/output_temp.h"

#include "image/image.h"

#include <float.h>
#include <math.h>
#include <openexr.h>
#include <png.h>
#include <signal.h>
#include <sys/resource.h>

/* A picture of all kinds of values, the odd ones first. */
static BpPicture make_picture(uint32_t width, uint32_t height) {
    const size_t count = (size_t)width * height;
    BpPicture picture = {.width = width,
                         .height = height,
                         .rgb = malloc(count * 12),
                         .error = malloc(count * 12),
                         .samples = malloc(count * 8),
                         .depth = malloc(count * 4),
                         .normal = malloc(count * 12),
                         .albedo = malloc(count * 12)};
    static const float odd[] = {NAN, INFINITY, -1, 1e-42f, 3e38f, -0.0f};
    for (size_t i = 0; i < 3 * count; i++) {
        picture.rgb[i] = i < 6 ? odd[i] : (float)((double)(i * 2654435761u % 1000003) / 900000);
        picture.error[i] = i % 7 == 0 ? NAN : (float)i * 1e-3f;
        picture.normal[i] = (float)(i % 13) / 6 - 1;
        picture.albedo[i] = (float)(i % 17) / 16;
    }
    for (size_t i = 0; i < count; i++) {
        picture.samples[i] = i == 1 ? UINT64_C(1) << 33 : i;
        picture.depth[i] = i % 5 == 0 ? INFINITY : (float)i;
    }
    return picture;
}

/* The picture as a file in memory; free() it. */
static uint8_t *write_bytes(const BpPicture *picture, BpFormat format, BpTransfer transfer, size_t *size) {
    char *bytes = NULL;
    FILE *out = open_memstream(&bytes, size);
    BpError err = {0};
    const BpStatus status = bp_picture_write_stream(picture, out, format, transfer, &err);
    if (status != BP_OK) fail_msg("%s", err.message);
    fclose(out);
    return (uint8_t *)bytes;
}

static void names_and_endings(void **state) {
    (void)state;
    BpFormat format = BP_FORMAT_BPA;
    assert_true(bp_format_from_name("ppm-ascii", &format));
    assert_int_equal(format, BP_FORMAT_PPM_ASCII);
    assert_true(bp_format_from_path("a.b/c.d.PNG", &format));
    assert_int_equal(format, BP_FORMAT_PNG);
    assert_true(bp_format_from_path("x.exr", &format));
    assert_int_equal(format, BP_FORMAT_EXR);
    assert_true(bp_format_from_path("x.bpa", &format));
    assert_int_equal(format, BP_FORMAT_BPA);
    assert_false(bp_format_from_path("folder.png/x", &format));
    assert_false(bp_format_from_path("x.ppm-ascii", &format));
    assert_false(bp_format_from_path("x.jpeg", &format));
    assert_false(bp_format_from_path("x.", &format));
    assert_false(bp_format_from_name("", &format));
}

static void binary_ppm(void **state) {
    (void)state;
    BpPicture picture = make_picture(5, 3);
    size_t size = 0;
    uint8_t *bytes = write_bytes(&picture, BP_FORMAT_PPM, BP_TRANSFER_GAMMA2, &size);
    static const char head[] = "P6\n5 3\n255\n";
    assert_int_equal(size, strlen(head) + 45);
    assert_memory_equal(bytes, head, strlen(head));
    for (size_t i = 0; i < 45; i++)
        assert_int_equal(bytes[strlen(head) + i],
                         bp_transfer_byte((double)picture.rgb[i], BP_TRANSFER_GAMMA2));
    free(bytes);
    bp_picture_clear(&picture);
}

static void text_ppm(void **state) {
    (void)state;
    BpPicture picture = make_picture(5, 3);
    size_t size = 0;
    char *text = (char *)write_bytes(&picture, BP_FORMAT_PPM_ASCII, BP_TRANSFER_SRGB, &size);
    int width = 0, height = 0, most = 0, consumed = 0;
    assert_int_equal(sscanf(text, "P3 %d %d %d%n", &width, &height, &most, &consumed), 3);
    assert_true(width == 5 && height == 3 && most == 255);
    const char *rest = text + consumed;
    for (size_t i = 0; i < 45; i++) {
        char *end = NULL;
        assert_int_equal(strtol(rest, &end, 10), bp_transfer_byte((double)picture.rgb[i], BP_TRANSFER_SRGB));
        rest = end;
    }
    assert_string_equal(rest, "\n");
    size_t line = 0;
    for (size_t i = 0; i < size; i++) {
        line = text[i] == '\n' ? 0 : line + 1;
        assert_true(line <= 70);
    }
    free(text);
    bp_picture_clear(&picture);
}

static void pfm_keeps_every_bit(void **state) {
    (void)state;
    BpPicture picture = make_picture(4, 3);
    size_t size = 0;
    uint8_t *bytes = write_bytes(&picture, BP_FORMAT_PFM, BP_TRANSFER_SRGB, &size);
    static const char head[] = "PF\n4 3\n-1.0\n";
    assert_int_equal(size, strlen(head) + 4 * 3 * 12);
    assert_memory_equal(bytes, head, strlen(head));
    for (size_t y = 0; y < 3; y++)
        for (size_t i = 0; i < 12; i++) {
            const uint8_t *at = bytes + strlen(head) + 4 * ((2 - y) * 12 + i); /* the bottom row first */
            const uint32_t bits =
                at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
            uint32_t expected;
            memcpy(&expected, &picture.rgb[y * 12 + i], 4);
            assert_int_equal(bits, expected);
        }
    free(bytes);
    bp_picture_clear(&picture);
}

/* Reads a PNG and compares pixels and tags; `file_gamma` 0 for sRGB. */
static void assert_png(const BpPicture *picture, BpTransfer transfer, double file_gamma) {
    size_t size = 0;
    uint8_t *bytes = write_bytes(picture, BP_FORMAT_PNG, transfer, &size);
    FILE *in = fmemopen(bytes, size, "rb");
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    if (setjmp(png_jmpbuf(png))) fail_msg("libpng cannot read the file");
    png_init_io(png, in);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    assert_int_equal(png_get_image_width(png, info), picture->width);
    assert_int_equal(png_get_image_height(png, info), picture->height);
    assert_int_equal(png_get_bit_depth(png, info), 8);
    assert_int_equal(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB);
    int intent = -1;
    double gamma = 0, white_x = 0, white_y, red_x, red_y, green_x, green_y, blue_x, blue_y;
    assert_int_equal(png_get_sRGB(png, info, &intent) != 0, file_gamma == 0);
    if (file_gamma > 0) {
        assert_true(png_get_gAMA(png, info, &gamma) != 0);
        assert_float_equal(gamma, file_gamma, 1e-5);
        assert_true(png_get_cHRM(png, info, &white_x, &white_y, &red_x, &red_y, &green_x, &green_y, &blue_x,
                                 &blue_y) != 0);
        assert_float_equal(red_x, 0.64, 1e-5);
        assert_float_equal(blue_y, 0.06, 1e-5);
    }
    png_bytepp rows = png_get_rows(png, info);
    const size_t row_size = 3 * (size_t)picture->width;
    for (size_t y = 0; y < picture->height; y++)
        for (size_t i = 0; i < row_size; i++)
            assert_int_equal(rows[y][i], bp_transfer_byte((double)picture->rgb[y * row_size + i], transfer));
    png_destroy_read_struct(&png, &info, NULL);
    fclose(in);
    free(bytes);
}

static void png_reads_back_with_its_tags(void **state) {
    (void)state;
    BpPicture picture = make_picture(37, 21);
    assert_png(&picture, BP_TRANSFER_GAMMA2, 0.5);
    assert_png(&picture, BP_TRANSFER_LINEAR, 1);
    assert_png(&picture, BP_TRANSFER_SRGB, 0);
    bp_picture_clear(&picture);
}

/* A channel of the file by name, decoded by the library. */
static void read_exr_channel(exr_context_t exr, const char *name, exr_pixel_type_t type, uint32_t width,
                             uint32_t height, uint32_t *values) {
    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    int32_t rows = 0;
    bool found = false;
    assert_int_equal(exr_get_scanlines_per_chunk(exr, 0, &rows), EXR_ERR_SUCCESS);
    for (uint32_t y = 0; y < height; y += (uint32_t)rows) {
        exr_chunk_info_t chunk;
        assert_int_equal(exr_read_scanline_chunk_info(exr, 0, (int)y, &chunk), EXR_ERR_SUCCESS);
        if (y == 0)
            assert_int_equal(exr_decoding_initialize(exr, 0, &chunk, &decoder), EXR_ERR_SUCCESS);
        else
            assert_int_equal(exr_decoding_update(exr, 0, &chunk, &decoder), EXR_ERR_SUCCESS);
        for (int16_t c = 0; c < decoder.channel_count; c++) {
            exr_coding_channel_info_t *channel = &decoder.channels[c];
            channel->decode_to_ptr = NULL;
            if (strcmp(channel->channel_name, name) != 0) continue;
            assert_int_equal(channel->data_type, type);
            channel->decode_to_ptr = (uint8_t *)(values + (size_t)y * width);
            channel->user_pixel_stride = 4;
            channel->user_line_stride = (int32_t)(4 * width);
            found = true;
        }
        if (y == 0) assert_int_equal(exr_decoding_choose_default_routines(exr, 0, &decoder), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_run(exr, 0, &decoder), EXR_ERR_SUCCESS);
    }
    assert_true(found);
    exr_decoding_destroy(exr, &decoder);
}

static void assert_exr(uint32_t width, uint32_t height) {
    char folder[64], path[512];
    temp_make(folder);
    BpPicture picture = make_picture(width, height);
    BpError err = {0};
    assert_int_equal(
        bp_picture_write(&picture, temp_path(path, folder, "a.exr"), BP_FORMAT_EXR, BP_TRANSFER_SRGB, &err),
        BP_OK);
    assert_int_equal(temp_count(folder), 1);
    exr_context_t exr = NULL;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    assert_int_equal(exr_start_read(&exr, path, &setup), EXR_ERR_SUCCESS);
    exr_compression_t compression;
    assert_int_equal(exr_get_compression(exr, 0, &compression), EXR_ERR_SUCCESS);
    assert_int_equal(compression, EXR_COMPRESSION_ZIP);
    const exr_attr_chlist_t *channels = NULL;
    assert_int_equal(exr_get_channels(exr, 0, &channels), EXR_ERR_SUCCESS);
    assert_int_equal(channels->num_channels, 14);
    const size_t pixels = (size_t)width * height;
    uint32_t *values = malloc(pixels * 4);
    static const char *const names[] = {"R",        "G",        "B",        "error.R",
                                        "error.G",  "error.B",  "normal.X", "normal.Y",
                                        "normal.Z", "albedo.R", "albedo.G", "albedo.B"};
    const float *const planes[] = {picture.rgb, picture.error, picture.normal, picture.albedo};
    for (size_t layer = 0; layer < 12; layer++) {
        read_exr_channel(exr, names[layer], EXR_PIXEL_FLOAT, width, height, values);
        const float *plane = planes[layer / 3];
        for (size_t i = 0; i < pixels; i++)
            assert_memory_equal(&values[i], &plane[3 * i + layer % 3], 4); /* bits, so NaN too */
    }
    read_exr_channel(exr, "samples", EXR_PIXEL_UINT, width, height, values);
    for (size_t i = 0; i < pixels; i++) assert_int_equal(values[i], i == 1 ? UINT32_MAX : i);
    read_exr_channel(exr, "depth.Z", EXR_PIXEL_FLOAT, width, height, values);
    assert_memory_equal(values, picture.depth, pixels * 4);
    free(values);
    exr_finish(&exr);
    bp_picture_clear(&picture);
    temp_remove(folder);
}

static void exr_reads_back_bit_for_bit(void **state) {
    (void)state;
    assert_exr(37, 35); /* three blocks of 16 rows, the last one short */
    assert_exr(64, 32);
    assert_exr(1, 1);
    assert_exr(1, 100);
    assert_exr(300, 1);
}

/* Pixels of ever more noise: at some amount compressing them leaves them exactly as long as they were, which
 * readers take for pixels that are not compressed. */
static void exr_of_any_noise_reads_back(void **state) {
    (void)state;
    char folder[64], path[512];
    temp_make(folder);
    temp_path(path, folder, "a.exr");
    enum { SIDE = 3, REALS = 3 * SIDE * SIDE, BYTES = 4 * REALS };
    for (uint32_t seed = 0; seed < 8; seed++)
        for (size_t noise = BYTES / 2; noise <= BYTES; noise++) {
            uint8_t bytes[BYTES] = {0};
            uint32_t number = 12345 + seed;
            for (size_t i = 0; i < noise; i++) {
                number = number * 1664525u + 1013904223u;
                bytes[i] = (uint8_t)(number >> 24);
            }
            float rgb[REALS];
            memcpy(rgb, bytes, BYTES);
            const BpPicture picture = {.width = SIDE, .height = SIDE, .rgb = rgb};
            assert_int_equal(bp_picture_write(&picture, path, BP_FORMAT_EXR, BP_TRANSFER_SRGB, NULL), BP_OK);
            exr_context_t exr = NULL;
            exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
            assert_int_equal(exr_start_read(&exr, path, &setup), EXR_ERR_SUCCESS);
            for (size_t c = 0; c < 3; c++) {
                static const char *const names[] = {"R", "G", "B"};
                uint32_t values[SIDE * SIDE];
                read_exr_channel(exr, names[c], EXR_PIXEL_FLOAT, SIDE, SIDE, values);
                for (size_t i = 0; i < SIDE * SIDE; i++) assert_memory_equal(&values[i], &rgb[3 * i + c], 4);
            }
            exr_finish(&exr);
        }
    temp_remove(folder);
}

static void exr_is_compressed(void **state) {
    (void)state;
    BpPicture picture = {.width = 200, .height = 100, .rgb = calloc(60000, sizeof(float))};
    size_t size = 0;
    uint8_t *bytes = write_bytes(&picture, BP_FORMAT_EXR, BP_TRANSFER_SRGB, &size);
    assert_true(size < 24000); /* a tenth */
    free(bytes);
    bp_picture_clear(&picture);
}

/* Every format says so when the disk is full, whether the picture fits the stream's buffer or not. */
static void a_full_disk_is_an_error(void **state) {
    (void)state;
    if (access("/dev/full", W_OK) != 0) {
        printf("skipped: there is no /dev/full here\n");
        skip();
    }
    static const uint32_t sides[] = {1, 200};
    for (size_t s = 0; s < 2; s++) {
        BpPicture picture = make_picture(sides[s], sides[s]);
        for (int format = BP_FORMAT_PNG; format <= BP_FORMAT_EXR; format++) {
            BpError err = {0};
            assert_int_equal(
                bp_picture_write(&picture, "/dev/full", (BpFormat)format, BP_TRANSFER_SRGB, &err),
                BP_ERR_FILE);
            if (strstr(err.message, "No space left") == NULL || strstr(err.message, "/dev/full") == NULL)
                fail_msg("format %d: %s", format, err.message);
        }
        bp_picture_clear(&picture);
    }
}

static void a_failed_write_keeps_the_old_picture(void **state) {
    (void)state;
    char folder[64], path[512];
    temp_make(folder);
    temp_path(path, folder, "a.png");
    BpPicture picture = make_picture(200, 200);
    struct rlimit before, limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    limit = before;
    limit.rlim_cur = 1024;
    void (*const handler)(int) = signal(SIGXFSZ, SIG_IGN);
    for (int format = BP_FORMAT_PNG; format <= BP_FORMAT_EXR; format++) {
        temp_write(path, "old", 3);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
        BpError err = {0};
        const BpStatus status = bp_picture_write(&picture, path, (BpFormat)format, BP_TRANSFER_SRGB, &err);
        setrlimit(RLIMIT_FSIZE, &before);
        assert_int_equal(status, BP_ERR_FILE);
        assert_non_null(strstr(err.message, "File too large"));
        temp_assert_text(path, "old");
        assert_int_equal(temp_count(folder), 1);
    }
    signal(SIGXFSZ, handler);
    bp_picture_clear(&picture);
    temp_remove(folder);
}

static void what_is_no_picture_is_refused(void **state) {
    (void)state;
    BpPicture picture = make_picture(2, 2), empty = {.width = 0};
    BpError err = {0};
    assert_int_equal(bp_picture_write_stream(&picture, stdout, BP_FORMAT_BPA, BP_TRANSFER_SRGB, &err),
                     BP_ERR_USAGE);
    for (BpFormat format = BP_FORMAT_PDF; format <= BP_FORMAT_SVG; format++) {
        assert_int_equal(bp_picture_write_stream(&picture, stdout, format, BP_TRANSFER_SRGB, &err),
                         BP_ERR_USAGE);
        assert_non_null(strstr(err.message, "ballpark render"));
    }
    assert_int_equal(bp_picture_write_stream(&empty, stdout, BP_FORMAT_PNG, BP_TRANSFER_SRGB, &err),
                     BP_ERR_USAGE);
    bp_picture_clear(&picture);
    bp_picture_clear(&picture); /* a second time does no harm */
}

/* OpenEXR reports such a failure while it holds its lock: whoever asks it for something then waits for ever.
 */
static void what_the_exr_library_refuses_is_an_error(void **state) {
    (void)state;
    static const uint32_t sides[][2] = {{0, 4}, {4, 0}, {UINT32_MAX, 2}};
    float rgb[3] = {0};
    alarm(60); /* only so that a hang is a failure */
    for (size_t i = 0; i < 3; i++) {
        const BpPicture picture = {.width = sides[i][0], .height = sides[i][1], .rgb = rgb};
        char *bytes = NULL;
        size_t size = 0;
        FILE *out = open_memstream(&bytes, &size);
        BpError err = {0};
        assert_int_equal(bp_exr_write(&picture, out, &(BpImageExtra){.note_count = 0}, &err), BP_ERR_FILE);
        assert_non_null(strstr(err.message, "encoding the EXR"));
        assert_non_null(strstr(err.message, "Invalid attribute"));
        fclose(out);
        assert_int_equal(size, 0);
        free(bytes);
        bp_error_clear(&err);
    }
    alarm(0);
}

/* Twice the light for each stop; NaN stays NaN, and what would be too large becomes the largest float. */
static void exposure(void **state) {
    (void)state;
    static const float before[6] = {NAN, INFINITY, 3e38f, 0.25f, 0, 1e-30f};
    for (int stops = -1; stops <= 1; stops++) {
        BpPicture picture = make_picture(2, 1);
        memcpy(picture.rgb, before, sizeof before);
        bp_picture_expose(&picture, stops);
        assert_true(isnan(picture.rgb[0]));
        assert_true(picture.rgb[1] > 3.4e38f);
        assert_true(stops == 1 ? picture.rgb[2] == FLT_MAX : picture.rgb[2] == 3e38f * exp2f((float)stops));
        for (int i = 3; i < 6; i++) assert_true(picture.rgb[i] == before[i] * exp2f((float)stops));
        bp_picture_clear(&picture);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_and_endings),
        cmocka_unit_test(binary_ppm),
        cmocka_unit_test(text_ppm),
        cmocka_unit_test(pfm_keeps_every_bit),
        cmocka_unit_test(png_reads_back_with_its_tags),
        cmocka_unit_test(exr_reads_back_bit_for_bit),
        cmocka_unit_test(exr_of_any_noise_reads_back),
        cmocka_unit_test(exr_is_compressed),
        cmocka_unit_test(exposure),
        cmocka_unit_test(a_full_disk_is_an_error),
        cmocka_unit_test(a_failed_write_keeps_the_old_picture),
        cmocka_unit_test(what_is_no_picture_is_refused),
        cmocka_unit_test(what_the_exr_library_refuses_is_an_error),
    };
    return cmocka_run_group_tests_name("image_formats", tests, NULL, NULL);
}
