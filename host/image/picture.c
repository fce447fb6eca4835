/* picture.c: pictures to files by the name of their format, and their release; see image.h and ballpark.h. */
#include "image.h"

#include "base/names.h"
#include "base/output_file.h"

#include "aov_list.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

bool bp_format_from_name(const char *name, BpFormat *format) {
    for (size_t i = 0; bp_format_names[i] != NULL; i++) {
        if (strcasecmp(name, bp_format_names[i]) != 0) continue;
        *format = (BpFormat)i;
        return true;
    }
    return false;
}

bool bp_format_from_path(const char *path, BpFormat *format) {
    const char *base = strrchr(path, '/');
    base = base == NULL ? path : base + 1;
    const char *dot = strrchr(base, '.');
    /* "ppm-ascii" is a name on the command line, not an ending. */
    return dot != NULL && strchr(dot, '-') == NULL && bp_format_from_name(dot + 1, format);
}

BpStatus bp_picture_write_stream(const BpPicture *picture, FILE *out, BpFormat format, BpTransfer transfer,
                                 BpError *err) {
    const BpImageExtra none = {.note_count = 0};
    return bp_picture_write_extra(picture, out, format, transfer, &none, err);
}

BpStatus bp_picture_write_extra(const BpPicture *picture, FILE *out, BpFormat format, BpTransfer transfer,
                                const BpImageExtra *extra, BpError *err) {
    if (picture->width == 0 || picture->height == 0 || picture->rgb == NULL)
        return bp_fail(err, BP_ERR_USAGE, "an empty picture cannot be written");
    switch (format) {
    case BP_FORMAT_PNG:
        return bp_png_write(picture, out, transfer, extra, err);
    case BP_FORMAT_PPM:
        return bp_ppm_write(picture, out, transfer, false, err);
    case BP_FORMAT_PPM_ASCII:
        return bp_ppm_write(picture, out, transfer, true, err);
    case BP_FORMAT_PFM:
        return bp_pfm_write(picture, out, err);
    case BP_FORMAT_EXR:
        return bp_exr_write(picture, out, extra, err);
    case BP_FORMAT_PDF:
    case BP_FORMAT_SVG:
        return bp_fail(
            err, BP_ERR_USAGE,
            "PDF and SVG files are written by ballpark render and ballpark merge alone; write a PNG");
    case BP_FORMAT_BPA:
        break;
    }
    return bp_fail(err, BP_ERR_USAGE,
                   "a .bpa file holds the sums of a render, not a picture; only ballpark render and ballpark "
                   "merge write it");
}

typedef struct Printed {
    const BpPicture *picture;
    BpFormat format;
    BpTransfer transfer;
} Printed;

static BpStatus print_picture(const void *what, FILE *out, BpError *err) {
    const Printed *printed = what;
    return bp_picture_write_stream(printed->picture, out, printed->format, printed->transfer, err);
}

BpStatus bp_picture_write(const BpPicture *picture, const char *path, BpFormat format, BpTransfer transfer,
                          BpError *err) {
    const Printed printed = {picture, format, transfer};
    return bp_output_write(path, false, print_picture, &printed, err);
}

BpStatus bp_picture_encode(const BpPicture *picture, BpFormat format, BpTransfer transfer, void **bytes,
                           size_t *size, BpError *err) {
    char *memory = NULL;
    FILE *const stream = open_memstream(&memory, size);
    *bytes = NULL;
    if (stream == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a picture");
    BpStatus status = bp_picture_write_stream(picture, stream, format, transfer, err);
    if (fclose(stream) != 0 && status == BP_OK)
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a picture");
    if (status == BP_OK)
        *bytes = memory;
    else
        free(memory);
    return status;
}

void bp_picture_bytes(const BpPicture *picture, BpTransfer transfer, uint8_t *rgb) {
    const size_t count = (size_t)picture->width * picture->height * 3;
    for (size_t i = 0; i < count; i++) rgb[i] = bp_transfer_byte((double)picture->rgb[i], transfer);
}

void bp_picture_expose(BpPicture *picture, double stops) {
    const double factor = exp2(stops);
    const size_t count = (size_t)picture->width * picture->height * 3;
    for (size_t i = 0; i < count && factor != 1; i++) {
        const double exposed = factor * (double)picture->rgb[i];
        picture->rgb[i] = exposed > (double)FLT_MAX ? FLT_MAX : (float)exposed;
    }
}

void bp_picture_clear(BpPicture *picture) {
    if (picture == NULL) return;
    free(picture->rgb);
    free(picture->error);
    free(picture->samples);
    free(picture->alpha);
#define FREE(place, member, floats, mean, channels) free(picture->member);
    AOV_LIST(FREE)
#undef FREE
    memset(picture, 0, sizeof *picture);
}
