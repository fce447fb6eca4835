/* image.h: writes pictures to files.
 *
 * In:    linear radiance (BpPicture).   Out: PNG, PPM (P6, P3), PFM, EXR.
 * Knows: file formats, transfer curves.   Does not know: scenes, OpenCL, how the picture was made. */
#ifndef BP_IMAGE_IMAGE_H
#define BP_IMAGE_IMAGE_H

#include "ballpark.h"

#include <stdio.h>

/* The book's writer: encode by the transfer curve (gamma2: square root of positive values, else 0), clamp to
 * [0, 0.999], times 256, floor. NaN becomes 0; +Inf 255. */
uint8_t bp_transfer_byte(double linear, BpTransfer transfer);
/* The radiance that `transfer` encodes as `value`, 0 to 1. */
double bp_transfer_inverse(double value, BpTransfer transfer);

/* The format that `path`'s ending names (.png .ppm .pfm .exr .bpa .pdf .svg, in any case); false when it
 * names none. */
bool bp_format_from_path(const char *path, BpFormat *format);
/* The format by its name: png ppm ppm-ascii pfm exr bpa pdf svg. */
bool bp_format_from_name(const char *name, BpFormat *format);

/* Metadata of a picture's file, in PNG and EXR. Zeros: none, and 8 bits. */
typedef struct BpImageNote {
    const char *png_key, *exr_key, *text; /* UTF-8 */
} BpImageNote;
enum { BP_IMAGE_NOTES_MAX = 8 };
typedef struct BpImageExtra {
    double dots_per_inch; /* 0: unknown */
    bool deep;            /* PNG: 16 bits a channel */
    const char *software; /* Optional: instead of "Ballpark" */
    BpImageNote notes[BP_IMAGE_NOTES_MAX];
    size_t note_count;
} BpImageExtra;

/* bp_transfer_byte for 16 bits: encoded, clamped to [0, 1], times 65535, rounded. */
uint16_t bp_transfer_word(double linear, BpTransfer transfer);

/* Multiplies the radiance by 2 to the power of `stops`, and nothing else; NaN stays NaN. */
void bp_picture_expose(BpPicture *picture, double stops);

/* bp_picture_write_stream() with metadata. */
BpStatus bp_picture_write_extra(const BpPicture *picture, FILE *out, BpFormat format, BpTransfer transfer,
                                const BpImageExtra *extra, BpError *err);

/* Writers to an open stream, which need not be able to seek; each ends with a flush and fails with
 * BP_ERR_FILE (or BP_ERR_MEMORY), leaving half a file on the stream. */
BpStatus bp_png_write(const BpPicture *picture, FILE *out, BpTransfer transfer, const BpImageExtra *extra,
                      BpError *err);
BpStatus bp_ppm_write(const BpPicture *picture, FILE *out, BpTransfer transfer, bool ascii, BpError *err);
BpStatus bp_pfm_write(const BpPicture *picture, FILE *out,
                      BpError *err); /* little endian, bottom row first */
/* Layers: R G B, error.R/G/B, samples, depth.Z, normal.X/Y/Z and albedo.R/G/B, as far as the picture carries
 * them; 32-bit, ZIP compressed. */
BpStatus bp_exr_write(const BpPicture *picture, FILE *out, const BpImageExtra *extra, BpError *err);

/* 8-bit RGB, 3 bytes per pixel, top row first, as an sRGB PNG: for pictures that are drawn, not rendered. */
BpStatus bp_png_write_bytes(const uint8_t *rgb, uint32_t width, uint32_t height, FILE *out, BpError *err);
/* Prints bytes, such as those of a PNG, in base64 (RFC 4648, section 4). */
void bp_base64_print(const void *bytes, size_t size, FILE *out);

/* Writes to an open stream; BP_FORMAT_BPA, BP_FORMAT_PDF and BP_FORMAT_SVG are refused. */
BpStatus bp_picture_write_stream(const BpPicture *picture, FILE *out, BpFormat format, BpTransfer transfer,
                                 BpError *err);

#endif
