/* image.h: pictures to files.
 *
 * In:    linear radiance (BpPicture).   Out: PNG, PPM (P6, P3), PFM, EXR.
 * Knows: file formats, transfer curves.   Does not know: scenes, OpenCL, how the picture was made. */
#ifndef BP_IMAGE_IMAGE_H
#define BP_IMAGE_IMAGE_H

#include "../ballpark.h"

#include <stdio.h>

/* The book's writer: encode by the transfer curve (gamma2: square root of positive values, else 0), clamp to
 * [0, 0.999], times 256, floor. NaN becomes 0; +Inf 255. */
uint8_t bp_transfer_byte(double linear, BpTransfer transfer);

/* The format that `path`'s ending names (.png .ppm .pfm .exr .bpa); false when it names none. */
bool bp_format_from_path(const char *path, BpFormat *format);
/* The format by its name on the command line: png ppm ppm-ascii pfm exr bpa. */
bool bp_format_from_name(const char *name, BpFormat *format);

/* Writers to an open stream; each fails with BP_ERR_FILE. */
BpStatus bp_png_write(const BpPicture *picture, FILE *out, BpTransfer transfer, BpError *err);
BpStatus bp_ppm_write(const BpPicture *picture, FILE *out, BpTransfer transfer, bool ascii, BpError *err);
BpStatus bp_pfm_write(const BpPicture *picture, FILE *out, BpError *err); /* little endian, bottom row first */
/* EXR needs a path (the library opens it); layers: R G B, error.R/G/B, samples. */
BpStatus bp_exr_write(const BpPicture *picture, const char *path, BpError *err);

/* Writes to an already opened stream ("-o -"); EXR and BPA are refused there. */
BpStatus bp_picture_write_stream(const BpPicture *picture, FILE *out, BpFormat format, BpTransfer transfer,
                                 BpError *err);

#endif
