/* reader.h: the readers of image files, and what they share.
 *
 * In:    an open file.   Out: an image of linear texels (texels.h), or an error that names file and place.
 * Knows: which readers there are, limits of sizes.   Does not know: how a format is recognised
 * (image_file.h).
 *
 * Files are not trusted: sizes are held against limits, and against the size of the file where the format has
 * no way to say more with less, before memory is taken. */
#ifndef BP_IMAGE_READER_H
#define BP_IMAGE_READER_H

#include "texels.h"

#include <stdio.h>

/* A file that is being read. */
typedef struct BpImageInput {
    FILE *stream;        /* at its beginning */
    uint64_t size;       /* in bytes */
    const char *path;    /* for messages */
    BpEncoding encoding; /* of a PNG's or a JPEG's numbers: as the file says, or as the scene does */
    uint64_t texels_max;
} BpImageInput;

/* The formats; what they return is not finished (bp_texels_finish). */
BpStatus bp_image_read_png(const BpImageInput *input, BpImage **image, BpError *err);
BpStatus bp_image_read_jpeg(const BpImageInput *input, BpImage **image, BpError *err);
BpStatus bp_image_read_exr(const BpImageInput *input, BpImage **image, BpError *err);
BpStatus bp_image_read_pfm(const BpImageInput *input, BpImage **image, BpError *err);
BpStatus bp_image_read_hdr(const BpImageInput *input, BpImage **image, BpError *err);

/* Fails with the code, "found ..., expected ...", in the file. */
BpStatus bp_image_fail(const BpImageInput *input, BpError *err, const char *format, ...) BP_PRINTF_LIKE(3, 4);
/* An image of the size in a header, which is untrusted. */
BpStatus bp_image_allocate(const BpImageInput *input, uint64_t width, uint64_t height, BpImage **image,
                           BpError *err);
/* What each number of `bits` bits, from 0 to 2^bits - 1, stands for as linear light: a power of its share, or
 * for exponent 0 what sRGB's curve makes of it. To be freed; NULL: no memory. */
float *bp_light_of_numbers(int bits, double exponent);

#endif
