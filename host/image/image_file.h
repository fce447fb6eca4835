/* image_file.h: images that a scene names: PNG, JPEG, OpenEXR, PFM and Radiance.
 *
 * In:    an open file.   Out: an image of linear texels (image/texels.h), or an error that names file and
 * place.
 * Knows: the five formats, by their first bytes (reader.h).   Does not know: what the image is for.
 */
#ifndef BP_IMAGE_IMAGE_FILE_H
#define BP_IMAGE_IMAGE_FILE_H

#include "texels.h"

#include <stdio.h>

/* Reads an image of any of the formats. `encoding`: BP_ENCODING_SRGB is refused for all but PNG and JPEG,
 * since their numbers are linear. `texels_max`: more are refused. The image has no file name yet. */
BpStatus bp_image_read(FILE *stream, uint64_t size, const char *path, BpEncoding encoding, double scale,
                       uint64_t texels_max, BpImage **image, BpError *err);

#endif
