/* image_file.c: see image_file.h. */
#include "image_file.h"

#include "base/known_file.h"
#include "reader.h"

#include <string.h>

/* Reports the kind of the file, if it is recognised, and how to convert it. */
static BpStatus fail_kind(const BpImageInput *input, BpError *err) {
    char bytes[64];
    BpKnownFile known = {BP_FILE_SOURCE, "another kind of file"};
    const size_t length = fread(bytes, 1, sizeof bytes, input->stream);
    if (length == 0)
        known.what = "an empty file";
    else
        bp_known_file(input->path, bytes, length, &known);
    return bp_image_fail(
        input, err, "found %s, expected an image: PNG, JPEG, OpenEXR, PFM or Radiance (.hdr)%s", known.what,
        known.kind == BP_FILE_IMAGE ? "; ImageMagick converts it: convert FILE FILE.png" : "");
}

BpStatus bp_image_read(FILE *stream, uint64_t size, const char *path, BpEncoding encoding, double scale,
                       uint64_t texels_max, BpImage **image, BpError *err) {
    static const struct {
        unsigned char first[4];
        size_t count;
        BpStatus (*read)(const BpImageInput *input, BpImage **image, BpError *err);
    } formats[] = {{{0x89, 'P', 'N', 'G'}, 4, bp_image_read_png},
                   {{0xff, 0xd8, 0xff}, 3, bp_image_read_jpeg},
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
        if (encoding == BP_ENCODING_SRGB && formats[i].read != bp_image_read_png &&
            formats[i].read != bp_image_read_jpeg)
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
