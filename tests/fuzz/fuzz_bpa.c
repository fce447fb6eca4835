/* fuzz_bpa.c: libFuzzer target for accumulator files (host/engine/accumulator_file.h).
 *
 * In:    any bytes.   Out: nothing, or a crash.
 * What loads must be safe to use: it saves and loads again to the same bytes, its picture can be made, and it
 * can be merged with what it does not overlap. */
#include "engine/accumulator_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIZE_MAX_TRIED 65536

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static BpAccumulator *load(const void *data, size_t size) {
    FILE *file = fmemopen((void *)(uintptr_t)data, size, "rb"); /* read only, whatever the type says */
    if (file == NULL) return NULL;
    BpAccumulator *accumulator = NULL;
    BpError err = {0};
    bp_accumulator_load_stream(file, "fuzz", &accumulator, &err);
    bp_error_clear(&err);
    fclose(file);
    return accumulator;
}

static char *save(const BpAccumulator *accumulator, size_t *size) {
    char *bytes = NULL;
    FILE *file = open_memstream(&bytes, size);
    if (file == NULL || bp_accumulator_save_stream(accumulator, file, NULL) != BP_OK) abort();
    fclose(file);
    return bytes;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size > SIZE_MAX_TRIED) return 0;
    BpAccumulator *first = load(data, size);
    if (first == NULL) return 0;
    size_t first_size = 0, second_size = 0;
    char *first_bytes = save(first, &first_size);
    BpAccumulator *second = load(first_bytes, first_size);
    if (second == NULL) abort();
    char *second_bytes = save(second, &second_size);
    if (first_size != second_size || memcmp(first_bytes, second_bytes, first_size) != 0) abort();

    BpPicture picture;
    if (bp_accumulator_picture(first, &picture, NULL) == BP_OK) bp_picture_clear(&picture);
    /* With itself it overlaps, unless it has no samples; shifted by one it may not. */
    bp_accumulator_merge(second, first, NULL);
    for (size_t i = 0; i < second->range_count; i++) second->ranges[i].first += first->replicates;
    bp_accumulator_merge(first, second, NULL);

    free(first_bytes);
    free(second_bytes);
    bp_accumulator_destroy(&first);
    bp_accumulator_destroy(&second);
    return 0;
}
