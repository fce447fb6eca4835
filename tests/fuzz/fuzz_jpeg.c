/* fuzz_jpeg.c: any bytes as a JPEG file. What is accepted is an image of sane texels. */
#include "image_check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    check_image(data, size, bp_image_read_jpeg);
    return 0;
}
