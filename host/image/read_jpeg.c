/* read_jpeg.c: images as JPEG files, by libjpeg; see reader.h.
 *
 * 8 bits a channel, grey or colours, baseline or progressive. The library's own arithmetic is exact in whole
 * numbers, so texels are the same on every machine. What it would only warn of, such as a file that ends too
 * early, is an error here: it fills the rest with grey. Files with four channels (CMYK) and of arithmetic
 * coding are refused. */
#include "camera_notes.h"
#include "reader.h"

#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

#include <jerror.h>

/* A byte holds eight bits, a block of 64 texels takes at least one, and channels may be coarser by four, each
 * in one direction. */
#define UNPACKED_MAX (8u * 64u * 4u)
#define SCANS_MAX 500 /* of a progressive file; each takes as long as the whole image */

typedef struct JpegReader {
    struct jpeg_error_mgr errors; /* first, since libjpeg knows no other place for what is ours */
    struct jpeg_progress_mgr progress;
    struct jpeg_decompress_struct jpeg;
    jmp_buf out;
    const BpImageInput *input;
    JSAMPLE *bytes; /* a row */
    float *light;   /* what each number stands for */
    BpImage *image;
    uint32_t row; /* that is being read */
    bool no_memory;
    char fault[JMSG_LENGTH_MAX];
} JpegReader;

static void give_up(JpegReader *reader, const char *fault) {
    snprintf(reader->fault, sizeof reader->fault, "%s", fault);
    longjmp(reader->out, 1);
}

static void on_error(j_common_ptr jpeg) {
    JpegReader *const reader = (JpegReader *)jpeg->err;
    char text[JMSG_LENGTH_MAX];
    reader->no_memory = jpeg->err->msg_code == JERR_OUT_OF_MEMORY;
    jpeg->err->format_message(jpeg, text);
    give_up(reader, text);
}

/* `level`: below 0 for damage. Three kinds of it change no texel: bytes between two markers, and unknown
 * versions. */
static void on_message(j_common_ptr jpeg, int level) {
    const int code = jpeg->err->msg_code;
    if (level < 0 && code != JWRN_EXTRANEOUS_DATA && code != JWRN_JFIF_MAJOR && code != JWRN_ADOBE_XFORM)
        on_error(jpeg);
}

static void on_progress(j_common_ptr jpeg) {
    JpegReader *const reader = (JpegReader *)jpeg->err;
    if (reader->jpeg.input_scan_number > SCANS_MAX) give_up(reader, "it has more than 500 scans");
}

static void note_markers(JpegReader *reader) {
    static const char exif[] = "Exif\0";
    JOCTET *profile = NULL;
    unsigned int size = 0;
    if (reader->input->encoding == BP_ENCODING_OF_FORMAT &&
        jpeg_read_icc_profile(&reader->jpeg, &profile, &size))
        bp_note_profile(reader->image, NULL, profile, size);
    free(profile);
    for (jpeg_saved_marker_ptr marker = reader->jpeg.marker_list; marker != NULL; marker = marker->next)
        if (marker->marker == JPEG_APP0 + 1 && marker->data_length > sizeof exif &&
            memcmp(marker->data, exif, sizeof exif) == 0) {
            bp_note_orientation(reader->image, marker->data + sizeof exif, marker->data_length - sizeof exif);
            return;
        }
}

/* Everything that may come back by longjmp; what it takes stands in `reader`. */
static BpStatus read_image(JpegReader *reader, BpError *err) {
    struct jpeg_decompress_struct *const jpeg = &reader->jpeg;
    jpeg_stdio_src(jpeg, reader->input->stream);
    jpeg_save_markers(jpeg, JPEG_APP0 + 1, 0xffff); /* Exif */
    jpeg_save_markers(jpeg, JPEG_APP0 + 2, 0xffff); /* ICC profiles */
    jpeg_read_header(jpeg, TRUE);
    if (jpeg->jpeg_color_space == JCS_CMYK || jpeg->jpeg_color_space == JCS_YCCK)
        return bp_image_fail(
            reader->input, err,
            "found a JPEG file of four inks (CMYK), expected grey or three colours; ImageMagick converts "
            "it: convert FILE -colorspace sRGB FILE.png");
    if (jpeg->arith_code)
        return bp_image_fail(
            reader->input, err,
            "found a JPEG file of arithmetic coding, expected Huffman's; libjpeg converts it: jpegtran "
            "FILE > NEW.jpg");
    const uint64_t least = (uint64_t)jpeg->image_width * jpeg->image_height / UNPACKED_MAX;
    if (least > reader->input->size)
        return bp_image_fail(
            reader->input, err,
            "found %llu bytes, expected at least %llu for %u by %u texels; the file is damaged or "
            "incomplete",
            (unsigned long long)reader->input->size, (unsigned long long)least, (unsigned)jpeg->image_width,
            (unsigned)jpeg->image_height);
    BP_TRY(bp_image_allocate(reader->input, jpeg->image_width, jpeg->image_height, &reader->image, err));
    reader->light = bp_light_of_numbers(8, reader->input->encoding == BP_ENCODING_LINEAR ? 1 : 0);
    reader->bytes = malloc((size_t)3 * jpeg->image_width);
    if (reader->light == NULL || reader->bytes == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for an image of %u by %u texels",
                       (unsigned)jpeg->image_width, (unsigned)jpeg->image_height);
    jpeg->out_color_space = JCS_RGB;
    jpeg->dct_method = JDCT_ISLOW;
    jpeg_start_decompress(jpeg);
    for (reader->row = 0; reader->row < reader->image->height; reader->row++) {
        float *const texels = reader->image->texels + (size_t)3 * reader->image->width * reader->row;
        JSAMPROW rows[1] = {reader->bytes};
        if (jpeg_read_scanlines(jpeg, rows, 1) != 1) give_up(reader, "the file ends too early");
        for (size_t i = 0; i < (size_t)3 * reader->image->width; i++)
            texels[i] = reader->light[reader->bytes[i]];
    }
    note_markers(reader);
    jpeg_finish_decompress(jpeg);
    return BP_OK;
}

static BpStatus read_guarded(JpegReader *reader, BpError *err) {
    if (setjmp(reader->out) != 0) {
        if (reader->no_memory) return bp_fail(err, BP_ERR_MEMORY, "out of memory for reading a JPEG file");
        return reader->image == NULL
                   ? bp_image_fail(reader->input, err, "found a JPEG file that cannot be read: %s",
                                   reader->fault)
                   : bp_image_fail(reader->input, err,
                                   "found a damaged JPEG file: %s; %u of %u rows could be read",
                                   reader->fault, (unsigned)reader->row, (unsigned)reader->image->height);
    }
    jpeg_create_decompress(&reader->jpeg);
    reader->jpeg.progress = &reader->progress;
    return read_image(reader, err);
}

BpStatus bp_image_read_jpeg(const BpImageInput *input, BpImage **image, BpError *err) {
    JpegReader reader = {.input = input};
    reader.jpeg.err = jpeg_std_error(&reader.errors);
    reader.errors.error_exit = on_error;
    reader.errors.emit_message = on_message;
    reader.progress.progress_monitor = on_progress;
    const BpStatus status = read_guarded(&reader, err);
    jpeg_destroy_decompress(&reader.jpeg);
    free(reader.bytes);
    free(reader.light);
    if (status != BP_OK) bp_texels_destroy(&reader.image);
    *image = reader.image;
    return status;
}
