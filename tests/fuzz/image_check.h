/* image_check.h: what holds of every image that a reader makes of a hostile file.
 *
 * In:    the bytes of a file.   Out: ends the program where something does not hold.
 * Knows: the readers of images.   Does not know: fuzzers. */
#ifndef TESTS_FUZZ_IMAGE_CHECK_H
#define TESTS_FUZZ_IMAGE_CHECK_H

#include "fuzz.h"
#include "image/reader.h"

#include <math.h>

#define TEXELS_MAX ((uint64_t)1 << 20) /* more would be a hunt for memory */

static inline void check_image(const uint8_t *data, size_t size,
                               BpStatus (*read)(const BpImageInput *input, BpImage **image, BpError *err)) {
    if (size == 0) return; /* fmemopen has no empty files everywhere */
    FILE *stream = fmemopen((void *)(uintptr_t)data, size, "rb");
    require(stream != NULL);
    const BpImageInput input = {stream, size, "x.image", BP_ENCODING_OF_FORMAT, TEXELS_MAX};
    BpImage *image = NULL;
    BpError err = {0};
    BpStatus status = read(&input, &image, &err);
    require((status == BP_OK) == (image != NULL));
    if (status == BP_OK) {
        status = bp_texels_finish(image, 2, "x.image", &err);
        if (status != BP_OK) bp_texels_destroy(&image);
    }
    if (status != BP_OK) {
        require(image == NULL && err.code == status && err.message[0] != '\0');
    } else {
        const size_t numbers = (size_t)3 * image->width * image->height;
        require(image->width > 0 && image->height > 0 && numbers <= 3 * TEXELS_MAX);
        for (size_t i = 0; i < numbers; i++)
            require(image->texels[i] >= 0 && (double)image->texels[i] <= image->bound[i % 3]);
        require(isfinite(image->mean) && isfinite(image->spread) && image->spread >= 0);
    }
    bp_error_clear(&err);
    bp_texels_destroy(&image);
    fclose(stream);
}

#endif
