/* image_file.h: images that a scene names: PNG, OpenEXR, PFM and Radiance.
 *
 * In:    an open file.   Out: an image of linear texels (scene/texels.h), or an error that names file and
 * place.
 * Knows: the four formats, by their first bytes.   Does not know: what the image is for.
 *
 * Files are not trusted: sizes are held against limits, and against the size of the file where the format has
 * no way to say more with less, before memory is taken. */
#ifndef BP_FORMATS_IMAGE_FILE_H
#define BP_FORMATS_IMAGE_FILE_H

#include "scene/texels.h"

#include <stdio.h>

/* A file that is being read. */
typedef struct BpImageInput {
    FILE *stream;        /* at its beginning */
    uint64_t size;       /* in bytes */
    const char *path;    /* for messages */
    BpEncoding encoding; /* of a PNG's numbers: as the file says, or as the scene does */
    uint64_t texels_max;
} BpImageInput;

/* Reads an image of any of the formats. `encoding`: BP_ENCODING_SRGB is refused for all but PNG, since their
 * numbers are linear. `texels_max`: more are refused. The image has no file name yet. */
BpStatus bp_image_read(FILE *stream, uint64_t size, const char *path, BpEncoding encoding, double scale,
                       uint64_t texels_max, BpImage **image, BpError *err);

/* The formats; what they return is not finished (bp_texels_finish). */
BpStatus bp_image_read_png(const BpImageInput *input, BpImage **image, BpError *err);
BpStatus bp_image_read_exr(const BpImageInput *input, BpImage **image, BpError *err);
BpStatus bp_image_read_pfm(const BpImageInput *input, BpImage **image, BpError *err);
BpStatus bp_image_read_hdr(const BpImageInput *input, BpImage **image, BpError *err);

/* Fails with the code, "found ..., expected ...", in the file. */
BpStatus bp_image_fail(const BpImageInput *input, BpError *err, const char *format, ...) BP_PRINTF_LIKE(3, 4);
/* An image of the size in a header, which is untrusted. */
BpStatus bp_image_allocate(const BpImageInput *input, uint64_t width, uint64_t height, BpImage **image,
                           BpError *err);

#endif
