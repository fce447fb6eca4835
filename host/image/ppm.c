/* ppm.c: the Netpbm formats, PPM in binary (P6) and text (P3), and PFM; see image.h. */
#include "image.h"

#include "base/output_file.h"
#include "base/status.h"

#include <stdlib.h>
#include <string.h>

BpStatus bp_ppm_write(const BpPicture *picture, FILE *out, BpTransfer transfer, bool ascii, BpError *err) {
    const size_t row_size = (size_t)picture->width * 3;
    uint8_t *row = malloc(row_size);
    if (row == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a row of %zu bytes", row_size);
    fprintf(out, "%s\n%u %u\n255\n", ascii ? "P3" : "P6", picture->width, picture->height);
    for (uint32_t y = 0; y < picture->height && !ferror(out); y++) {
        const float *linear = picture->rgb + y * row_size;
        for (size_t i = 0; i < row_size; i++) row[i] = bp_transfer_byte((double)linear[i], transfer);
        if (!ascii) {
            fwrite(row, 1, row_size, out);
            continue;
        }
        /* A pixel a line, as the book prints it; the format allows at most 70 characters. */
        for (size_t i = 0; i < row_size; i += 3) fprintf(out, "%d %d %d\n", row[i], row[i + 1], row[i + 2]);
    }
    free(row);
    return bp_output_finish(out, "PPM", err);
}

BpStatus bp_pfm_write(const BpPicture *picture, FILE *out, BpError *err) {
    const size_t row_reals = (size_t)picture->width * 3;
    uint8_t *row = malloc(row_reals * 4);
    if (row == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a row of %zu bytes", row_reals * 4);
    fprintf(out, "PF\n%u %u\n-1.0\n", picture->width, picture->height); /* negative: little endian */
    for (uint32_t y = picture->height; y-- > 0 && !ferror(out);) {
        const float *linear = picture->rgb + y * row_reals;
        for (size_t i = 0; i < row_reals; i++) {
            uint32_t bits;
            memcpy(&bits, &linear[i], sizeof bits);
            for (size_t byte = 0; byte < 4; byte++) row[4 * i + byte] = (uint8_t)(bits >> (8 * byte));
        }
        fwrite(row, 4, row_reals, out);
    }
    free(row);
    return bp_output_finish(out, "PFM", err);
}
