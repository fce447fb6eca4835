/* bpa_io.h: accumulators to and from bytes, and how many bytes a file has, for the fuzz targets of .bpa
 * files. */
#ifndef BP_FUZZ_BPA_IO_H
#define BP_FUZZ_BPA_IO_H

#include "engine/accumulator_file.h"
#include "fuzz.h"

#include <stdio.h>

/* NULL: refused, with a reason. */
static inline BpAccumulator *bpa_load(const void *data, size_t size) {
    if (size == 0) return NULL;                                 /* fmemopen has no empty files everywhere */
    FILE *file = fmemopen((void *)(uintptr_t)data, size, "rb"); /* read only, whatever the type says */
    require(file != NULL);
    BpAccumulator *accumulator = NULL;
    BpError err = {0};
    const BpStatus status = bp_accumulator_load_stream(file, "fuzz", &accumulator, &err);
    require((status == BP_OK) == (accumulator != NULL));
    require(status == BP_OK || (err.code == status && err.message[0] != '\0'));
    bp_error_clear(&err);
    fclose(file);
    return accumulator;
}

/* The file of an accumulator; free() it. NULL: refused, with a reason. */
static inline char *bpa_save(const BpAccumulator *accumulator, size_t *size) {
    char *bytes = NULL;
    FILE *file = open_memstream(&bytes, size);
    require(file != NULL);
    BpError err = {0};
    const BpStatus status = bp_accumulator_save_stream(accumulator, file, &err);
    require(status == BP_OK || (err.code == status && err.message[0] != '\0'));
    bp_error_clear(&err);
    fclose(file);
    if (status == BP_OK) return bytes;
    free(bytes);
    return NULL;
}

static inline size_t bpa_cells(const BpAccumulator *accumulator) {
    return (size_t)accumulator->width * accumulator->height * accumulator->replicates;
}

#endif
