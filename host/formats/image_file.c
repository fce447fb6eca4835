/* image_file.c: see image_file.h. */
#include "image_file.h"

#include "input_file.h"
#include "known_file.h"

#include <inttypes.h>
#include <string.h>

BpStatus bp_image_fail(const BpImageInput *input, BpError *err, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const BpStatus status = bp_stream_fail(input->stream, input->path, 0, err, format, arguments);
    va_end(arguments);
    return status;
}

BpStatus bp_image_allocate(const BpImageInput *input, uint64_t width, uint64_t height, BpImage **image,
                           BpError *err) {
    if (width < 1 || height < 1 || width > BP_IMAGE_SIDE_MAX || height > BP_IMAGE_SIDE_MAX)
        return bp_image_fail(input, err,
                             "found an image of %" PRIu64 " by %" PRIu64 " texels, expected sides of 1 to %u",
                             width, height, BP_IMAGE_SIDE_MAX);
    if (width * height > input->texels_max)
        return bp_image_fail(input, err,
                             "found an image of %" PRIu64 " by %" PRIu64 " texels, expected at most %" PRIu64
                             " texels in all images of a scene, of which "
                             "%" PRIu64 " are left; use a smaller image",
                             width, height, BP_IMAGE_TEXELS_MAX, input->texels_max);
    return bp_texels_create((uint32_t)width, (uint32_t)height, image, err);
}

/* Says what the file is, if it is known, and how to convert it. */
static BpStatus fail_kind(const BpImageInput *input, BpError *err) {
    char bytes[512];
    BpKnownFile known = {BP_FILE_SOURCE, "another kind of file"};
    const size_t length = fread(bytes, 1, sizeof bytes, input->stream);
    if (length == 0)
        known.what = "an empty file";
    else
        bp_known_file(input->path, bytes, length, (size_t)input->size, &known);
    return bp_image_fail(
        input, err, "found %s, expected an image: PNG, OpenEXR, PFM or Radiance (.hdr)%s", known.what,
        known.kind == BP_FILE_IMAGE ? "; ImageMagick converts it: convert FILE FILE.png" : "");
}

BpStatus bp_image_read(FILE *stream, uint64_t size, const char *path, BpEncoding encoding, double scale,
                       uint64_t texels_max, BpImage **image, BpError *err) {
    static const struct {
        unsigned char first[4];
        size_t count;
        BpStatus (*read)(const BpImageInput *input, BpImage **image, BpError *err);
    } formats[] = {{{0x89, 'P', 'N', 'G'}, 4, bp_image_read_png},
                   {{0x76, 0x2f, 0x31, 0x01}, 4, bp_image_read_exr},
                   {{'P', 'F'}, 2, bp_image_read_pfm},
                   {{'P', 'f'}, 2, bp_image_read_pfm},
                   {{'#', '?'}, 2, bp_image_read_hdr}};
    const BpImageInput input = {stream, size, path, encoding, texels_max};
    unsigned char first[4] = {0};
    *image = NULL;
    const size_t count = fread(first, 1, sizeof first, stream);
    if (ferror(stream))
        return bp_image_fail(&input, err, "found no first bytes"); /* rewind() would forget it */
    rewind(stream);
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        if (count < formats[i].count || memcmp(first, formats[i].first, formats[i].count) != 0) continue;
        if (encoding == BP_ENCODING_SRGB && formats[i].read != bp_image_read_png)
            return bp_image_fail(&input, err,
                                 "found an EXR, PFM or Radiance file, whose numbers are linear, expected no "
                                 "\"encoding\": \"srgb\"; remove it");
        BpStatus status = formats[i].read(&input, image, err);
        if (status == BP_OK) status = bp_texels_finish(*image, scale, path, err);
        if (status == BP_OK)
            (*image)->encoding = encoding;
        else
            bp_texels_destroy(image);
        return status;
    }
    return fail_kind(&input, err);
}
