/* crop.c: windows of pictures and maps of their true errors; see crop.h. */
#include "crop.h"

#include "base/color.h"
#include "base/status.h"
#include "image/error_map.h"
#include "image/image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint32_t smaller(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

void bp_study_interest_add(double *interest, const BpPicture *x, const BpPicture *y, double brightness) {
    for (size_t p = 0; p < (size_t)x->width * x->height; p++) {
        const double a = bp_luminance(x->rgb + 3 * p), b = bp_luminance(y->rgb + 3 * p);
        /* A single bright pixel must not dominate. */
        interest[p] += fmin(1, fabs(a - b) / brightness);
    }
}

void bp_study_crop_place(const double *interest, uint32_t width, uint32_t height, uint32_t *left,
                         uint32_t *top) {
    const uint32_t across = smaller(width, BP_STUDY_CROP_WIDTH), down = smaller(height, BP_STUDY_CROP_HEIGHT);
    double most = -1;
    *left = *top = 0;
    for (uint32_t y0 = 0; y0 + down <= height; y0 += 4)
        for (uint32_t x0 = 0; x0 + across <= width; x0 += 4) {
            double sum = 0;
            for (uint32_t y = y0; y < y0 + down; y++)
                for (uint32_t x = x0; x < x0 + across; x++) sum += interest[(size_t)y * width + x];
            if (sum <= most) continue;
            most = sum;
            *left = x0;
            *top = y0;
        }
}

static BpStatus encode(const uint8_t *rgb, uint32_t width, uint32_t height, BpStudyPng *png, BpError *err) {
    FILE *stream = open_memstream(&png->bytes, &png->size);
    if (stream == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for a crop");
    const BpStatus status = bp_png_write_bytes(rgb, width, height, stream, err);
    if (fclose(stream) != 0 && status == BP_OK) return bp_fail(err, BP_ERR_MEMORY, "no memory for a crop");
    return status;
}

BpStatus bp_study_crop(const BpPicture *x, const BpPicture *r1, const BpPicture *r2, uint32_t left,
                       uint32_t top, BpTransfer transfer, BpStudyCrop *crop, BpError *err) {
    const uint32_t width = smaller(x->width, BP_STUDY_CROP_WIDTH),
                   height = smaller(x->height, BP_STUDY_CROP_HEIGHT);
    BpStatus status = BP_OK;
    uint8_t *picture = malloc((size_t)width * height * 3), *map = malloc((size_t)width * height * 3);
    if (picture == NULL || map == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "no memory for a crop");
        goto done;
    }
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t i = 0; i < width; i++) {
            const size_t p = (size_t)(y + top) * x->width + i + left, q = 3 * ((size_t)y * width + i);
            for (size_t c = 0; c < 3; c++)
                picture[q + c] = bp_transfer_byte((double)x->rgb[3 * p + c], transfer);
            const double truth = 0.5 * (bp_luminance(r1->rgb + 3 * p) + bp_luminance(r2->rgb + 3 * p));
            const double off = fabs(bp_luminance(x->rgb + 3 * p) - truth);
            bp_error_color(truth > 0 ? off / truth : (double)NAN, map + q);
        }
    }
    BP_TRY_GOTO(status, encode(picture, width, height, &crop->picture, err), done);
    status = encode(map, width, height, &crop->map, err);
done:
    free(picture);
    free(map);
    return status;
}

void bp_study_crop_clear(BpStudyCrop *crop) {
    free(crop->picture.bytes);
    free(crop->map.bytes);
    memset(crop, 0, sizeof *crop);
}
